// What the browser keeps: the annotation of each video, what was tracked for it, and the video itself, so that a page that is loaded
// again, or was killed, goes on where it was.

import type { Pass } from "../engine/wasm.ts";
import type { History } from "../model/history.ts";
import type { SourceSpec } from "../video/source.ts";

/** An annotated video. */
export interface Work {
    readonly fingerprint: string;
    readonly name: string;
    readonly history: History;
    readonly frame: number;
    readonly selected: number | null;
    /** Milliseconds since 1970. */
    readonly saved: number;
}

interface KeptPass {
    readonly fingerprint: string;
    readonly pass: Pass;
}

const WORKS = "works";
const PASSES = "passes";
const VIDEOS = "videos";

/** Videos that are kept; of others only the annotation is. */
const MOST_VIDEOS = 3;

export class Library {
    private constructor(private readonly database: IDBDatabase) {}

    static open(): Promise<Library> {
        return new Promise((resolve, reject) => {
            const request = indexedDB.open("infopart-annotate", 1);
            request.onupgradeneeded = () => {
                request.result.createObjectStore(WORKS, { keyPath: "fingerprint" });
                request.result.createObjectStore(PASSES).createIndex("fingerprint", "fingerprint");
                request.result.createObjectStore(VIDEOS);
            };
            request.onsuccess = () => resolve(new Library(request.result));
            request.onerror = () => reject(request.error ?? new Error("the browser's storage cannot be opened"));
        });
    }

    async works(): Promise<Work[]> {
        const works = (await this.read(WORKS, (store) => store.getAll())) as Work[];
        return works.sort((a, b) => b.saved - a.saved);
    }

    async work(fingerprint: string): Promise<Work | undefined> {
        return (await this.read(WORKS, (store) => store.get(fingerprint))) as Work | undefined;
    }

    saveWork(work: Work): Promise<void> {
        return this.write([WORKS], ([works]) => works?.put(work));
    }

    async passes(fingerprint: string): Promise<Pass[]> {
        const kept = (await this.read(PASSES, (store) => store.index("fingerprint").getAll(fingerprint))) as KeptPass[];
        return kept.map(({ pass }) => pass);
    }

    savePass(fingerprint: string, pass: Pass): Promise<void> {
        const { from, direction, start } = pass;
        const key = [fingerprint, from, direction, start.x, start.y, start.w, start.h];
        return this.write([PASSES], ([passes]) => passes?.put({ fingerprint, pass } satisfies KeptPass, key));
    }

    /** What was tracked for a video is forgotten, as far as `isNeeded` says that it is not. */
    forgetPasses(fingerprint: string, isNeeded: (pass: Pass) => boolean): Promise<void> {
        return this.write([PASSES], ([passes]) => {
            const cursor = passes?.index("fingerprint").openCursor(fingerprint);
            if (cursor !== undefined) {
                cursor.onsuccess = () => {
                    const kept = cursor.result?.value as KeptPass | undefined;
                    if (kept !== undefined && !isNeeded(kept.pass)) {
                        cursor.result?.delete();
                    }
                    cursor.result?.continue();
                };
            }
        });
    }

    async video(fingerprint: string): Promise<SourceSpec | undefined> {
        return (await this.read(VIDEOS, (store) => store.get(fingerprint))) as SourceSpec | undefined;
    }

    /** Keeps the video if there is room; says whether it did. */
    async saveVideo(fingerprint: string, spec: SourceSpec): Promise<boolean> {
        const others = (await this.works()).map((work) => work.fingerprint).filter((other) => other !== fingerprint);
        const old = others.slice(MOST_VIDEOS - 1);
        try {
            await this.write([VIDEOS], ([videos]) => {
                old.forEach((other) => videos?.delete(other));
                videos?.put(spec, fingerprint);
            });
            return true;
        } catch {
            return false;
        }
    }

    /** A video's annotation and all that belongs to it. */
    forget(fingerprint: string): Promise<void> {
        return this.forgetPasses(fingerprint, () => false).then(() =>
            this.write([WORKS, VIDEOS], (stores) => stores.forEach((store) => store.delete(fingerprint))),
        );
    }

    private read(name: string, ask: (store: IDBObjectStore) => IDBRequest): Promise<unknown> {
        return new Promise((resolve, reject) => {
            const request = ask(this.database.transaction(name).objectStore(name));
            request.onsuccess = () => resolve(request.result);
            request.onerror = () => reject(request.error ?? new Error("the browser's storage cannot be read"));
        });
    }

    private write(names: readonly string[], change: (stores: readonly IDBObjectStore[]) => unknown): Promise<void> {
        return new Promise((resolve, reject) => {
            const transaction = this.database.transaction([...names], "readwrite");
            transaction.oncomplete = () => resolve();
            const fail = (): void => reject(transaction.error ?? new Error("the browser's storage is full"));
            transaction.onerror = fail;
            transaction.onabort = fail;
            change(names.map((name) => transaction.objectStore(name)));
        });
    }
}
