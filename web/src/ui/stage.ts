// The picture with its boxes, and the mouse on it: draw, move, pull an edge, zoom.

import type { Box, Thing } from "../model/document.ts";
import { DOUBTFUL, DRAWN } from "../model/track.ts";
import { h } from "./dom.ts";

/** A box as it is shown. */
export interface Shown {
    readonly thing: Thing;
    readonly box: Box;
    readonly confidence: number;
    readonly state: number;
}

export interface StageEvents {
    /** A box was drawn on the picture, or the selected one changed; `isNew` if it was drawn. */
    drawn(box: Box, isNew: boolean): void;
    selected(id: number): void;
}

/** What the mouse took hold of: which sides follow it. */
interface Grip {
    readonly left: boolean;
    readonly top: boolean;
    readonly right: boolean;
    readonly bottom: boolean;
}

const WHOLE: Grip = { left: true, top: true, right: true, bottom: true };

/** In screen pixels. */
const REACH = 8;
const SMALLEST_DRAWN = 4;
/** Letters of a name beside a box. */
const LONGEST_NAME = 28;
const MOST_ZOOM = 32;

export class Stage {
    readonly element: HTMLElement;
    private readonly canvas = h("canvas", { class: "stage-canvas", tabindex: 0, role: "img", "aria-label": "the picture" });
    private readonly context = this.canvas.getContext("2d", { alpha: false });
    private width = 1;
    private height = 1;
    private picture: ImageBitmap | null = null;
    private frame = 0;
    private shown: readonly Shown[] = [];
    private selectedId: number | null = null;
    private isDrawingNew = false;
    private zoom = 1;
    /** The point of the picture that is in the middle. */
    private centre = { x: 0.5, y: 0.5 };
    private held: { grip: Grip | null; from: Box; at: { x: number; y: number }; now: Box } | null = null;
    private panning: { x: number; y: number } | null = null;
    private isWaiting = false;

    constructor(private readonly events: StageEvents) {
        this.element = h("div", { class: "stage" }, this.canvas);
        new ResizeObserver(() => this.draw()).observe(this.element);
        this.canvas.addEventListener("pointerdown", (event) => this.press(event));
        this.canvas.addEventListener("pointermove", (event) => this.move(event));
        this.canvas.addEventListener("pointerup", () => this.release());
        this.canvas.addEventListener("pointercancel", () => this.letGo());
        this.canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
        this.canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    }

    /** A new video of this size. */
    open(width: number, height: number): void {
        this.width = width;
        this.height = height;
        this.picture = null;
        this.shown = [];
        this.fit();
    }

    /** The picture of a frame; it belongs to whoever gives it. The element says which frame is seen. */
    show(picture: ImageBitmap, frame: number): void {
        this.picture = picture;
        this.frame = frame;
        this.draw();
    }

    showBoxes(shown: readonly Shown[], selected: number | null, isDrawingNew: boolean): void {
        this.shown = shown;
        this.selectedId = selected;
        this.isDrawingNew = isDrawingNew;
        this.canvas.classList.toggle("draws", isDrawingNew);
        this.draw();
    }

    fit(): void {
        this.zoom = 1;
        this.centre = { x: 0.5, y: 0.5 };
        this.draw();
    }

    zoomBy(factor: number): void {
        this.zoom = Math.min(MOST_ZOOM, Math.max(1, this.zoom * factor));
        if (this.zoom === 1) {
            this.centre = { x: 0.5, y: 0.5 };
        }
        this.draw();
    }

    /** Lets go of what the mouse holds; says whether it held anything. */
    letGo(): boolean {
        const held = this.held !== null || this.panning !== null;
        this.held = null;
        this.panning = null;
        this.draw();
        return held;
    }

    /** Picture pixels a screen pixel, and where the picture's corner is. */
    private view(): { scale: number; left: number; top: number } {
        const { clientWidth, clientHeight } = this.element;
        const scale = Math.min(clientWidth / this.width, clientHeight / this.height) * this.zoom;
        return {
            scale,
            left: clientWidth / 2 - this.centre.x * this.width * scale,
            top: clientHeight / 2 - this.centre.y * this.height * scale,
        };
    }

    private inPicture(event: { offsetX: number; offsetY: number }): { x: number; y: number } {
        const { scale, left, top } = this.view();
        return { x: (event.offsetX - left) / scale, y: (event.offsetY - top) / scale };
    }

    private press(event: PointerEvent): void {
        this.canvas.focus({ preventScroll: true });
        if (event.button === 1 || event.button === 2) {
            this.panning = { x: event.offsetX, y: event.offsetY };
            this.canvas.setPointerCapture(event.pointerId);
            return;
        }
        if (this.picture === null || event.button !== 0) {
            return;
        }
        const at = this.inPicture(event);
        const found = event.shiftKey || this.isDrawingNew ? null : this.under(at);
        this.canvas.setPointerCapture(event.pointerId);
        if (found !== null && found.shown.thing.id !== this.selectedId) {
            this.events.selected(found.shown.thing.id);
        }
        const from = found?.shown.box ?? { x: at.x, y: at.y, w: 0, h: 0 };
        this.held = { grip: found?.grip ?? null, from, at, now: from };
    }

