// A strip for each object: how sure its boxes are in every frame, and where somebody drew. The mouse scrubs on it.

import type { Thing } from "../model/document.ts";
import { ABSENT, DOUBTFUL, DRAWN, NOTHING, type Track } from "../model/track.ts";
import { h } from "./dom.ts";

export interface Strip {
    readonly thing: Thing;
    readonly track: Track;
}

export interface TimelineEvents {
    scrub(frame: number): void;
    selected(id: number): void;
}

const HIGH = 26;
const INSET = 8;

export class Timeline {
    readonly element: HTMLElement;
    private readonly rows = h("div", { class: "strips" });
    private readonly playhead = h("div", { class: "playhead" });
    private readonly lanes = new Map<number, { row: HTMLElement; label: HTMLElement; canvas: HTMLCanvasElement }>();
    private frames = 1;
    private frame = 0;
    private strips: readonly Strip[] = [];
    private selected: number | null = null;

    constructor(private readonly events: TimelineEvents) {
        this.element = h("div", { class: "timeline" }, this.rows, this.playhead);
        new ResizeObserver(() => this.draw()).observe(this.element);
        const scrub = (event: PointerEvent): void => {
            const lane = this.extent();
            const share = (event.clientX - lane.left - INSET) / Math.max(1, lane.width - 2 * INSET);
            this.events.scrub(Math.min(this.frames - 1, Math.max(0, Math.round(share * (this.frames - 1)))));
        };
        this.element.addEventListener("pointerdown", (event) => {
            if (event.button === 0 && event.clientX >= this.extent().left) {
                this.element.setPointerCapture(event.pointerId);
                scrub(event);
            }
        });
        this.element.addEventListener("pointermove", (event) => {
            if (this.element.hasPointerCapture(event.pointerId)) {
                scrub(event);
            }
        });
    }

    show(frames: number, strips: readonly Strip[], selected: number | null): void {
        this.frames = frames;
        this.strips = strips;
        this.selected = selected;
        const ids = new Set(strips.map((strip) => strip.thing.id));
        for (const [id, lane] of this.lanes) {
            if (!ids.has(id)) {
                lane.row.remove();
                this.lanes.delete(id);
            }
        }
        for (const { thing } of strips) {
            if (!this.lanes.has(thing.id)) {
                const label = h("button", { type: "button", class: "strip-label", tabindex: -1, onclick: () => this.events.selected(thing.id) });
                const canvas = h("canvas", { class: "strip-canvas" });
                const row = h("div", { class: "strip" }, label, canvas);
                this.lanes.set(thing.id, { row, label, canvas });
                this.rows.append(row);
            }
        }
        this.draw();
    }

    showFrame(frame: number): void {
        this.frame = frame;
        this.place();
    }

    private extent(): DOMRect {
        const [first] = this.lanes.values();
        const whole = this.element.getBoundingClientRect();
        if (first === undefined) {
            return whole;
        }
        const lane = first.canvas.getBoundingClientRect();
        return new DOMRect(lane.left, whole.top, lane.width, whole.height);
    }

    private place(): void {
        const lane = this.extent();
        const whole = this.element.getBoundingClientRect();
        const share = this.frames > 1 ? this.frame / (this.frames - 1) : 0;
        this.playhead.style.left = `${lane.left - whole.left + INSET + share * (lane.width - 2 * INSET)}px`;
    }

    private draw(): void {
        const style = getComputedStyle(this.element);
        const colour = (name: string): string => style.getPropertyValue(name);
        const colours: Colours = { sure: colour("--sure"), fair: colour("--fair"), doubt: colour("--doubt"), absent: colour("--absent"), empty: colour("--empty"), ink: colour("--ink") };
        for (const { thing, track } of this.strips) {
            const lane = this.lanes.get(thing.id);
            if (lane === undefined) {
                continue;
            }
            lane.label.textContent = thing.name;
            lane.label.title = thing.name;
            lane.label.style.setProperty("--thing", thing.colour);
            lane.row.classList.toggle("selected", thing.id === this.selected);
            drawStrip(lane.canvas, thing, track, colours);
        }
        this.place();
    }
}

interface Colours {
    readonly sure: string;
    readonly fair: string;
    readonly doubt: string;
    readonly absent: string;
    readonly empty: string;
    readonly ink: string;
}

/** Between doubtful and sure. */
const FAIR = 0.7;

/** A column shows the least sure of its frames: what is to be looked at must not be lost among others. */
function drawStrip(canvas: HTMLCanvasElement, thing: Thing, track: Track, colours: Colours): void {
    const context = canvas.getContext("2d");
    if (context === null) {
        return;
    }
    const ratio = devicePixelRatio;
    const wide = canvas.clientWidth;
    canvas.width = Math.round(wide * ratio);
    canvas.height = HIGH * ratio;
    context.scale(ratio, ratio);
    const usable = wide - 2 * INSET;
    const { frames } = track;
    context.fillStyle = colours.empty;
    context.beginPath();
    context.roundRect(INSET, 6, usable, HIGH - 12, 3);
    context.fill();
    const columns = Math.max(1, Math.floor(usable));
    for (let column = 0; column < columns; column++) {
        const first = Math.floor((column * frames) / columns);
        const last = Math.max(first + 1, Math.floor(((column + 1) * frames) / columns));
        let least = Infinity;
        let isAbsent = false;
        for (let frame = first; frame < last; frame++) {
            const state = track.state(frame);
            if (state === ABSENT) {
                isAbsent = true;
            } else if (state !== NOTHING) {
                least = Math.min(least, state === DRAWN ? 1 : track.confidence(frame));
            }
        }
        if (least === Infinity && !isAbsent) {
            continue;
        }
        const isBox = least !== Infinity;
        context.fillStyle = !isBox ? colours.absent : least < DOUBTFUL ? colours.doubt : least < FAIR ? colours.fair : colours.sure;
        const high = isBox ? HIGH - 12 : 3;
        context.fillRect(INSET + column, (HIGH - high) / 2, 1, high);
    }
    for (const [frame, mark] of thing.keys) {
        const x = INSET + (frames > 1 ? frame / (frames - 1) : 0) * usable;
        context.fillStyle = mark === "absent" ? colours.empty : thing.colour;
        context.strokeStyle = colours.ink;
        context.lineWidth = 1.5;
        context.beginPath();
        context.moveTo(x, 4);
        context.lineTo(x + 6, HIGH / 2);
        context.lineTo(x, HIGH - 4);
        context.lineTo(x - 6, HIGH / 2);
        context.closePath();
        context.fill();
        context.stroke();
    }
}
