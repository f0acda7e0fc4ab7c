// An open video on the screen: everything that shows the workshop, and everything that is pressed.

import type { Box } from "../model/document.ts";
import { DRAWN, TRACKED } from "../model/track.ts";
import { download, stem, zipped } from "../files/download.ts";
import { pick } from "../files/given.ts";
import type { Source } from "../video/source.ts";
import type { Workshop } from "../workshop.ts";
import { Coach } from "./coach.ts";
import { askFrame, chooseFormat, showHelp } from "./dialogs.ts";
import { h, icon, iconButton, ICONS } from "./dom.ts";
import { actionOf, keyOf, type Action } from "./keymap.ts";
import { Panel } from "./panel.ts";
import { Player } from "./player.ts";
import { Stage, type Shown } from "./stage.ts";
import { toggleTheme } from "./theme.ts";
import { Timeline } from "./timeline.ts";
import { say } from "./toast.ts";
import { Viewer } from "./viewer.ts";

/** Key strokes in a row after which a box moves faster, and by how much. */
const REPEATS = 8;
const FASTER = 5;

export class Workbench {
    readonly element: HTMLElement;
    private readonly stage: Stage;
    private readonly timeline: Timeline;
    private readonly panel: Panel;
    private readonly coach = new Coach();
    private readonly viewer: Viewer;
    private readonly player: Player;
    private readonly where = h("output", { class: "where" });
    private readonly progress = h("output", { class: "progress" });
    private readonly undoButton = this.button("undo", "Undo", "undo");
    private readonly redoButton = this.button("redo", "Redo", "redo");
    private readonly playButton = this.button("play", "Play", "play");
    private isWaiting = false;
    private repeats = 0;
    private isPlayShown = false;

    constructor(
        private readonly workshop: Workshop,
        source: Source,
        private readonly leave: () => void,
    ) {
        const { about } = workshop;
        this.stage = new Stage({
            drawn: (box, isNew) => this.drawn(box, isNew),
            selected: (id) => workshop.select(id),
        });
        this.timeline = new Timeline({ scrub: (frame) => this.go(frame), selected: (id) => workshop.select(id) });
        this.panel = new Panel({
            select: (id) => workshop.select(id),
            describe: (id, words) => workshop.describe(id, words),
            removeThing: () => this.act("removeThing"),
            newThing: () => this.act("newThing"),
            goToPlace: (place) => {
                this.player.stop();
                workshop.goToPlace(place);
            },
        });
        this.viewer = new Viewer(source, this.stage, (error) => this.fail(error));
        this.player = new Player(
            about,
            (frame) => workshop.go(frame),
            () => this.changed(),
        );
        const home = h("button", { type: "button", class: "brand", title: `Another video (${keyOf("open")})`, onclick: () => this.act("open") }, icon(ICONS.film), h("span", {}, about.name));
        const size = h("span", { class: "size" }, `${about.width} × ${about.height}, ${about.frames} frames`);
        this.element = h(
            "div",
            { class: "workbench" },
            h(
                "header",
                { class: "top" },
                home,
                size,
                h("span", { class: "spring" }),
                this.undoButton,
                this.redoButton,
                h("span", { class: "gap" }),
                this.button("import", "Import", "import"),
                this.button("save", "Save project", "save"),
                h("button", { type: "button", class: "primary", title: `Export (${keyOf("export")})`, onclick: () => this.act("export") }, icon(ICONS.export), "Export"),
                h("span", { class: "gap" }),
                this.button("theme", "Light or dark", "theme"),
                this.button("help", "Keys", "help"),
            ),
            h("main", {}, this.stage.element, this.coach.element),
            this.panel.element,
            h(
                "footer",
                {},
                h(
                    "div",
                    { class: "transport" },
                    this.button("toStart", "Key frame before", "previousKey"),
                    this.button("back", "One frame back", "back"),
                    this.playButton,
                    this.button("forth", "One frame on", "forth"),
                    this.button("toEnd", "Next key frame", "nextKey"),
                    this.where,
                    h("span", { class: "gap" }),
                    this.button("trackBackward", "Track backward", "trackBack"),
                    this.button("trackForward", "Track forward", "track"),
                    this.button("look", "Next doubtful place", "nextDoubt"),
                    this.button("key", "This box is right", "key"),
                    this.button("absent", "Absent from here on", "absent"),
                    h("span", { class: "spring" }),
                    this.progress,
                    h("span", { class: "legend" }, h("i", { class: "sure" }), "sure", h("i", { class: "fair" }), "fair", h("i", { class: "doubt" }), "doubtful", h("i", { class: "drawn" }), "drawn"),
                ),
                this.timeline.element,
            ),
        );
        this.stage.open(about.width, about.height);
    }