    private move(event: PointerEvent): void {
        const at = this.inPicture(event);
        if (this.panning !== null) {
            const { scale } = this.view();
            this.centre = {
                x: this.centre.x - (event.offsetX - this.panning.x) / scale / this.width,
                y: this.centre.y - (event.offsetY - this.panning.y) / scale / this.height,
            };
            this.panning = { x: event.offsetX, y: event.offsetY };
            this.draw();
        } else if (this.held !== null) {
            this.held.now = this.held.grip === null ? this.spanned(this.held.at, at) : pulled(this.held.from, this.held.grip, at.x - this.held.at.x, at.y - this.held.at.y);
            this.draw();
        } else {
            this.canvas.style.cursor = this.isDrawingNew ? "crosshair" : cursorOf(this.under(at)?.grip ?? null);
        }
    }

    /** From corner to corner, inside the picture. */
    private spanned(a: { x: number; y: number }, b: { x: number; y: number }): Box {
        const inside = (value: number, most: number): number => Math.min(most, Math.max(0, value));
        const [x0, x1] = [inside(Math.min(a.x, b.x), this.width), inside(Math.max(a.x, b.x), this.width)];
        const [y0, y1] = [inside(Math.min(a.y, b.y), this.height), inside(Math.max(a.y, b.y), this.height)];
        return { x: x0, y: y0, w: x1 - x0, h: y1 - y0 };
    }

    private release(): void {
        const held = this.held;
        this.held = null;
        this.panning = null;
        if (held !== null) {
            const { scale } = this.view();
            const isLarge = Math.min(held.now.w, held.now.h) * scale >= SMALLEST_DRAWN;
            if (held.grip === null ? isLarge : held.now !== held.from) {
                this.events.drawn(held.now, held.grip === null);
            }
        }
        this.draw();
    }

    private wheel(event: WheelEvent): void {
        event.preventDefault();
        const before = this.inPicture(event);
        this.zoom = Math.min(MOST_ZOOM, Math.max(1, this.zoom * Math.exp(-event.deltaY / 400)));
        const after = this.inPicture(event);
        this.centre =
            this.zoom === 1
                ? { x: 0.5, y: 0.5 }
                : { x: this.centre.x + (before.x - after.x) / this.width, y: this.centre.y + (before.y - after.y) / this.height };
        this.draw();
    }

    /** The box there, the selected one first, and what would be taken hold of. */
    private under(at: { x: number; y: number }): { shown: Shown; grip: Grip } | null {
        const reach = REACH / this.view().scale;
        const mine = this.shown.filter((shown) => shown.thing.id === this.selectedId);
        const others = this.shown.filter((shown) => shown.thing.id !== this.selectedId).reverse();
        for (const shown of [...mine, ...others]) {
            const grip = gripAt(shown.box, at, Math.min(reach, shown.box.w / 3, shown.box.h / 3), reach);
            if (grip !== null) {
                return { shown, grip: shown.thing.id === this.selectedId ? grip : WHOLE };
            }
        }
        return null;
    }

    private draw(): void {
        if (!this.isWaiting) {
            this.isWaiting = true;
            requestAnimationFrame(() => {
                this.isWaiting = false;
                this.drawNow();
            });
        }
    }

    private drawNow(): void {
        const { context, canvas } = this;
        if (context === null) {
            return;
        }
        const ratio = devicePixelRatio;
        const { clientWidth, clientHeight } = this.element;
        const [wide, high] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
        if (canvas.width !== wide || canvas.height !== high) {
            canvas.width = wide;
            canvas.height = high;
        }
        const { scale, left, top } = this.view();
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        context.fillStyle = getComputedStyle(this.element).getPropertyValue("--stage");
        context.fillRect(0, 0, clientWidth, clientHeight);
        if (this.picture !== null) {
            context.imageSmoothingEnabled = scale < 4;
            context.imageSmoothingQuality = "high";
            context.drawImage(this.picture, left, top, this.width * scale, this.height * scale);
            this.element.dataset["frame"] = String(this.frame);
        }
        const place = (box: Box): Box => ({ x: left + box.x * scale, y: top + box.y * scale, w: box.w * scale, h: box.h * scale });
        for (const shown of this.shown) {
            const isSelected = shown.thing.id === this.selectedId;
            const isHeld = isSelected && this.held !== null && this.held.grip !== null;
            if (isSelected && this.held !== null && this.held.grip === null && this.held.now.w > 0) {
                continue;
            }
            drawBox(context, { ...shown, box: place(isHeld && this.held !== null ? this.held.now : shown.box) }, isSelected);
        }
        if (this.held !== null && this.held.grip === null) {
            const box = place(this.held.now);
            context.setLineDash([6, 4]);
            outline(context, box, "#fff", 2);
            context.setLineDash([]);
        }
    }
}

