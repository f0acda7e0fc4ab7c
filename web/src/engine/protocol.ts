// What the page and its worker say to each other.

import type { ThingEntry } from "../model/document.ts";
import type { About, SourceSpec } from "../video/source.ts";
import type { Opened, Pass, Place, Sighting } from "./wasm.ts";

/** What the worker can be asked. */
export interface Services {
    open(code: Uint8Array<ArrayBuffer>, spec: SourceSpec): About;
    objects(objects: readonly ThingEntry[]): void;
    /** Tracks what is not known of an object's stretches between two frames; pictures of where it is come with what it sees. */
    track(object: number, before: number, after: number, withPictures: boolean): Tracked;
    stop(): void;
    knownPasses(passes: readonly Pass[]): void;
    rows(object: number): Float64Array<ArrayBuffer>;
    places(): Place[];
    export(format: string): [string, string][];
    project(): string;
    openFile(name: string, text: string): Opened;
}

export type Service = keyof Services;

export interface Tracked {
    /** Frames that were tracked. */
    readonly frames: number;
    /** Milliseconds that it took. */
    readonly milliseconds: number;
    readonly wasStopped: boolean;
}

export interface Request {
    readonly id: number;
    readonly service: Service;
    readonly parameters: readonly unknown[];
}

/** What the worker says: an answer, or what it sees while it tracks. */
export type Message =
    | { readonly is: "answer"; readonly id: number; readonly result: unknown }
    | { readonly is: "refusal"; readonly id: number; readonly message: string; readonly isOurs: boolean }
    | { readonly is: "seen"; readonly object: number; readonly leftToDo: number; readonly rows: readonly (readonly [number, ...Sighting])[]; readonly picture: ImageBitmap | null }
    | { readonly is: "pass"; readonly pass: Pass };
