// Plays at the video's own pace; pictures that come too late are left out.

import type { About } from "../video/source.ts";

const WITHOUT_TIMES = 25;

export class Player {
    private start: { at: number; time: number } | null = null;

    constructor(
        private readonly about: About,
        private readonly go: (frame: number) => void,
        private readonly changed: () => void,
    ) {}

    get isPlaying(): boolean {
        return this.start !== null;
    }

    toggle(frame: number): void {
        if (this.isPlaying) {
            this.stop();
        } else {
            const from = frame + 1 < this.about.frames ? frame : 0;
            this.go(from);
            this.start = { at: performance.now(), time: this.time(from) };
            this.changed();
            this.tick();
        }
    }

    stop(): void {
        if (this.start !== null) {
            this.start = null;
            this.changed();
        }
    }

    private tick(): void {
        requestAnimationFrame(() => {
            if (this.start === null) {
                return;
            }
            const time = this.start.time + (performance.now() - this.start.at) / 1000;
            const frame = this.frameAt(time);
            this.go(frame);
            if (frame + 1 >= this.about.frames) {
                this.stop();
            } else {
                this.tick();
            }
        });
    }

    private time(frame: number): number {
        return this.about.times?.[frame] ?? frame / WITHOUT_TIMES;
    }

    /** The last frame that is shown at this time. */
    private frameAt(time: number): number {
        let [low, high] = [0, this.about.frames - 1];
        while (low < high) {
            const middle = Math.ceil((low + high) / 2);
            if (this.time(middle) <= time) {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        return low;
    }
}
