// One open video: its document, what was tracked, where the user is; and everything that can be done to it. Knows no element.

import { EngineClient, type Notice } from "./engine/client.ts";
import type { Pass, Place, Opened } from "./engine/wasm.ts";
import type { Tracked } from "./engine/protocol.ts";
import {
    fromEntry, hasBox, keyFrames, thingOf, toEntry, withKey, withNewThing, withWords, withoutKey, withoutThing,
    type Box, type Document, type Mark, type Thing,
} from "./model/document.ts";
import { BEGINNING, amended, canRedo, canUndo, done, lastDeed, now, redone, undone, type History } from "./model/history.ts";
import { ABSENT, DRAWN, TRACKED, Track } from "./model/track.ts";
import type { Library, Work } from "./store/library.ts";
import type { About, SourceSpec } from "./video/source.ts";

export interface WorkshopEvents {
    /** Something is to be drawn again. */
    changed(): void;
    /** Another frame is to be shown; its picture is there if the tracker has just been in it. */
    moved(picture: ImageBitmap | null): void;
    told(words: string): void;
    failed(error: unknown): void;
}

export class Workshop {
    frame = 0;
    selected: number | null = null;
    isDrawingNew = false;
    places: readonly Place[] = [];
    /** Frames that are still to be tracked; null if nothing is. */
    leftToDo: number | null = null;
    lastRun: Tracked | null = null;
    private history: History = BEGINNING;
    private readonly tracks = new Map<number, Track>();
    private readonly engine: EngineClient;
    private runs = 0;
    private isTelling = false;
    /** Whose tracks the engine has to be asked for, once it has the document. */
    private readonly toRefresh = new Set<number>();
    private lastNudge: { id: number; frame: number } | null = null;
    /** Whether the picture goes where the tracker is; until the user goes elsewhere. */
    private isFollowing = false;
    private placeNow: Place | null = null;
    /** What the engine has; others see it only once they asked. */
    private saving: Promise<void> = Promise.resolve();

    private constructor(
        readonly spec: SourceSpec,
        private readonly library: Library | null,
        private readonly events: WorkshopEvents,
    ) {
        this.engine = new EngineClient((notice) => this.hear(notice));
    }

    about!: About;

    static async open(code: Uint8Array<ArrayBuffer>, spec: SourceSpec, library: Library | null, events: WorkshopEvents): Promise<Workshop> {
        const workshop = new Workshop(spec, library, events);
        try {
            workshop.about = await workshop.engine.ask("open", code, spec);
            await workshop.restore();
            return workshop;
        } catch (error) {
            workshop.close();
            throw error;
        }
    }

    close(): void {
        this.engine.close();
    }

    get document(): Document {
        return now(this.history);
    }

    get thing(): Thing | undefined {
        return thingOf(this.document, this.selected);
    }

    get canUndo(): boolean {
        return canUndo(this.history);
    }

    get canRedo(): boolean {
        return canRedo(this.history);
    }

    get lastDeed(): string {
        return lastDeed(this.history);
    }

    /** Whether something is being worked out. */
    get isBusy(): boolean {
        return this.runs > 0 || this.isTelling;
    }

    /** Where an object is in a frame: as it was drawn there, else as it was tracked. */
    boxOf(thing: Thing, frame: number): Box | null {
        const mark = thing.keys.get(frame);
        if (mark !== undefined) {
            return mark === "absent" ? null : mark;
        }
        const track = this.track(thing.id);
        return track.state(frame) === TRACKED ? track.box(frame) : null;
    }

    track(id: number): Track {
        return this.tracks.get(id) ?? Track.empty(this.about.frames);
    }

    // Going about.

    go(frame: number): void {
        const to = Math.min(this.about.frames - 1, Math.max(0, Math.round(frame)));
        if (to !== this.frame) {
            this.frame = to;
            this.isFollowing = false;
            this.events.moved(null);
            this.saveSoon();
        }
    }

