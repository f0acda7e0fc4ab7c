// Videos as people have them: codecs, frames out of order, variable rates, turned pictures, folders.

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import type { Browser, BrowserContext } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, test } from "vitest";
import { Engine } from "../src/engine/wasm.ts";
import { Visitor, boxesOf, chromiumPath, launch, overlap, type Rect } from "./browser.ts";
import { dataFolder, folder, hasFfmpeg, made, probed, rawFile } from "./clips.ts";

/** The program whose boxes are compared with, if it is built. */
const PROGRAM = process.env["INFOPART_PROGRAM"] ?? null;
const canRun = chromiumPath !== null && hasFfmpeg;
if (!canRun) {
    console.log("SKIPPED: the tests of videos, which need Chromium, ffmpeg and ffprobe");
}
if (PROGRAM === null) {
    console.log("SKIPPED: comparing boxes with the program's, since INFOPART_PROGRAM does not name it");
}

const WALK = 60;
const H264 = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-preset", "veryfast", "-g", "25", "-bf", "3"];
const VP9 = ["-c:v", "libvpx-vp9", "-pix_fmt", "yuv420p", "-deadline", "realtime", "-cpu-used", "8", "-g", "25"];

describe.skipIf(!canRun)("a video", () => {
    let browser: Browser;
    let context: BrowserContext;
    let visitor: Visitor;
    let size: ReturnType<Engine["demoSize"]>;
    let raw: string[];
    let decodes: Record<string, boolean>;

    beforeAll(async () => {
        browser = await launch();
        const engine = await Engine.start(new Uint8Array(readFileSync(join(import.meta.dirname, "../src/engine/infopart.wasm"))));
        size = engine.demoSize();
        const frames = Array.from({ length: WALK }, (_, frame) => engine.demoFrame(frame));
        raw = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", `${size.width}x${size.height}`, "-r", "25", "-i", rawFile("walk.raw", frames)];
        const page = await browser.newPage();
        await page.goto("about:blank");
        const asked = await Visitor.arrive(await browser.newContext());
        decodes = await asked.page.evaluate(async () => {
            const can = async (codec: string): Promise<boolean> => (await VideoDecoder.isConfigSupported({ codec, codedWidth: 640, codedHeight: 480 })).supported ?? false;
            return { h264: await can("avc1.64001f"), vp9: await can("vp09.00.10.08") };
        });
        for (const [codec, can] of Object.entries(decodes)) {
            if (!can) {
                console.log(`SKIPPED: ${codec}, which this Chromium does not decode`);
            }
        }
    });
    afterAll(() => browser?.close());
    beforeEach(async () => {
        context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true });
        visitor = await Visitor.arrive(context);
    });
    afterEach(async () => {
        expect(visitor.problems).toEqual([]);
        await context.close();
    });

    /** How bright the middle of the shown picture is, once it is the picture of that frame. */
    async function brightness(): Promise<number> {
        await visitor.seen();
        return visitor.page.evaluate(() => {
            const canvas = document.querySelector<HTMLCanvasElement>(".stage-canvas");
            const pixel = canvas?.getContext("2d")?.getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data;
            return pixel?.[1] ?? -1;
        });
    }

    async function dropAndOpen(path: string): Promise<void> {
        await visitor.drop(path);
        await visitor.opened(basename(path));
    }

    /** Tracks forward from a box in the first frame; boxes by frame. */
    async function track(width: number, height: number, box: Rect): Promise<ReturnType<typeof boxesOf>> {
        await visitor.draw(width, height, box);
        await visitor.page.waitForSelector(".thing.selected");
        await visitor.press("t");
        await visitor.tracked();
        return boxesOf(await visitor.csv());
    }

    /** The program's boxes from the same first box, and by how much they differ from the page's. */
    function compare(input: string, ours: ReturnType<typeof boxesOf>, truth: ((frame: number) => Rect) | null): void {
        if (PROGRAM === null) {
            return;
        }
        const { x = 0, y = 0, w = 0, h = 0 } = ours.get(0) ?? {};
        const keys = join(folder, "keys.json");
        writeFileSync(keys, JSON.stringify({ version: 1, objects: [{ name: "a", keys: [{ frame: 1, box: [x, y, w, h] }] }] }));
        const theirs = boxesOf(String(execFileSync(PROGRAM, ["annotate", input, "--keys", keys, "--format", "csv", "--quiet", "--threads", "1"])));
        expect(theirs.size).toBe(ours.size);
        const apart = [...ours].map(([frame, box]) => {
            const other = theirs.get(frame) as Rect;
            return Math.max(Math.abs(box.x - other.x), Math.abs(box.y - other.y), Math.abs(box.w - other.w), Math.abs(box.h - other.h));
        });
        const mean = (boxes: ReturnType<typeof boxesOf>): number => [...boxes].reduce((sum, [frame, box]) => sum + (truth === null ? 0 : overlap(box, truth(frame))), 0) / boxes.size;
        const sorted = [...apart].sort((a, b) => a - b);
        const told = truth === null ? "" : `; mean overlap with the truth ${mean(ours).toFixed(4)} here, ${mean(theirs).toFixed(4)} there`;
        console.log(`${basename(input)}: boxes differ from the program's by ${sorted[Math.floor(sorted.length / 2)]?.toFixed(2)} px in the median, ${sorted.at(-1)?.toFixed(2)} at most${told}`);
        const overlaps = [...ours].map(([frame, box]) => overlap(box, theirs.get(frame) as Rect));
        expect(overlaps.reduce((sum, value) => sum + value, 0) / overlaps.length).toBeGreaterThan(0.9);
    }

    const truth = (frame: number): Rect => {
        const [x, y, w, h] = size.truth[frame] ?? [0, 0, 0, 0];
        return { x, y, w, h };
    };

    for (const [codec, extension, options] of [["h264", "mp4", H264], ["vp9", "webm", VP9]] as const) {
        test(`in ${codec}: its frames are those that ffprobe counts, each with its own picture, and it is tracked`, async (context) => {
            if (!decodes[codec]) {
                context.skip();
            }
            const path = made(`walk-${codec}.${extension}`, ...raw, ...options);
            await dropAndOpen(path);
            const { frames, width, height } = probed(path);
            expect(await visitor.page.locator(".size").textContent()).toBe(`${width} × ${height}, ${frames} frames`);
            const boxes = await track(width, height, truth(0));
            expect(boxes.size).toBe(frames);
            const mean = [...boxes].reduce((sum, [frame, box]) => sum + overlap(box, truth(frame)), 0) / boxes.size;
            expect(mean).toBeGreaterThan(0.6);
            compare(path, boxes, truth);
            // Backward from a box at the end of a video that is known from its beginning.
            await visitor.page.reload();
            await visitor.page.click(".resume");
            await visitor.opened(basename(path));
            expect(boxesOf(await visitor.csv())).toEqual(boxes);
            await visitor.press("o", "End");
            await visitor.draw(width, height, truth(frames - 1));
            await visitor.press("Shift+T");
            await visitor.tracked();
            const back = boxesOf(await visitor.csv(), 2);
            expect(back.size).toBe(frames);
            expect(overlap(back.get(0) as Rect, truth(0))).toBeGreaterThan(0.4);
        });
    }

    const NUMBERED = "nullsrc=s=160x120:r=25,geq=lum='20+3*N':cb=128:cr=128";
    const UNEVEN = "setpts=(N+3*floor(N/7))/25/TB";
    for (const [name, codec, options] of [
        ["numbered.mp4", "h264", H264],
        ["numbered.webm", "vp9", VP9],
        ["uneven.mp4", "h264", [...H264, "-vf", UNEVEN, "-vsync", "passthrough"]],
        ["uneven.webm", "vp9", [...VP9, "-vf", UNEVEN, "-vsync", "passthrough"]],
    ] as const) {
        test(`${name}: every frame that is asked for is the one that is shown, at its own time`, async (context) => {
            if (!decodes[codec]) {
                context.skip();
            }
            const path = made(name, "-f", "lavfi", "-i", NUMBERED, "-frames:v", "60", ...options);
            const { frames, times } = probed(path);
            expect(frames).toBe(60);
            await dropAndOpen(path);
            expect(await visitor.page.locator(".size").textContent()).toContain(`${frames} frames`);
            for (const frame of [0, 1, 2, 31, 30, 29, 24, 25, 59, 7]) {
                await visitor.goTo(frame);
                // Limited range: 16 is black, 235 white.
                const expected = ((20 + 3 * frame - 16) * 255) / 219;
                expect(Math.abs((await brightness()) - expected), `frame ${frame + 1}`).toBeLessThan(1.7);
                const seconds = times[frame] ?? 0;
                expect((await visitor.where()).split("  ")[1]).toBe(`0:${seconds.toFixed(2).padStart(5, "0")}`);
            }
            await visitor.press("ArrowLeft", "ArrowLeft");
            await visitor.page.waitForFunction(() => document.querySelector(".where")?.textContent?.startsWith("6 / "));
            expect(Math.abs((await brightness()) - ((20 + 3 * 5 - 16) * 255) / 219)).toBeLessThan(1.7);
        });
    }

    test("that was filmed upright is shown and tracked upright", async (context) => {
        if (!decodes["h264"]) {
            context.skip();
        }
        const lying = made("lying.mp4", ...raw, ...H264);
        const path = made("upright.mp4", "-i", lying, "-c", "copy", "-metadata:s:v:0", "rotate=90");
        const { frames, width, height } = probed(path);
        await dropAndOpen(path);
        expect(await visitor.page.locator(".size").textContent()).toBe(`${size.height} × ${size.width}, ${frames} frames`);
        expect([width, height]).toEqual([size.height, size.width]);
        // Whichever way it was turned, the program turns it so too.
        const { x, y, w, h } = truth(0);
        const boxes = await track(width, height, { x: size.height - y - h, y: x, w: h, h: w });
        expect(boxes.size).toBe(frames);
        compare(path, boxes, null);
    });

    test("as a folder of pictures is taken in the order of their numbers", async () => {
        const pictures = join(folder, "walk of pictures");
        mkdirSync(pictures);
        made(join("walk of pictures", "%d.png"), ...raw, "-frames:v", "12");
        await visitor.drop(pictures);
        await visitor.opened("walk of pictures");
        expect(await visitor.page.locator(".size").textContent()).toBe(`${size.width} × ${size.height}, 12 frames`);
        const boxes = await track(size.width, size.height, truth(0));
        expect(boxes.size).toBe(12);
        expect(overlap(boxes.get(11) as Rect, truth(11))).toBeGreaterThan(0.6);
        const coco = JSON.parse(String((await visitor.exported("COCO")).bytes)) as { images: { file_name: string }[] };
        expect(coco.images.map((image) => image.file_name)).toEqual(Array.from({ length: 12 }, (_, at) => `${at + 1}.png`));
        compare(pictures, boxes, truth);
    });

    test("that is no film but a still of 8K, and a box that reaches beyond it, do no harm", async () => {
        const path = made("large.png", "-f", "lavfi", "-i", "testsrc2=s=7680x4320:d=0.04", "-frames:v", "1");
        await visitor.drop(path);
        await visitor.opened("pictures");
        await visitor.draw(7680, 4320, { x: 7000, y: 4000, w: 2000, h: 2000 });
        await visitor.page.waitForSelector(".thing.selected");
        const box = boxesOf(await visitor.csv()).get(0) as Rect;
        expect(box.x + box.w).toBeLessThanOrEqual(7680.001);
        expect(box.y + box.h).toBeLessThanOrEqual(4320.001);
        await visitor.press("t");
        expect(await visitor.toast()).not.toBe("");
    });

    test("real: a sequence of TB-100 as H.264 has the program's overlap", async (context) => {
        const sequence = join(dataFolder() ?? "", "otb/Crossing");
        if (!decodes["h264"] || !existsSync(sequence)) {
            console.log("SKIPPED: Crossing of TB-100, which INFOPART_DATA does not hold");
            context.skip();
        }
        const rows = readFileSync(join(sequence, "groundtruth_rect.txt"), "utf8").trim().split("\n");
        const real = (frame: number): Rect => {
            const [x = 0, y = 0, w = 0, h = 0] = (rows[frame] ?? "").split(/[,\t ]+/).map(Number);
            return { x: x - 1, y: y - 1, w, h };
        };
        const path = made("crossing.mp4", "-framerate", "25", "-i", join(sequence, "img/%04d.jpg"), ...H264, "-crf", "10");
        const { width, height, frames } = probed(path);
        await dropAndOpen(path);
        const boxes = await track(width, height, real(0));
        expect(boxes.size).toBe(frames);
        const mean = [...boxes].reduce((sum, [frame, box]) => sum + overlap(box, real(frame)), 0) / boxes.size;
        console.log(`Crossing as H.264: mean overlap ${mean.toFixed(4)}`);
        expect(mean).toBeGreaterThan(0.7);
        compare(path, boxes, real);
    });

    test("of 1,000 frames of 640x480 is tracked in the seconds that are printed", async (context) => {
        if (!decodes["h264"]) {
            context.skip();
        }
        const path = made("long.mp4", "-f", "lavfi", "-i", "testsrc2=s=640x480:r=25", "-frames:v", "1000", ...H264, "-preset", "ultrafast");
        await dropAndOpen(path);
        await visitor.draw(640, 480, { x: 300, y: 150, w: 60, h: 140 });
        await visitor.page.waitForSelector(".thing.selected");
        await visitor.press("t");
        console.log(`1,000 frames of 640x480: ${await visitor.tracked()}`);
        expect(boxesOf(await visitor.csv()).size).toBe(1000);
    });
});
