// An object's box in every frame, as the engine gives it.

import type { Box } from "./document.ts";

export const NOTHING = 0;
export const DRAWN = 1;
export const TRACKED = 2;
export const ABSENT = 3;
export type State = typeof NOTHING | typeof DRAWN | typeof TRACKED | typeof ABSENT;

/** Numbers a frame: left, top, width, height, confidence, state. */
export const COLUMNS = 6;

/** Below this confidence a box is worth a look; the engine's own limit. */
export const DOUBTFUL = 0.5;

export class Track {
    constructor(readonly rows: Float64Array) {}

    static empty(frames: number): Track {
        return new Track(new Float64Array(frames * COLUMNS));
    }

    get frames(): number {
        return this.rows.length / COLUMNS;
    }

    state(frame: number): State {
        return (this.rows[frame * COLUMNS + 5] ?? NOTHING) as State;
    }

    confidence(frame: number): number {
        return this.rows[frame * COLUMNS + 4] ?? 0;
    }

    box(frame: number): Box | null {
        const state = this.state(frame);
        if (state !== DRAWN && state !== TRACKED) {
            return null;
        }
        const [x = 0, y = 0, w = 0, h = 0] = this.rows.subarray(frame * COLUMNS, frame * COLUMNS + 4);
        return { x, y, w, h };
    }

    /** What a pass saw, as it comes. A box that was drawn stays. */
    put(frame: number, seen: readonly number[]): void {
        if (this.state(frame) !== DRAWN) {
            this.rows.set([...seen.slice(0, 5), TRACKED], frame * COLUMNS);
        }
    }
}