    goToKey(direction: 1 | -1): void {
        const things = this.thing === undefined ? this.document.things : [this.thing];
        const frames = things.flatMap(keyFrames).filter((frame) => (frame - this.frame) * direction > 0);
        if (frames.length > 0) {
            this.go(direction > 0 ? Math.min(...frames) : Math.max(...frames));
        }
    }

    /** From one doubtful place to the next, the most doubtful first; the object there becomes the selected one. */
    goToDoubt(direction: 1 | -1): void {
        const { places } = this;
        const at = places.findIndex((place) => place.object === this.placeNow?.object && place.frame === this.placeNow.frame);
        const next = at < 0 ? places[direction > 0 ? 0 : places.length - 1] : places[(at + direction + places.length) % places.length];
        if (next === undefined) {
            this.events.told(this.document.things.some(hasBox) ? "Nothing is doubtful." : "Nothing was tracked yet.");
            return;
        }
        this.goToPlace(next);
    }

    goToPlace(place: Place): void {
        this.placeNow = place;
        this.select(place.object);
        this.go(place.frame);
    }

    select(id: number | null): void {
        this.selected = id;
        this.isDrawingNew = false;
        this.events.changed();
        this.saveSoon();
    }

    selectNext(): void {
        const { things } = this.document;
        const at = things.findIndex((thing) => thing.id === this.selected);
        this.select(things[(at + 1) % Math.max(1, things.length)]?.id ?? null);
    }

    beginNew(): void {
        this.isDrawingNew = true;
        this.events.changed();
    }

    // Deeds: each is one step of undo.

    /** A box that was drawn: of a new object, or a correction of the selected one. Says whether there is a new object. */
    draw(box: Box): boolean {
        const isNew = this.isDrawingNew || this.thing === undefined;
        if (isNew) {
            const className = this.thing?.class ?? this.document.things.at(-1)?.class ?? "person";
            const document = withNewThing(this.document, className);
            this.selected = this.document.nextId;
            this.isDrawingNew = false;
            this.commit("drawing a new object", withKey(document, this.selected, this.frame, box));
        } else {
            this.mark(box, "drawing a box");
        }
        return isNew;
    }

    /** A key frame of the selected object here; the stretches that it touches are tracked again if they were before. */
    mark(mark: Mark, deed: string): void {
        const { thing } = this;
        if (thing !== undefined) {
            this.commit(deed, withKey(this.document, thing.id, this.frame, mark), { id: thing.id, frame: this.frame });
        }
    }

    /** Changes the selected object's box here; what a held key does is one step of undo. */
    nudge(change: (box: Box) => Box): void {
        const { thing } = this;
        const box = thing && this.boxOf(thing, this.frame);
        if (thing && box) {
            const deed = "moving a box by keys";
            const document = withKey(this.document, thing.id, this.frame, change(box));
            const changed = { id: thing.id, frame: this.frame };
            const isSameStep = this.lastDeed === deed && this.lastNudge?.id === changed.id && this.lastNudge.frame === changed.frame;
            this.commit(deed, document, changed, isSameStep);
            this.lastNudge = changed;
        }
    }

    confirm(): void {
        const box = this.thing && this.boxOf(this.thing, this.frame);
        if (box) {
            this.mark(box, "confirming a box");
        } else {
            this.events.told("There is no box of the selected object in this frame: drag one.");
        }
    }

    removeKey(): void {
        const { thing } = this;
        if (thing?.keys.has(this.frame)) {
            this.commit("removing a key frame", withoutKey(this.document, thing.id, this.frame), { id: thing.id, frame: this.frame });
        } else {
            this.events.told("This is no key frame of the selected object: there is nothing to remove.");
        }
    }

    removeThing(): void {
        const { thing } = this;
        if (thing !== undefined) {
            this.commit(`removing ${thing.name}`, withoutThing(this.document, thing.id));
            this.select(this.document.things[0]?.id ?? null);
        }
    }

