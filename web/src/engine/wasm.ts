// The engine in WebAssembly, as web/wasm/src/lib.rs describes its calls.

import type { ThingEntry } from "../model/document.ts";
import { COLUMNS } from "../model/track.ts";
import { SourceError, type About, type DemoFrames, type Pixels } from "../video/source.ts";

interface Exports {
    readonly memory: WebAssembly.Memory;
    start(): void;
    input(bytes: number): number;
    pixels(bytes: number): number;
    output(): number;
    output_bytes(): number;
    request(): number;
    begin_pass(): number;
    see(): number;
    track(thing: number): number;
    demo_frame(frame: number): number;
}

export interface Leg {
    readonly from: number;
    readonly start: { readonly x: number; readonly y: number; readonly w: number; readonly h: number };
    readonly direction: "forward" | "backward";
    readonly count: number;
}

/** What a pass saw: left, top, width, height, confidence. */
export type Sighting = readonly [number, number, number, number, number];

export interface Pass {
    readonly from: number;
    readonly start: Leg["start"];
    readonly direction: Leg["direction"];
    readonly sightings: readonly Sighting[];
}

/** Neighbouring frames whose boxes are doubtful; frames count from 0. */
export interface Place {
    readonly object: number;
    readonly frame: number;
    readonly first: number;
    readonly last: number;
    readonly confidence: number;
}

/** Objects from a file, with what is known of where they are. */
export interface Opened {
    readonly objects: readonly ThingEntry[];
    readonly passes: readonly Pass[];
}

/** Something failed inside the engine, which must not happen; its state is lost. */
export class EngineFailure extends Error {}

export class Engine implements DemoFrames {
    private constructor(private readonly calls: Exports) {
        calls.start();
    }

    static async start(code: Uint8Array<ArrayBuffer>): Promise<Engine> {
        const { instance } = await WebAssembly.instantiate(code, {});
        return new Engine(instance.exports as unknown as Exports);
    }

    video(about: About): void {
        const { name, fingerprint, width, height, labels } = about;
        const times = about.times === null ? labels.map(() => null) : [...about.times];
        this.ask({ ask: "video", name, fingerprint, width, height, labels, times });
    }

    objects(objects: readonly ThingEntry[]): void {
        this.ask({ ask: "objects", objects });
    }

    /** The passes that are not known of the stretches between two frames. */
    missingLegs(object: number, before: number, after: number): Leg[] {
        return this.ask({ ask: "missing_legs", object, before, after }) as Leg[];
    }

    beginPass(leg: Leg, keyFrame: Pixels): void {
        this.ask({ ask: "plan", leg });
        this.write(keyFrame, (bytes) => this.calls.pixels(bytes));
        this.call(() => this.calls.begin_pass());
    }

    see(pixels: Pixels): Sighting {
        this.write(pixels, (bytes) => this.calls.pixels(bytes));
        this.call(() => this.calls.see());
        return [...this.numbers()] as unknown as Sighting;
    }

    endPass(): Pass {
        return this.ask({ ask: "end_pass" }) as Pass;
    }

    knownPass(pass: Pass): void {
        this.ask({ ask: "known_pass", pass });
    }

    rows(object: number): Float64Array<ArrayBuffer> {
        this.call(() => this.calls.track(object));
        const rows = this.numbers();
        return rows.length % COLUMNS === 0 ? rows : new Float64Array();
    }

    places(): Place[] {
        return this.ask({ ask: "places" }) as Place[];
    }

    /** Files as pairs of name and text; the only file of most formats has no name. */
    export(format: string): [string, string][] {
        return this.ask({ ask: "export", format }) as [string, string][];
    }

    project(): string {
        return this.ask({ ask: "project" }) as string;
    }

    openFile(name: string, text: string): Opened {
        return this.ask({ ask: "open_file", name, text }) as Opened;
    }

    demoSize(): { width: number; height: number; frames: number; truth: readonly ([number, number, number, number] | null)[] } {
        return this.ask({ ask: "demo" }) as ReturnType<Engine["demoSize"]>;
    }

    demoFrame(frame: number): Pixels {
        this.call(() => this.calls.demo_frame(frame));
        return this.answer().slice();
    }

    private ask(request: object): unknown {
        this.write(new TextEncoder().encode(JSON.stringify(request)), (bytes) => this.calls.input(bytes));
        this.call(() => this.calls.request());
        return JSON.parse(new TextDecoder().decode(this.answer()));
    }

    private write(bytes: Uint8Array, buffer: (bytes: number) => number): void {
        const at = buffer(bytes.length);
        // The memory may have grown, and then has another buffer.
        new Uint8Array(this.calls.memory.buffer, at, bytes.length).set(bytes);
    }

    private call(call: () => number): void {
        let status: number;
        try {
            status = call();
        } catch (error) {
            const words = new TextDecoder().decode(this.answer());
            throw new EngineFailure(`The engine failed (${words || String(error)}). Load the page again: what you did is saved.`);
        }
        if (status !== 0) {
            throw new SourceError(new TextDecoder().decode(this.answer()));
        }
    }

    private answer(): Pixels {
        return new Uint8Array(this.calls.memory.buffer as ArrayBuffer, this.calls.output(), this.calls.output_bytes());
    }

    private numbers(): Float64Array<ArrayBuffer> {
        return new Float64Array(this.answer().slice().buffer);
    }
}