    /** Once the element is in the page. */
    start(): void {
        this.moved(null);
        this.changed();
    }

    close(): void {
        this.player.stop();
        this.viewer.close();
        this.workshop.close();
    }

    /** Something is to be drawn again; done once a picture of the screen. */
    changed(): void {
        if (!this.isWaiting) {
            this.isWaiting = true;
            requestAnimationFrame(() => {
                this.isWaiting = false;
                this.show();
            });
        }
    }

    moved(picture: ImageBitmap | null): void {
        if (picture !== null) {
            this.viewer.showThis(picture, this.workshop.frame);
        } else {
            this.viewer.show(this.workshop.frame);
        }
        this.changed();
    }

    fail(error: unknown): void {
        say(error instanceof Error ? error.message : String(error), true);
    }

    press(event: KeyboardEvent): void {
        if (event.target instanceof HTMLInputElement || event.target instanceof HTMLTextAreaElement) {
            return;
        }
        const digit = /^[1-9]$/.exec(event.key);
        if (digit !== null && !event.ctrlKey && !event.metaKey && !event.altKey) {
            const thing = this.workshop.document.things[Number(digit[0]) - 1];
            if (thing !== undefined) {
                this.workshop.select(thing.id);
            }
            return;
        }
        const action = actionOf(event);
        // Enter and the space bar press a button that the keyboard is on.
        const isForButton = event.target instanceof HTMLButtonElement && (event.key === "Enter" || event.key === " ");
        if (action !== undefined && !isForButton) {
            event.preventDefault();
            this.repeats = event.repeat ? this.repeats + 1 : 0;
            this.act(action);
        }
    }

    /** Objects of a file instead of those here. */
    async take(file: File): Promise<void> {
        try {
            await this.workshop.takeFile(file.name, await file.text());
            say(`${file.name}: ${this.workshop.document.things.length} objects. Undo takes it back.`);
        } catch (error) {
            this.fail(error);
        }
    }

    private button(name: keyof typeof ICONS, label: string, action: Action): HTMLButtonElement {
        return iconButton(name, label, keyOf(action), () => this.act(action));
    }

    private go(frame: number): void {
        this.player.stop();
        this.workshop.go(frame);
    }

    private drawn(box: Box, isNew: boolean): void {
        if (isNew) {
            this.workshop.draw(box);
        } else {
            this.workshop.mark(box, "moving a box");
        }
    }

    private act(action: Action): void {
        const { workshop } = this;
        const step = this.repeats > REPEATS ? FASTER : 1;
        const change = (dx: number, dy: number, dw: number, dh: number): void => this.nudge(dx * step, dy * step, dw * step, dh * step);
        const acts: Record<Action, () => unknown> = {
            play: () => this.player.toggle(workshop.frame),
            forth: () => this.go(workshop.frame + 1),
            back: () => this.go(workshop.frame - 1),
            forth10: () => this.go(workshop.frame + 10),
            back10: () => this.go(workshop.frame - 10),
            first: () => this.go(0),
            last: () => this.go(workshop.about.frames - 1),
            goto: () => askFrame(workshop.frame, workshop.about.frames).then((frame) => frame !== null && this.go(frame)),
            nextKey: () => this.halt(() => workshop.goToKey(1)),
            previousKey: () => this.halt(() => workshop.goToKey(-1)),
            nextDoubt: () => this.halt(() => workshop.goToDoubt(1)),
            previousDoubt: () => this.halt(() => workshop.goToDoubt(-1)),
            newThing: () => this.halt(() => workshop.beginNew()),
            placeBox: () => this.halt(() => this.placeBox()),
            key: () => workshop.confirm(),
            absent: () => workshop.mark("absent", "marking an absence"),
            removeKey: () => workshop.removeKey(),
            removeThing: () => workshop.removeThing(),
            rename: () => this.panel.rename(),
            nextThing: () => workshop.selectNext(),
            left: () => change(-1, 0, 0, 0),
            right: () => change(1, 0, 0, 0),
            up: () => change(0, -1, 0, 0),
            down: () => change(0, 1, 0, 0),
            wider: () => change(0, 0, 1, 0),
            narrower: () => change(0, 0, -1, 0),
            taller: () => change(0, -1, 0, 1),
            shorter: () => change(0, 1, 0, -1),
            track: () => this.halt(() => workshop.trackForward()),
            trackBack: () => this.halt(() => workshop.trackBackward()),
            trackAll: () => this.halt(() => workshop.trackAll()),
            stop: () => this.stop(),
            undo: () => workshop.undo(),
            redo: () => workshop.redo(),
            save: () => this.saveProject(),
            open: () => this.leave(),
            export: () => this.export(),
            import: () => this.import(),
            zoomIn: () => this.stage.zoomBy(1.25),
            zoomOut: () => this.stage.zoomBy(0.8),
            zoomFit: () => this.stage.fit(),
            theme: () => {
                toggleTheme();
                this.changed();
                this.stage.zoomBy(1);
            },
            help: () => showHelp(),
        };
        void Promise.resolve(acts[action]()).catch((error: unknown) => this.fail(error));
    }

