// What the user drops or picks: a video, a folder of pictures, or annotations.

import { PICTURE_NAMES, sortedPictures } from "../video/pictures.ts";
import type { SourceSpec } from "../video/source.ts";

export type Given = { readonly is: "source"; readonly spec: SourceSpec } | { readonly is: "annotation"; readonly file: File };

const ANNOTATION_NAMES = /\.(json|jsonl|csv|xml|txt)$/i;

/** Sorts out what was given; null if it is nothing. */
export function given(files: readonly File[], folder: string): Given | null {
    const pictures = sortedPictures(files);
    const [first] = files;
    if (first === undefined) {
        return null;
    }
    if (pictures.length > 0) {
        return { is: "source", spec: { kind: "pictures", name: folder || (pictures[0]?.webkitRelativePath.split("/")[0] ?? "") || "pictures", files: pictures } };
    }
    const annotation = files.find((file) => ANNOTATION_NAMES.test(file.name));
    return annotation === undefined ? { is: "source", spec: { kind: "video", file: first } } : { is: "annotation", file: annotation };
}

/** The files of a drop, those in dropped folders too; and the name of the first folder. */
export async function dropped(transfer: DataTransfer): Promise<{ files: File[]; folder: string }> {
    // All are taken hold of at once: a drop is over when its listener has to wait.
    const items = [...transfer.items].map((item) => ({ file: item.getAsFile(), entry: item.webkitGetAsEntry(), handle: handleOf(item) }));
    const files: File[] = [];
    let folder = "";
    for (const { file, entry, handle } of items) {
        if (entry?.isDirectory !== true) {
            files.push(...(file === null ? [] : [file]));
            continue;
        }
        folder ||= entry.name;
        // Entries of a page that was opened from disk cannot be read; handles can, where there are any.
        const directory = await handle?.catch(() => null);
        if (directory?.kind === "directory") {
            await gatherHandles(directory as FileSystemDirectoryHandle, files);
        } else {
            await gatherEntries(entry as FileSystemDirectoryEntry, files);
        }
    }
    return { files, folder };
}

function handleOf(item: DataTransferItem): Promise<FileSystemHandle | null> | undefined {
    const withHandle = item as DataTransferItem & { getAsFileSystemHandle?(): Promise<FileSystemHandle | null> };
    return withHandle.getAsFileSystemHandle?.();
}

async function gatherHandles(directory: FileSystemDirectoryHandle, files: File[]): Promise<void> {
    const children = directory as FileSystemDirectoryHandle & { values(): AsyncIterable<FileSystemHandle> };
    for await (const child of children.values()) {
        if (child.kind === "directory") {
            await gatherHandles(child as FileSystemDirectoryHandle, files);
        } else if (PICTURE_NAMES.test(child.name)) {
            files.push(await (child as FileSystemFileHandle).getFile());
        }
    }
}

async function gatherEntries(directory: FileSystemDirectoryEntry, files: File[]): Promise<void> {
    const reader = directory.createReader();
    for (;;) {
        const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
        if (some.length === 0) {
            return;
        }
        for (const child of some) {
            if (child.isDirectory) {
                await gatherEntries(child as FileSystemDirectoryEntry, files);
            } else if (PICTURE_NAMES.test(child.name)) {
                files.push(await new Promise((resolve, reject) => (child as FileSystemFileEntry).file(resolve, reject)));
            }
        }
    }
}

/** Asks for files. */
export function pick(accept: string, isFolder: boolean): Promise<File[]> {
    return new Promise((resolve) => {
        const input = document.createElement("input");
        input.type = "file";
        input.accept = accept;
        input.webkitdirectory = isFolder;
        input.addEventListener("change", () => resolve([...(input.files ?? [])]));
        input.addEventListener("cancel", () => resolve([]));
        input.click();
    });
}
