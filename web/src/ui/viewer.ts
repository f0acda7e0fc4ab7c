// Brings the picture of a frame to the stage: the latest that was asked for, never one after the other in a queue.

import { FrameCache, TO_PICTURE } from "../video/cache.ts";
import type { Source } from "../video/source.ts";
import type { Stage } from "./stage.ts";

/** Pictures that are kept, in bytes. */
const KEPT = 256 << 20;

export class Viewer {
    private readonly cache: FrameCache<ImageBitmap>;
    private wanted: number | null = null;
    private isBusy = false;
    private handed: ImageBitmap | null = null;

    constructor(
        source: Source,
        private readonly stage: Stage,
        private readonly failed: (error: unknown) => void,
    ) {
        this.cache = new FrameCache(source, TO_PICTURE, KEPT);
    }

    /** Whether the last picture that was asked for is there. */
    get isReady(): boolean {
        return !this.isBusy;
    }

    show(frame: number): void {
        this.wanted = frame;
        if (!this.isBusy) {
            void this.work();
        }
    }

    /** A picture that somebody else decoded. */
    showThis(picture: ImageBitmap, frame: number): void {
        this.wanted = null;
        this.stage.show(picture, frame);
        this.handed?.close();
        this.handed = picture;
    }

    close(): void {
        this.wanted = null;
        this.cache.close();
    }

    private async work(): Promise<void> {
        this.isBusy = true;
        while (this.wanted !== null) {
            const frame = this.wanted;
            this.wanted = null;
            try {
                const picture = await this.cache.get(frame);
                // What was handed over meanwhile is newer.
                if (this.wanted === null || this.wanted === frame) {
                    this.stage.show(picture, frame);
                }
            } catch (error) {
                this.failed(error);
            }
        }
        this.isBusy = false;
    }
}
