// What somebody says of a video: objects with key frames. Documents are values: an edit gives a new one and shares what did not change.

/** A box in pixels of the frame, the first pixel being 0. */
export interface Box {
    readonly x: number;
    readonly y: number;
    readonly w: number;
    readonly h: number;
}

/** What a key frame says: the object is here, or it is absent from here on. */
export type Mark = Box | "absent";

export interface Thing {
    readonly id: number;
    readonly name: string;
    readonly class: string;
    /** `#rrggbb` */
    readonly colour: string;
    /** By frame, counted from 0. */
    readonly keys: ReadonlyMap<number, Mark>;
}

export interface Document {
    readonly things: readonly Thing[];
    /** Ids are never used twice: what was tracked is known by them. */
    readonly nextId: number;
}

export const EMPTY: Document = { things: [], nextId: 1 };

/** Colours that are easy to tell apart, also on skin, grass and asphalt. */
const COLOURS = ["#ff5a5f", "#22c55e", "#3b82f6", "#f59e0b", "#a855f7", "#06b6d4", "#ec4899", "#eab308"] as const;

export function colourOf(id: number): string {
    return COLOURS[(id - 1) % COLOURS.length] ?? COLOURS[0];
}

export function thingOf(document: Document, id: number | null): Thing | undefined {
    return document.things.find((thing) => thing.id === id);
}

/** A new object that is nowhere yet. */
export function withNewThing(document: Document, className: string): Document {
    const id = document.nextId;
    const thing: Thing = { id, name: `${className} ${id}`, class: className, colour: colourOf(id), keys: new Map() };
    return { things: [...document.things, thing], nextId: id + 1 };
}

export function withoutThing(document: Document, id: number): Document {
    return { ...document, things: document.things.filter((thing) => thing.id !== id) };
}

function withThing(document: Document, id: number, change: (thing: Thing) => Thing): Document {
    return { ...document, things: document.things.map((thing) => (thing.id === id ? change(thing) : thing)) };
}

export function withWords(document: Document, id: number, words: Partial<Pick<Thing, "name" | "class" | "colour">>): Document {
    return withThing(document, id, (thing) => ({ ...thing, ...words }));
}

export function withKey(document: Document, id: number, frame: number, mark: Mark): Document {
    return withThing(document, id, (thing) => ({ ...thing, keys: new Map(thing.keys).set(frame, mark) }));
}

export function withoutKey(document: Document, id: number, frame: number): Document {
    return withThing(document, id, (thing) => {
        const keys = new Map(thing.keys);
        keys.delete(frame);
        return { ...thing, keys };
    });
}

export function hasBox(thing: Thing): boolean {
    return [...thing.keys.values()].some((mark) => mark !== "absent");
}

/** The key frames in order. */
export function keyFrames(thing: Thing): number[] {
    return [...thing.keys.keys()].sort((a, b) => a - b);
}

/** The box cut to the picture; null if nothing of it is inside. */
export function clipped(box: Box, width: number, height: number): Box | null {
    const x = Math.max(0, box.x);
    const y = Math.max(0, box.y);
    const w = Math.min(width, box.x + box.w) - x;
    const h = Math.min(height, box.y + box.h) - y;
    return w > 0 && h > 0 ? { x, y, w, h } : null;
}

/** As the engine and project files have it: frames count from 1. */
export interface ThingEntry {
    readonly id: number;
    readonly name: string;
    readonly class: string;
    readonly colour: string;
    readonly keys: readonly ({ frame: number; box: [number, number, number, number] } | { frame: number; absent: true })[];
}

export function toEntry(thing: Thing): ThingEntry {
    const keys = keyFrames(thing).map((frame) => {
        const mark = thing.keys.get(frame);
        if (mark === undefined || mark === "absent") {
            return { frame: frame + 1, absent: true as const };
        }
        return { frame: frame + 1, box: [mark.x, mark.y, mark.w, mark.h] as [number, number, number, number] };
    });
    return { id: thing.id, name: thing.name, class: thing.class, colour: thing.colour, keys };
}

export function fromEntry(entry: ThingEntry): Thing {
    const keys = new Map<number, Mark>();
    for (const key of entry.keys) {
        if ("box" in key) {
            const [x, y, w, h] = key.box;
            keys.set(key.frame - 1, { x, y, w, h });
        } else {
            keys.set(key.frame - 1, "absent");
        }
    }
    return { id: entry.id, name: entry.name, class: entry.class, colour: entry.colour, keys };
}