    describe(id: number, words: Partial<Pick<Thing, "name" | "class" | "colour">>): void {
        this.commit("renaming", withWords(this.document, id, words));
    }

    undo(): void {
        this.travel(undone(this.history));
    }

    redo(): void {
        this.travel(redone(this.history));
    }

    // Tracking.

    trackForward(): Promise<void> {
        return this.trackStretch(this.frame, this.frame + 1, "There is no key frame with a box at or before this frame: go to one, then press T.");
    }

    trackBackward(): Promise<void> {
        return this.trackStretch(this.frame - 1, this.frame, "There is no key frame with a box at or after this frame: go to one, then press Shift+T.");
    }

    async trackAll(): Promise<void> {
        for (const thing of this.document.things.filter(hasBox)) {
            await this.run(thing.id, 0, this.about.frames, true);
        }
    }

    stop(): void {
        void this.engine.ask("stop");
    }

    private async trackStretch(before: number, after: number, otherwise: string): Promise<void> {
        const { thing } = this;
        if (thing === undefined || !hasBox(thing)) {
            this.events.told("Draw a box around an object first: drag on the picture.");
            return;
        }
        const tracked = await this.run(thing.id, Math.max(0, before), after, true);
        if (tracked?.frames === 0 && !tracked.wasStopped) {
            const isKnown = this.track(thing.id).state(Math.min(this.about.frames - 1, Math.max(0, after === this.frame ? before : after)));
            this.events.told(isKnown === TRACKED || isKnown === DRAWN ? "That is tracked already." : otherwise);
        }
    }

    private async run(id: number, before: number, after: number, isFollowed: boolean): Promise<Tracked | null> {
        this.runs++;
        this.events.changed();
        this.isFollowing = isFollowed;
        try {
            const tracked = await this.engine.ask("track", id, before, after, isFollowed);
            if (tracked.frames > 0) {
                this.lastRun = tracked;
            }
            return tracked;
        } catch (error) {
            this.events.failed(error);
            return null;
        } finally {
            this.runs--;
            if (this.runs === 0) {
                this.leftToDo = null;
            }
            await this.refresh([id]).catch((error: unknown) => this.events.failed(error));
        }
    }

    private hear(notice: Notice): void {
        if (notice.is === "pass") {
            if (this.library !== null && notice.pass.sightings.length > 0) {
                this.library.savePass(this.about.fingerprint, notice.pass).catch((error: unknown) => this.events.failed(error));
            }
            return;
        }
        const track = this.track(notice.object);
        this.tracks.set(notice.object, track);
        notice.rows.forEach(([frame, ...seen]) => track.put(frame, seen));
        this.leftToDo = notice.leftToDo;
        const last = notice.rows.at(-1);
        if (this.isFollowing && last !== undefined) {
            this.frame = last[0];
            this.events.moved(notice.picture);
            this.saveSoon();
        } else {
            notice.picture?.close();
        }
        this.events.changed();
    }

    // The engine and the storage follow the document.

    private commit(deed: string, document: Document, changed?: { id: number; frame: number }, isSameStep = false): void {
        const again = changed === undefined ? null : this.trackedAround(changed.id, changed.frame);
        this.history = isSameStep ? amended(this.history, document) : done(this.history, deed, document);
        this.saveSoon();
        this.events.changed();
        void this.tellEngine(changed === undefined ? undefined : [changed.id]);
        if (changed !== undefined && again !== null) {
            void this.run(changed.id, again.before, again.after, false);
        }
    }

    /** Which of the stretches that meet in a frame were tracked. */
    private trackedAround(id: number, frame: number): { before: number; after: number } | null {
        const track = this.track(id);
        const was = (at: number): boolean => track.state(at) === TRACKED || (track.state(at) === ABSENT && track.state(frame) === TRACKED);
        const [left, right] = [frame > 0 && was(frame - 1), frame + 1 < this.about.frames && (was(frame + 1) || track.state(frame) === TRACKED)];
        return left || right ? { before: left ? frame - 1 : frame, after: right ? frame + 1 : frame } : null;
    }

