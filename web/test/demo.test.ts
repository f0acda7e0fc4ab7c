// The first minute and the hour after it: the demo clip, annotated by mouse and keys.

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser, BrowserContext } from "playwright-core";
import { afterAll, beforeAll, describe, expect, test } from "vitest";
import { Engine } from "../src/engine/wasm.ts";
import { Visitor, boxesOf, builtPage, chromiumPath, launch, overlap, type Rect } from "./browser.ts";
import { folder } from "./clips.ts";

const PICTURES = join(import.meta.dirname, "pictures");
const ODD = `<img src=x onerror="document.title='hacked'"> & "Ada", 'B'`;

if (chromiumPath === null) {
    console.log("SKIPPED: the browser tests, since there is no Chromium; apt-get install chromium");
}

describe.skipIf(chromiumPath === null)("the demo clip", () => {
    let browser: Browser;
    let context: BrowserContext;
    let size: ReturnType<Engine["demoSize"]>;
    let visitor: Visitor;
    const truth = (frame: number): Rect => {
        const [x, y, w, h] = size.truth[frame] ?? [0, 0, 0, 0];
        return { x, y, w, h };
    };

    beforeAll(async () => {
        mkdirSync(PICTURES, { recursive: true });
        const code = readFileSync(join(import.meta.dirname, "../src/engine/infopart.wasm"));
        size = (await Engine.start(new Uint8Array(code))).demoSize();
        browser = await launch();
        context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true, colorScheme: "light" });
        visitor = await Visitor.arrive(context);
        await visitor.page.screenshot({ path: join(PICTURES, "welcome-light.png") });
    });
    afterAll(() => browser?.close());

    test("is one click away, is tracked from one drawn box, and the boxes are on the walker", async () => {
        await visitor.page.click(".demo");
        await visitor.opened("demo walk");
        expect(await visitor.where()).toMatch(/^1 \/ 180/);
        await visitor.draw(size.width, size.height, truth(0));
        await visitor.page.waitForSelector(".thing.selected");
        await visitor.press("t");
        await visitor.page.waitForFunction(() => document.querySelector(".progress")?.textContent?.includes("to go"));
        expect(await visitor.tracked()).toMatch(/^179 frames in/);
        const boxes = boxesOf(await visitor.csv());
        expect(boxes.size).toBe(180);
        const mean = [...boxes].reduce((sum, [frame, box]) => sum + overlap(box, truth(frame)), 0) / boxes.size;
        console.log(`mean overlap with the truth from one box: ${mean.toFixed(3)}`);
        expect(mean).toBeGreaterThan(0.5);
        await visitor.page.screenshot({ path: join(PICTURES, "tracked-light.png") });
    });

    test("a name is text, whatever it holds", async () => {
        await visitor.press("r");
        await visitor.page.keyboard.type(ODD);
        await visitor.press("Enter");
        await visitor.page.waitForFunction((odd) => document.querySelector(".strip-label")?.textContent === odd, ODD);
        expect(await visitor.page.locator("#app img").count()).toBe(0);
        expect(await visitor.page.title()).not.toContain("hacked");
        const xml = String((await visitor.exported("CVAT")).bytes);
        expect(xml).toContain("&lt;img src=x onerror=&quot;document.title=&apos;hacked&apos;&quot;&gt; &amp; &quot;Ada&quot;, &apos;B&apos;");
        expect(xml).not.toContain("<img");
        expect(await visitor.csv()).toContain(`1,1,"${ODD.replaceAll('"', '""')}",person,`);
    });

    test("a correction is a key frame and changes only the stretches that it touches", async () => {
        await visitor.goTo(150);
        await visitor.press("Enter");
        await visitor.tracked();
        const before = boxesOf(await visitor.csv());
        await visitor.goTo(60);
        const here = boxesOf(await visitor.csv()).get(60);
        expect(here).toBeDefined();
        if (here !== undefined) {
            // By its middle the whole box moves.
            const middle = { x: here.x + here.w / 2, y: here.y + here.h / 2 };
            const { x, y, w, h } = truth(60);
            await visitor.drag(size.width, size.height, middle, { x: x + w / 2, y: y + h / 2 });
        }
        await visitor.tracked();
        const after = boxesOf(await visitor.csv());
        expect([...after].filter(([, box]) => box.isKey).map(([frame]) => frame)).toEqual([0, 60, 150]);
        for (let frame = 151; frame < 180; frame++) {
            expect(after.get(frame)).toEqual(before.get(frame));
        }
        expect([...after].filter(([frame, box]) => JSON.stringify(box) !== JSON.stringify(before.get(frame))).length).toBeGreaterThan(20);
        expect(overlap(after.get(60) as Rect, truth(60))).toBeGreaterThan(0.6);
    });

    test("undo and redo go back and forth without tracking anything", async () => {
        const corrected = await visitor.csv();
        await visitor.press("Control+z", "Control+z");
        await visitor.settled();
        const undone = await visitor.csv();
        expect([...boxesOf(undone)].filter(([, box]) => box.isKey).map(([frame]) => frame)).toEqual([0]);
        await visitor.press("Control+Shift+z", "Control+y");
        await visitor.settled();
        expect(await visitor.csv()).toBe(corrected);
    });

    test("nothing is lost when the page is loaded again, nor when the tab is killed", async () => {
        const before = await visitor.csv();
        await visitor.page.reload();
        await visitor.page.click(".resume");
        await visitor.opened("demo walk");
        expect(await visitor.csv()).toBe(before);
        expect(await visitor.where()).toMatch(/^61 \/ 180/);
        // Absent from frame 171 on; and at once the tab dies.
        await visitor.goTo(170);
        await visitor.press("x");
        await visitor.page.waitForTimeout(100);
        const crash = visitor.page.waitForEvent("crash");
        await visitor.page.goto("chrome://crash").catch(() => {});
        await crash;
        await visitor.page.close();
        visitor = await Visitor.arrive(context);
        await visitor.page.click(".resume");
        await visitor.opened("demo walk");
        expect(boxesOf(await visitor.csv()).size).toBe(170);
        await visitor.press("Control+z");
        await visitor.settled();
        expect(await visitor.csv()).toBe(before);
    });

    test("every export is there, and what is exported is imported again as it was", async () => {
        const before = await visitor.csv();
        const kinds = ["CSV", "CVAT", "MOTChallenge", "COCO", "JSON lines", "OTB"];
        const files = [];
        for (const kind of kinds) {
            const { name, bytes } = await visitor.exported(kind);
            const path = join(folder, `${kind}-${name}`);
            writeFileSync(path, bytes);
            files.push(path);
        }
        const zip = await visitor.exported("YOLO");
        expect(zip.name).toBe("demo walk.zip");
        expect(zip.bytes.subarray(0, 2).toString()).toBe("PK");
        const [project] = await Promise.all([visitor.page.waitForEvent("download"), visitor.press("Control+s")]);
        expect(project.suggestedFilename()).toBe("demo walk.infopart.json");
        files.push(await project.path().then((path) => (writeFileSync(join(folder, "p.json"), readFileSync(path)), join(folder, "p.json"))));
        for (const file of files) {
            await visitor.drop(file);
            expect(await visitor.toast(), file).toContain("1 objects");
            await visitor.page.locator(".toast").click();
            await visitor.settled();
            const after = boxesOf(await visitor.csv());
            const expected = boxesOf(before);
            expect(after.size, file).toBe(expected.size);
            for (const [frame, box] of expected) {
                const found = after.get(frame) as Rect;
                // CVAT has two decimals.
                const apart = Math.max(Math.abs(found.x - box.x), Math.abs(found.y - box.y), Math.abs(found.w - box.w), Math.abs(found.h - box.h));
                expect(apart, `${file}, frame ${frame + 1}`).toBeLessThan(0.011);
            }
            await visitor.press("Control+z");
            await visitor.settled();
        }
        expect(await visitor.csv()).toBe(before);
    });

    test("files that are none leave everything as it is and say what is wrong", async () => {
        const before = await visitor.csv();
        const whole = readFileSync(join(folder, "p.json"), "utf8");
        for (const [name, text, reason] of [
            ["cut.json", whole.slice(0, -100), "cut.json: is cut short"],
            ["other.json", whole.replace('"version":1', '"version":7'), "is of version 7"],
            ["odd.csv", "frame,x,y,w,h\n1,2,3,4\n", "is no number"],
            ["far.csv", "frame,x,y,w,h\n9999,2,3,4,4\n", "the video has 180 frames"],
            ["words.txt", "hello", "is none of CSV"],
            ["notes.mp4", "this is no video", "is not a video that a browser can read"],
            ["empty.mp4", "", "is not a video that a browser can read"],
        ] as const) {
            writeFileSync(join(folder, name), text);
            await visitor.drop(join(folder, name));
            await visitor.page.waitForFunction((words) => document.querySelector(".toast.problem")?.textContent?.includes(words), reason);
            await visitor.page.locator(".toast").click();
        }
        expect(await visitor.csv()).toBe(before);
    });

    test("no request leaves the page, and none could", async () => {
        const leaving = visitor.asked.filter((url) => url !== builtPage && !url.startsWith("blob:") && !url.startsWith("data:"));
        expect(leaving).toEqual([]);
        const refused = await visitor.page.evaluate(() => fetch("https://example.org/").then(() => "let through", () => "refused"));
        expect(refused).toBe("refused");
        expect(visitor.problems.filter((problem) => !/example\.org|Content Security Policy/.test(problem))).toEqual([]);
    });

    test("works by keys alone, in the dark and at 1024 pixels", async () => {
        const dark = await browser.newContext({ viewport: { width: 1024, height: 700 }, acceptDownloads: true, colorScheme: "dark" });
        const other = await Visitor.arrive(dark);
        await other.page.screenshot({ path: join(PICTURES, "welcome-dark.png") });
        for (let step = 0; step < 12 && !(await other.page.evaluate(() => document.activeElement?.classList.contains("demo"))); step++) {
            await other.press("Tab");
        }
        await other.press("Enter");
        await other.opened("demo walk");
        await other.press("b");
        const start = { x: (size.width - size.height / 5) / 2, y: (size.height - size.height / 2.5) / 2, w: size.height / 5, h: size.height / 2.5 };
        const goal = truth(0);
        const times = (count: number, key: string): string[] => Array.from({ length: Math.round(Math.abs(count)) }, () => key);
        await other.press(...times(start.x - goal.x, "j"), ...times(start.w - goal.w, "Shift+J"));
        // Heights change at the upper edge.
        const top = start.y + start.h - goal.h;
        await other.press(...times(start.h - goal.h, start.h > goal.h ? "Shift+K" : "Shift+I"), ...times(goal.y - top, goal.y > top ? "k" : "i"));
        await other.press("t");
        await other.tracked();
        await other.press("n");
        await other.page.screenshot({ path: join(PICTURES, "doubt-dark-1024.png") });
        await other.press("x");
        await other.tracked();
        await other.press("?");
        await other.page.screenshot({ path: join(PICTURES, "keys-dark-1024.png") });
        await other.press("Escape", "Control+e");
        await other.page.screenshot({ path: join(PICTURES, "export-dark-1024.png") });
        const focused = (): Promise<string> => other.page.evaluate(() => document.activeElement?.textContent ?? "");
        for (let step = 0; step < 8 && !(await focused()).startsWith("CSV"); step++) {
            await other.press("Tab");
        }
        const [download] = await Promise.all([other.page.waitForEvent("download"), other.press("Enter")]);
        const boxes = boxesOf(readFileSync(await download.path(), "utf8"));
        expect(boxes.size).toBeGreaterThan(30);
        expect(overlap(boxes.get(0) as Rect, goal)).toBeGreaterThan(0.9);
        expect(other.problems).toEqual([]);
        await dark.close();
    });
});
