// The engine through its calls, without a browser.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { beforeAll, expect, test } from "vitest";
import { Engine, type Leg } from "../src/engine/wasm.ts";
import { DRAWN, TRACKED, Track } from "../src/model/track.ts";
import { openDemo } from "../src/video/demo.ts";
import type { Source } from "../src/video/source.ts";

const code = new Uint8Array(readFileSync(join(import.meta.dirname, "../src/engine/infopart.wasm")));
let engine: Engine;
let source: Source;

/** Where the walker stands in the first frame. */
const START: [number, number, number, number] = [57, 114, 36, 115];
const walker = (keys: object[]): never => ({ id: 7, name: 'a "<b>"', class: "person", colour: "#ff5a5f", keys }) as never;

async function track(leg: Leg, count = leg.count): Promise<void> {
    const step = leg.direction === "forward" ? 1 : -1;
    engine.beginPass(leg, await (await source.sample(leg.from)).pixels());
    for (let distance = 1; distance <= count; distance++) {
        engine.see(await (await source.sample(leg.from + step * distance)).pixels());
    }
    engine.endPass();
}

beforeAll(async () => {
    engine = await Engine.start(code);
    source = openDemo(engine);
    engine.video(source.about);
});

test("a pass follows the walker, and a key frame in its way leaves only the stretches around it to be tracked", async () => {
    engine.objects([walker([{ frame: 1, box: START }])]);
    const [leg] = engine.missingLegs(7, 0, 1);
    expect(leg).toMatchObject({ from: 0, direction: "forward", count: source.about.frames - 1 });
    await track(leg as Leg, 30);
    const known = new Track(engine.rows(7));
    expect(known.state(0)).toBe(DRAWN);
    expect(known.state(30)).toBe(TRACKED);
    expect(known.state(31)).toBe(0);
    // The walker goes to the right.
    expect((known.box(30)?.x ?? 0) - START[0]).toBeGreaterThan(10);
    expect(known.confidence(10)).toBeGreaterThan(0.5);

    const { x, y, w, h } = known.box(20) ?? { x: 0, y: 0, w: 0, h: 0 };
    engine.objects([walker([{ frame: 1, box: START }, { frame: 21, box: [x, y, w, h] }])]);
    // The forward pass that is known serves the shorter stretch; what is missing is the way back and the way on.
    const legs = engine.missingLegs(7, 19, 21);
    expect(legs.map(({ from, direction, count }) => [from, direction, count])).toEqual([[20, "backward", 20], [20, "forward", source.about.frames - 21]]);
    await track(legs[0] as Leg);
    expect(engine.missingLegs(7, 19, 20)).toEqual([]);
    expect(new Track(engine.rows(7)).box(0)).toEqual({ x: START[0], y: START[1], w: START[2], h: START[3] });
});

test("exports are what is shown, and a project file brings objects and passes into another session", async () => {
    const rows = engine.rows(7);
    const [[, csv] = ["", ""]] = engine.export("csv");
    const lines = csv.trim().split("\n");
    const shown = new Track(rows);
    const boxes = Array.from({ length: shown.frames }, (_, frame) => shown.box(frame)).filter((box) => box !== null);
    expect(lines.length).toBe(1 + boxes.length);
    expect(lines[1]).toBe(`1,1,"a ""<b>""",person,${START.join(",")},1,1,0`);
    const project = engine.project();
    const other = await Engine.start(code);
    other.video(source.about);
    const opened = other.openFile("p.json", project);
    expect(opened.objects[0]?.name).toBe('a "<b>"');
    expect([...other.rows(1)]).toEqual([...rows]);
    // A table has no passes both ways, but every box is where it was.
    const third = await Engine.start(code);
    third.video(source.about);
    third.openFile("boxes.csv", csv);
    const again = new Track(third.rows(1));
    expect(Array.from({ length: again.frames }, (_, frame) => again.box(frame)).filter((box) => box !== null)).toEqual(boxes);
});

test("what cannot be is refused with a sentence", () => {
    expect(() => engine.openFile("cut.json", '{"version": 1, "objects": [')).toThrow("cut.json: is cut short");
    expect(() => engine.openFile("new.json", '{"version": 9, "objects": []}')).toThrow("is of version 9");
    expect(() => engine.openFile("a.csv", "hello")).toThrow("a.csv: is none of CSV");
    expect(() => engine.openFile("b.csv", "frame,x,y,w,h\n999,1,1,5,5\n")).toThrow("the video has 180 frames");
    engine.objects([walker([{ frame: 1, box: [9000, 1, 5, 5] }])]);
    expect(() => engine.missingLegs(7, 0, 1)).toThrow("has no pixel inside the 480x320 frame");
    expect(() => engine.objects([walker([{ frame: 0, box: START }])])).toThrow("frames count from 1");
    expect(() => engine.rows(99)).toThrow("no object 99");
});