    private travel(history: History): void {
        if (history !== this.history) {
            this.history = history;
            if (this.thing === undefined) {
                this.selected = this.document.things.at(-1)?.id ?? null;
            }
            this.saveSoon();
            this.events.changed();
            void this.tellEngine();
        }
    }

    /** The engine gets the document as it is now; what comes while it is told is told together. */
    private async tellEngine(ids: readonly number[] = this.document.things.map((thing) => thing.id)): Promise<void> {
        ids.forEach((id) => this.toRefresh.add(id));
        if (this.isTelling) {
            return;
        }
        this.isTelling = true;
        try {
            while (this.toRefresh.size > 0) {
                const stale = [...this.toRefresh];
                this.toRefresh.clear();
                await this.engine.ask("objects", this.document.things.map(toEntry));
                await this.refresh(stale);
            }
        } catch (error) {
            this.events.failed(error);
        } finally {
            this.isTelling = false;
            this.events.changed();
        }
    }

    private async refresh(ids: readonly number[]): Promise<void> {
        for (const id of ids) {
            if (thingOf(this.document, id) !== undefined) {
                this.tracks.set(id, new Track(await this.engine.ask("rows", id)));
            }
        }
        this.places = await this.engine.ask("places");
        this.events.changed();
    }

    private async restore(): Promise<void> {
        const { library, about } = this;
        const work = await library?.work(about.fingerprint);
        if (work !== undefined) {
            this.history = work.history;
            this.selected = work.selected;
            this.frame = Math.min(work.frame, about.frames - 1);
            await library?.forgetPasses(about.fingerprint, (pass) => wasDrawn(work.history, pass));
            await this.engine.ask("knownPasses", (await library?.passes(about.fingerprint)) ?? []);
        }
        await this.tellEngine();
    }

    private isSavePlanned = false;

    /** At the end of this turn, so that what one key stroke does is saved once. */
    private saveSoon(): void {
        if (this.isSavePlanned || this.library === null) {
            return;
        }
        this.isSavePlanned = true;
        queueMicrotask(() => {
            this.isSavePlanned = false;
            const { library } = this;
            const work: Work = {
                fingerprint: this.about.fingerprint,
                name: this.about.name,
                history: this.history,
                frame: this.frame,
                selected: this.selected,
                saved: Date.now(),
            };
            this.saving = this.saving.then(() => library?.saveWork(work)).catch((error: unknown) => this.events.failed(error));
        });
    }

    /** Once it is resolved, everything is saved. */
    get saved(): Promise<void> {
        return this.saving;
    }

    // Files.

    exported(format: string): Promise<[string, string][]> {
        return this.engine.ask("export", format);
    }

    project(): Promise<string> {
        return this.engine.ask("project");
    }

    /** The objects of a project file or of another annotation instead of those here; one step of undo. */
    async takeFile(name: string, text: string): Promise<void> {
        this.adopt(`opening ${name}`, await this.engine.ask("openFile", name, text));
        await this.tellEngine();
    }

    private adopt(deed: string, opened: Opened): void {
        const things = opened.objects.map(fromEntry);
        const nextId = things.length + 1;
        this.history = done(this.history, deed, { things, nextId });
        this.selected = things[0]?.id ?? null;
        this.saveSoon();
        opened.passes.forEach((pass) => this.hear({ is: "pass", pass }));
    }
}

/** Whether a pass starts from a key frame of any step that can be gone back to. */
function wasDrawn(history: History, { from, start: { x, y, w, h } }: Pass): boolean {
    const isStart = (mark: Mark | undefined): boolean =>
        mark !== undefined && mark !== "absent" && mark.x === x && mark.y === y && mark.w === w && mark.h === h;
    return history.steps.some(({ document }) => document.things.some((thing) => isStart(thing.keys.get(from))));
}
