// Documents, undo, keys.

import { expect, test } from "vitest";
import { EMPTY, clipped, fromEntry, toEntry, withKey, withNewThing, withWords, withoutKey, withoutThing } from "../src/model/document.ts";
import { BEGINNING, amended, canRedo, canUndo, done, lastDeed, now, redone, undone } from "../src/model/history.ts";
import { COLUMNS, DRAWN, TRACKED, Track } from "../src/model/track.ts";
import { KEYMAP, actionOf } from "../src/ui/keymap.ts";

const BOX = { x: 1, y: 2, w: 3, h: 4 };

test("an edit gives a new document and leaves the old one as it was", () => {
    const one = withKey(withNewThing(EMPTY, "person"), 1, 5, BOX);
    const two = withKey(withWords(one, 1, { name: "Ada" }), 1, 9, "absent");
    expect(one.things[0]?.keys.size).toBe(1);
    expect(two.things[0]).toMatchObject({ name: "Ada", class: "person" });
    expect(withoutKey(two, 1, 5).things[0]?.keys.has(5)).toBe(false);
    // An id is not given again.
    expect(withNewThing(withoutThing(two, 1), "cat").things[0]?.id).toBe(2);
});

test("an object comes back from the form that files have", () => {
    const thing = withKey(withKey(withNewThing(EMPTY, "person"), 1, 5, BOX), 1, 2, "absent").things[0];
    expect(thing).toBeDefined();
    if (thing !== undefined) {
        expect(toEntry(thing).keys).toEqual([{ frame: 3, absent: true }, { frame: 6, box: [1, 2, 3, 4] }]);
        expect(fromEntry(toEntry(thing))).toEqual(thing);
    }
});

test("undo and redo go along the steps, and a new step forgets what was undone", () => {
    let history = done(done(BEGINNING, "a", withNewThing(EMPTY, "x")), "b", EMPTY);
    expect(lastDeed(history)).toBe("b");
    history = undone(history);
    expect(now(history).things.length).toBe(1);
    expect(canRedo(history)).toBe(true);
    expect(now(redone(history)).things.length).toBe(0);
    history = done(history, "c", withNewThing(now(history), "y"));
    expect(canRedo(history)).toBe(false);
    expect(now(history).things.length).toBe(2);
    expect(canUndo(undone(undone(undone(history))))).toBe(false);
    // What a held key does is one step.
    const held = amended(amended(done(BEGINNING, "moving", EMPTY), withNewThing(EMPTY, "x")), EMPTY);
    expect(now(undone(held))).toBe(EMPTY);
    expect(held.steps.length).toBe(2);
    for (let step = 0; step < 300; step++) {
        history = done(history, `${step}`, EMPTY);
    }
    expect(history.steps.length).toBe(200);
});

test("what a pass sees never covers what was drawn", () => {
    const track = Track.empty(3);
    track.rows.set([1, 1, 1, 1, 1, DRAWN], COLUMNS);
    track.put(1, [9, 9, 9, 9, 0.5]);
    track.put(2, [9, 9, 9, 9, 0.5]);
    expect([track.state(0), track.state(1), track.state(2)]).toEqual([0, DRAWN, TRACKED]);
    expect(track.box(1)).toEqual({ x: 1, y: 1, w: 1, h: 1 });
    expect(track.box(0)).toBeNull();
});

test("boxes are cut to the picture", () => {
    expect(clipped({ x: -5, y: 90, w: 20, h: 20 }, 100, 100)).toEqual({ x: 0, y: 90, w: 15, h: 10 });
    expect(clipped({ x: 100, y: 0, w: 5, h: 5 }, 100, 100)).toBeNull();
});

test("no key means two things, and letters with and without Shift are told apart", () => {
    const keys = KEYMAP.flatMap((group) => group.bindings).flatMap((binding) => binding.keys);
    expect(new Set(keys).size).toBe(keys.length);
    const press = (key: string, held: object = {}) => actionOf({ key, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...held });
    expect(press("t")).toBe("track");
    expect(press("T", { shiftKey: true })).toBe("trackBack");
    expect(press("?", { shiftKey: true })).toBe("help");
    expect(press("z", { ctrlKey: true })).toBe("undo");
    expect(press("Z", { metaKey: true, shiftKey: true })).toBe("redo");
    expect(press("ArrowRight", { shiftKey: true })).toBe("forth10");
    expect(press(" ")).toBe("play");
    expect(press("t", { altKey: true })).toBeUndefined();
    expect(press("e")).toBeUndefined();
});
