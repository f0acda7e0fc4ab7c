// Files that the page gives.

import { strToU8, zipSync } from "fflate";

export function download(name: string, content: BlobPart, type: string): void {
    const url = URL.createObjectURL(new Blob([content], { type }));
    const link = document.createElement("a");
    link.href = url;
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** Many files as one archive. */
export function zipped(files: readonly (readonly [string, string])[]): Uint8Array<ArrayBuffer> {
    return zipSync(Object.fromEntries(files.map(([name, text]) => [name, strToU8(text)]))) as Uint8Array<ArrayBuffer>;
}

/** The name of a file or folder without what follows the last dot, as a part of file names. */
export function stem(name: string): string {
    return name.replace(/\.[^.]*$/, "").replace(/[\\/:*?"<>|]/g, "_") || "boxes";
}