    private halt<T>(then: () => T): T {
        this.player.stop();
        return then();
    }

    private stop(): void {
        const held = this.stage.letGo();
        this.player.stop();
        if (this.workshop.leftToDo !== null) {
            this.workshop.stop();
        } else if (!held) {
            this.workshop.select(this.workshop.isDrawingNew ? this.workshop.selected : null);
        }
    }

    /** Moves or changes the selected box by pixels. */
    private nudge(dx: number, dy: number, dw: number, dh: number): void {
        this.workshop.nudge((box) => ({ x: box.x + dx, y: box.y + dy, w: Math.max(2, box.w + dw), h: Math.max(2, box.h + dh) }));
    }

    private placeBox(): void {
        const { about } = this.workshop;
        const side = Math.min(about.width, about.height);
        const [w, h] = [side / 5, side / 2.5];
        this.workshop.draw({ x: (about.width - w) / 2, y: (about.height - h) / 2, w, h });
    }

    private show(): void {
        const { workshop } = this;
        const { frame, selected, about, places } = workshop;
        const { things } = workshop.document;
        const shown = things.flatMap((thing): Shown[] => {
            const track = workshop.track(thing.id);
            const box = workshop.boxOf(thing, frame);
            return box === null ? [] : [{ thing, box, confidence: track.confidence(frame), state: thing.keys.has(frame) ? DRAWN : TRACKED }];
        });
        this.stage.showBoxes(shown, selected, workshop.isDrawingNew || things.length === 0);
        this.timeline.show(about.frames, things.map((thing) => ({ thing, track: workshop.track(thing.id) })), selected);
        this.timeline.showFrame(frame);
        this.panel.show(things, selected, places, frame);
        this.coach.show(workshop);
        const time = about.times?.[frame];
        this.where.textContent = `${frame + 1} / ${about.frames}${time === undefined ? "" : `  ${clock(time)}`}`;
        this.progress.textContent = workshop.leftToDo !== null ? `${workshop.leftToDo} frames to go` : speedOf(workshop);
        this.element.setAttribute("aria-busy", String(workshop.isBusy));
        this.undoButton.disabled = !workshop.canUndo;
        this.redoButton.disabled = !workshop.canRedo;
        this.undoButton.title = workshop.canUndo ? `Undo ${workshop.lastDeed} (${keyOf("undo")})` : "Nothing to undo";
        if (this.isPlayShown !== this.player.isPlaying) {
            this.isPlayShown = this.player.isPlaying;
            this.playButton.replaceChildren(icon(this.isPlayShown ? ICONS.pause : ICONS.play));
        }
    }

    private async saveProject(): Promise<void> {
        download(`${stem(this.workshop.about.name)}.infopart.json`, await this.workshop.project(), "application/json");
    }

    private async export(): Promise<void> {
        const { workshop } = this;
        const { things } = workshop.document;
        if (things.length === 0) {
            say("There is nothing to export yet: draw a box first.");
            return;
        }
        const format = await chooseFormat(things.length);
        if (format === null) {
            return;
        }
        const files = await workshop.exported(format.name);
        const name = `${stem(workshop.about.name)}.${format.name === "coco" ? "coco." : ""}${format.extension}`;
        if (format.extension === "zip") {
            download(name, zipped(files), "application/zip");
        } else {
            download(name, files[0]?.[1] ?? "", "text/plain");
        }
    }

    private async import(): Promise<void> {
        const [file] = await pick(".json,.jsonl,.csv,.xml,.txt", false);
        if (file !== undefined) {
            await this.take(file);
        }
    }
}

function clock(seconds: number): string {
    const minutes = Math.floor(seconds / 60);
    return `${minutes}:${(seconds - 60 * minutes).toFixed(2).padStart(5, "0")}`;
}

function speedOf({ lastRun }: Workshop): string {
    return lastRun === null ? "" : `${lastRun.frames} frames in ${(lastRun.milliseconds / 1000).toFixed(1)} s`;
}