function pulled(from: Box, grip: Grip, dx: number, dy: number): Box {
    if (dx === 0 && dy === 0) {
        return from;
    }
    const least = 2;
    let [x0, y0, x1, y1] = [from.x, from.y, from.x + from.w, from.y + from.h];
    if (grip.left) {
        x0 += dx;
    }
    if (grip.right) {
        x1 += dx;
    }
    if (grip.top) {
        y0 += dy;
    }
    if (grip.bottom) {
        y1 += dy;
    }
    if (x1 - x0 < least) {
        [x0, x1] = grip.left ? [x1 - least, x1] : [x0, x0 + least];
    }
    if (y1 - y0 < least) {
        [y0, y1] = grip.top ? [y1 - least, y1] : [y0, y0 + least];
    }
    return { x: x0, y: y0, w: x1 - x0, h: y1 - y0 };
}

/** Near an edge or corner that is pulled; inside the whole box moves. */
function gripAt(box: Box, at: { x: number; y: number }, within: number, beyond: number): Grip | null {
    const isInside = at.x >= box.x - beyond && at.x <= box.x + box.w + beyond && at.y >= box.y - beyond && at.y <= box.y + box.h + beyond;
    if (!isInside) {
        return null;
    }
    const grip = {
        left: at.x < box.x + within,
        top: at.y < box.y + within,
        right: at.x > box.x + box.w - within,
        bottom: at.y > box.y + box.h - within,
    };
    return grip.left || grip.top || grip.right || grip.bottom ? grip : WHOLE;
}

function cursorOf(grip: Grip | null): string {
    if (grip === null) {
        return "crosshair";
    }
    if (grip === WHOLE) {
        return "move";
    }
    if ((grip.left && grip.top) || (grip.right && grip.bottom)) {
        return "nwse-resize";
    }
    if ((grip.right && grip.top) || (grip.left && grip.bottom)) {
        return "nesw-resize";
    }
    return grip.left || grip.right ? "ew-resize" : "ns-resize";
}

function outline(context: CanvasRenderingContext2D, box: Box, colour: string, width: number): void {
    context.lineWidth = width + 2;
    context.strokeStyle = "rgb(0 0 0 / 55%)";
    context.strokeRect(box.x, box.y, box.w, box.h);
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.strokeRect(box.x, box.y, box.w, box.h);
}

function drawBox(context: CanvasRenderingContext2D, shown: Shown, isSelected: boolean): void {
    const { thing, box, state, confidence } = shown;
    const isDoubtful = state !== DRAWN && confidence < DOUBTFUL;
    context.setLineDash(isDoubtful ? [5, 4] : []);
    outline(context, box, thing.colour, isSelected ? 2.5 : 1.5);
    context.setLineDash([]);
    const name = thing.name.length > LONGEST_NAME ? `${thing.name.slice(0, LONGEST_NAME)}…` : thing.name;
    const words = `${name}${state === DRAWN ? " ◆" : isDoubtful ? " ?" : ""}`;
    context.font = "600 12px system-ui, sans-serif";
    const wide = context.measureText(words).width + 10;
    // A box that sticks out keeps its name in sight.
    const { clientWidth, clientHeight } = context.canvas;
    const x = Math.min(Math.max(box.x - 1, 2), clientWidth - wide - 2);
    const y = Math.min(Math.max(box.y >= 20 ? box.y - 20 : box.y + 1, 2), clientHeight - 20);
    context.fillStyle = thing.colour;
    context.globalAlpha = isSelected ? 1 : 0.8;
    context.beginPath();
    context.roundRect(x, y, wide, 18, 4);
    context.fill();
    context.globalAlpha = 1;
    context.fillStyle = isLight(thing.colour) ? "#111" : "#fff";
    context.fillText(words, x + 5, y + 13);
    if (isSelected) {
        for (const [x, y] of [[box.x, box.y], [box.x + box.w, box.y], [box.x, box.y + box.h], [box.x + box.w, box.y + box.h]] as const) {
            context.fillStyle = "#fff";
            context.strokeStyle = thing.colour;
            context.lineWidth = 2;
            context.beginPath();
            context.arc(x, y, 4, 0, 2 * Math.PI);
            context.fill();
            context.stroke();
        }
    }
}

function isLight(colour: string): boolean {
    const value = Number.parseInt(colour.slice(1), 16);
    return ((value >> 16) & 255) * 0.299 + ((value >> 8) & 255) * 0.587 + (value & 255) * 0.114 > 150;
}
