// Frames by number in any order: those that were asked for lately are kept, up to a number of bytes.
//
// A decoder goes forward only. So a frame that lies before the last one brings with it those that the decoder passes on its way there,
// as many as may be kept: who steps back once steps back again.

import type { Sample, Source } from "./source.ts";

export interface Conversion<T> {
    convert(sample: Sample): Promise<T>;
    discard(kept: T): void;
}

export const TO_PIXELS: Conversion<Uint8Array<ArrayBuffer>> = { convert: (sample) => sample.pixels(), discard: () => {} };
export const TO_PICTURE: Conversion<ImageBitmap> = { convert: (sample) => sample.picture(), discard: (picture) => picture.close() };

export class FrameCache<T> {
    /** In the order of use, the latest last. */
    private readonly kept = new Map<number, T>();
    private readonly most: number;
    private last = -1;
    private busy: Promise<unknown> = Promise.resolve();

    constructor(
        private readonly source: Source,
        private readonly conversion: Conversion<T>,
        bytes: number,
    ) {
        this.most = Math.max(8, Math.floor(bytes / (source.about.width * source.about.height * 4)));
    }

    /** What is kept of the frame, without waiting. */
    peek(frame: number): T | undefined {
        return this.kept.get(frame);
    }

    /** The frame; requests are served one after the other, since there is one decoder. */
    get(frame: number): Promise<T> {
        const found = this.busy.then(() => this.find(frame));
        this.busy = found.catch(() => {});
        return found;
    }

    close(): void {
        void this.busy.then(() => {
            this.kept.forEach((kept) => this.conversion.discard(kept));
            this.kept.clear();
            this.source.close();
        });
    }

    private async find(frame: number): Promise<T> {
        const isBackward = frame < this.last;
        this.last = frame;
        const known = this.kept.get(frame);
        if (known !== undefined) {
            this.kept.delete(frame);
            this.kept.set(frame, known);
            return known;
        }
        const start = isBackward ? this.startOfStretch(frame) : frame;
        for (let passed = start; passed < frame; passed++) {
            await this.decode(passed);
        }
        return this.decode(frame);
    }

    /** Where to start so that the frames before this one are kept too, which cost nothing more; half of what may be kept. */
    private startOfStretch(frame: number): number {
        const decodedFrom = this.source.about.startsAt[frame] ?? frame;
        let start = Math.max(decodedFrom, frame - Math.floor(this.most / 2));
        while (start < frame && this.kept.has(start)) {
            start++;
        }
        return start;
    }

    private async decode(frame: number): Promise<T> {
        const sample = await this.source.sample(frame);
        try {
            const converted = await this.conversion.convert(sample);
            this.keep(frame, converted);
            return converted;
        } finally {
            sample.close();
        }
    }

    private keep(frame: number, converted: T): void {
        const before = this.kept.get(frame);
        if (before !== undefined) {
            this.conversion.discard(before);
            this.kept.delete(frame);
        }
        this.kept.set(frame, converted);
        for (const [oldest, value] of this.kept) {
            if (this.kept.size <= this.most) {
                break;
            }
            this.kept.delete(oldest);
            this.conversion.discard(value);
        }
    }
}
