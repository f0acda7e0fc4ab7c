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
    const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
    if (entries.length === 0) {
        return { files: [...transfer.files], folder: "" };
    }
    const files: File[] = [];
    for (const entry of entries) {
        await gather(entry, files);
    }
    return { files, folder: entries.find((entry) => entry.isDirectory)?.name ?? "" };
}

async function gather(entry: FileSystemEntry, files: File[]): Promise<void> {
    if (entry.isFile) {
        files.push(await new Promise((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject)));
        return;
    }
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    for (;;) {
        const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
        if (some.length === 0) {
            return;
        }
        for (const child of some) {
            if (child.isDirectory || PICTURE_NAMES.test(child.name)) {
                await gather(child, files);
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
