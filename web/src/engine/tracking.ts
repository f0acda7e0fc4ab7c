// Tracks what is missing of an object, frame by frame, and can be stopped between any two.

import { FrameCache } from "../video/cache.ts";
import type { Pixels } from "../video/source.ts";
import type { Message, Tracked } from "./protocol.ts";
import type { Engine, Leg, Sighting } from "./wasm.ts";

/** How often the page is told, in milliseconds. */
const TELL_EVERY = 40;

export class Tracking {
    private isStopped = false;
    /** The objects were changed: what is missing may be something else now. */
    private isOutdated = false;
    private running: Promise<unknown> = Promise.resolve();

    constructor(
        private readonly engine: Engine,
        private readonly frames: FrameCache<Pixels>,
        private readonly width: number,
        private readonly height: number,
        private readonly tell: (message: Message) => void,
    ) {}

    stop(): void {
        this.isStopped = true;
    }

    outdate(): void {
        this.isOutdated = true;
    }

    /** One run after the other: there is one engine. */
    run(object: number, before: number, after: number, withPictures: boolean): Promise<Tracked> {
        const result = this.running.then(() => this.trackAll(object, before, after, withPictures));
        this.running = result.catch(() => {});
        return result;
    }

    private async trackAll(object: number, before: number, after: number, withPictures: boolean): Promise<Tracked> {
        this.isStopped = false;
        const start = performance.now();
        let frames = 0;
        for (;;) {
            const legs = this.engine.missingLegs(object, before, after);
            const [leg] = legs;
            if (leg === undefined || this.isStopped) {
                break;
            }
            const later = legs.slice(1).reduce((sum, next) => sum + next.count, 0);
            frames += await this.trackLeg(object, leg, later, withPictures, () => this.engine.missingLegs(object, before, after));
        }
        return { frames, milliseconds: performance.now() - start, wasStopped: this.isStopped };
    }

    private async trackLeg(object: number, leg: Leg, later: number, withPictures: boolean, missing: () => Leg[]): Promise<number> {
        const step = leg.direction === "forward" ? 1 : -1;
        this.engine.beginPass(leg, await this.frames.get(leg.from));
        this.isOutdated = false;
        let rows: [number, ...Sighting][] = [];
        let told = performance.now();
        let distance = 0;
        let isNeeded = true;
        const tellNow = async (pixels: Pixels | null): Promise<void> => {
            const picture = withPictures && pixels !== null ? await this.picture(pixels) : null;
            this.tell({ is: "seen", object, leftToDo: leg.count - distance + later, rows, picture });
            rows = [];
            told = performance.now();
        };
        try {
            while (distance < leg.count && !this.isStopped) {
                const frame = leg.from + step * (distance + 1);
                const pixels = await this.frames.get(frame);
                if (this.isOutdated) {
                    this.isOutdated = false;
                    isNeeded = missing().some((other) => isSame(other, leg));
                    if (!isNeeded) {
                        break;
                    }
                }
                rows.push([frame, ...this.engine.see(pixels)]);
                distance++;
                if (performance.now() - told >= TELL_EVERY) {
                    await tellNow(pixels);
                    await nextMessage();
                }
            }
        } finally {
            const pass = this.engine.endPass();
            await tellNow(null);
            if (isNeeded) {
                this.tell({ is: "pass", pass });
            }
        }
        return distance;
    }

    private picture(pixels: Pixels): Promise<ImageBitmap> {
        return createImageBitmap(new ImageData(new Uint8ClampedArray(pixels.buffer), this.width, this.height));
    }
}

function isSame(a: Leg, b: Leg): boolean {
    const [p, q] = [a.start, b.start];
    return a.from === b.from && a.direction === b.direction && p.x === q.x && p.y === q.y && p.w === q.w && p.h === q.h;
}

/** Lets messages in: a promise alone would not. */
function nextMessage(): Promise<void> {
    return new Promise((resolve) => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => {
            port1.close();
            resolve();
        };
        port2.postMessage(null);
    });
}
