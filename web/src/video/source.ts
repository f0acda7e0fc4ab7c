// Frames of a video by number, whatever it is made of.

/** What the page was given. It can be sent to a worker, and kept in the browser's storage. */
export type SourceSpec =
    | { readonly kind: "video"; readonly file: File }
    | { readonly kind: "pictures"; readonly name: string; readonly files: readonly File[] }
    | { readonly kind: "demo" };

/** What is known of a video beside its pixels. */
export interface About {
    readonly name: string;
    /** Tells this video from others. */
    readonly fingerprint: string;
    readonly width: number;
    readonly height: number;
    readonly frames: number;
    /** Presentation times in seconds since the start; none for pictures. */
    readonly times: Float64Array | null;
    /** The time of the first frame as the container has it, in seconds. */
    readonly start: number;
    /** What each frame is called: file names, or `frame N`. */
    readonly labels: readonly string[];
    /** For each frame the one from which the decoder has to start. */
    readonly startsAt: Uint32Array;
}

/** Pixels of a frame: red, green, blue, alpha. */
export type Pixels = Uint8Array<ArrayBuffer>;

/** A decoded frame; closed by whoever asked for it. */
export interface Sample {
    pixels(): Promise<Pixels>;
    picture(): Promise<ImageBitmap>;
    close(): void;
}

export interface Source {
    readonly about: About;
    /** The frame of this number. The one after the last that was asked for costs least. */
    sample(frame: number): Promise<Sample>;
    close(): void;
}

/** Something that a person can put right; its message says how. */
export class SourceError extends Error {}

/** Where the demo clip comes from. */
export interface DemoFrames {
    demoSize(): { width: number; height: number; frames: number };
    demoFrame(frame: number): Pixels;
}

/** Without key frames: every frame can be had for itself. */
export function everyFrame(frames: number): Uint32Array {
    return Uint32Array.from({ length: frames }, (_, frame) => frame);
}
