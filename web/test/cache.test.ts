// Frames by number, over a source that writes down what it is asked.

import { expect, test } from "vitest";
import { FrameCache } from "../src/video/cache.ts";
import type { About, Sample, Source } from "../src/video/source.ts";

const GROUP = 10;

/** 100 frames of one pixel; a decoder starts at every tenth. */
function source(): { source: Source; asked: number[]; open: () => number } {
    const asked: number[] = [];
    let open = 0;
    const about: About = {
        name: "s", fingerprint: "s", width: 1, height: 1, frames: 100, times: null, start: 0,
        labels: [],
        startsAt: Uint32Array.from({ length: 100 }, (_, frame) => frame - (frame % GROUP)),
    };
    const sample = (frame: number): Promise<Sample> => {
        asked.push(frame);
        open++;
        return Promise.resolve({ pixels: () => Promise.resolve(new Uint8Array([frame])), picture: () => Promise.reject(new Error("none")), close: () => open-- });
    };
    return { source: { about, sample, close: () => {} }, asked, open: () => open };
}

function cacheOf(from: Source, frames: number): { cache: FrameCache<number>; discarded: number[] } {
    const discarded: number[] = [];
    const conversion = { convert: async (sample: Sample) => (await sample.pixels())[0] ?? -1, discard: (frame: number) => discarded.push(frame) };
    return { cache: new FrameCache(from, conversion, frames * 4), discarded };
}

test("every frame is the one that was asked for, in whatever order, and all samples are closed", async () => {
    const { source: from, open } = source();
    const { cache } = cacheOf(from, 8);
    const order = [0, 1, 2, 50, 49, 48, 47, 3, 99, 98, 50, 51, 0];
    expect(await Promise.all(order.map((frame) => cache.get(frame)))).toEqual(order);
    expect(open()).toBe(0);
});

test("who steps back finds the frames before already decoded, from where the decoder had to start", async () => {
    const { source: from, asked } = source();
    const { cache } = cacheOf(from, 40);
    await cache.get(27);
    for (const frame of [26, 25, 24, 23, 22, 21, 20]) {
        await cache.get(frame);
    }
    expect(asked).toEqual([27, 20, 21, 22, 23, 24, 25, 26]);
    await cache.get(19);
    expect(asked.slice(8)).toEqual([10, 11, 12, 13, 14, 15, 16, 17, 18, 19]);
});

test("no more is kept than may be, and what was used last stays longest", async () => {
    const { source: from, asked } = source();
    const { cache, discarded } = cacheOf(from, 8);
    for (let frame = 0; frame < 8; frame++) {
        await cache.get(frame);
    }
    // Frame 0 is used again, so frame 1 is the oldest.
    await cache.get(0);
    await cache.get(50);
    expect(discarded).toEqual([1]);
    expect(cache.peek(0)).toBe(0);
    expect(asked.length).toBe(9);
});

test("a frame that fails fails alone", async () => {
    const { source: from } = source();
    const { cache } = cacheOf({ ...from, sample: (frame) => (frame === 5 ? Promise.reject(new Error("damaged")) : from.sample(frame)) }, 8);
    const [five, six] = await Promise.allSettled([cache.get(5), cache.get(6)]);
    expect(five.status).toBe("rejected");
    expect(six).toEqual({ status: "fulfilled", value: 6 });
});
