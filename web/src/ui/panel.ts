// The side: objects, and the places to look at.

import type { Thing } from "../model/document.ts";
import type { Place } from "../engine/wasm.ts";
import { h, icon, iconButton, ICONS } from "./dom.ts";
import { keyOf } from "./keymap.ts";

export interface PanelEvents {
    select(id: number): void;
    describe(id: number, words: Partial<Pick<Thing, "name" | "class" | "colour">>): void;
    removeThing(): void;
    newThing(): void;
    goToPlace(place: Place): void;
}

/** Places that are listed; the rest is counted. */
const MOST_PLACES = 50;

export class Panel {
    readonly element: HTMLElement;
    private readonly things = h("div", { class: "things" });
    private readonly places = h("ol", { class: "places" });
    private readonly placesTitle = h("h2", {});
    /** What is shown, so that a field that somebody types in is left alone. */
    private shownThings = "";
    private shownPlaces = "";

    constructor(private readonly events: PanelEvents) {
        const add = iconButton("plus", "New object", keyOf("newThing"), () => events.newThing());
        this.element = h(
            "aside",
            { class: "panel" },
            h("header", {}, h("h2", {}, "Objects"), add),
            this.things,
            h("header", {}, this.placesTitle),
            this.places,
        );
    }

    show(things: readonly Thing[], selected: number | null, places: readonly Place[], frame: number): void {
        const isTyping = this.things.contains(document.activeElement) && document.activeElement instanceof HTMLInputElement;
        const thingsNow = JSON.stringify([things.map(({ id, name, class: kind, colour }) => [id, name, kind, colour]), selected]);
        if (thingsNow !== this.shownThings && !isTyping) {
            this.shownThings = thingsNow;
            this.things.replaceChildren(...(things.length === 0 ? [h("p", { class: "empty" }, "None yet. Drag a box around somebody on the picture.")] : things.map((thing) => this.thingRow(thing, thing.id === selected))));
        }
        const placesNow = JSON.stringify([places, things.map(({ id, name, colour }) => [id, name, colour]), frame]);
        if (placesNow !== this.shownPlaces) {
            this.shownPlaces = placesNow;
            this.placesTitle.textContent = places.length === 0 ? "Doubtful places" : `Doubtful places (${places.length})`;
            const byId = new Map(things.map((thing) => [thing.id, thing]));
            this.places.replaceChildren(
                ...(places.length === 0
                    ? [h("li", { class: "empty" }, "What the tracker is unsure of is listed here, the most doubtful first.")]
                    : places.slice(0, MOST_PLACES).map((place) => this.placeRow(place, byId.get(place.object), frame))),
            );
        }
    }

    /** Puts the cursor into the name of the selected object. */
    rename(): void {
        const name = this.things.querySelector<HTMLInputElement>(".thing.selected .thing-name");
        name?.focus();
        name?.select();
    }

    private thingRow(thing: Thing, isSelected: boolean): HTMLElement {
        const field = (what: "name" | "class", label: string): HTMLInputElement => {
            const input = h("input", { class: `thing-${what}`, "aria-label": label, title: label, value: thing[what], maxlength: 200, spellcheck: "false", autocomplete: "off" });
            const take = (): void => {
                const text = input.value.trim();
                if (text !== "" && text !== thing[what]) {
                    this.events.describe(thing.id, { [what]: text });
                } else {
                    input.value = thing[what];
                }
            };
            input.addEventListener("focus", () => {
                if (!isSelected) {
                    this.events.select(thing.id);
                }
            });
            input.addEventListener("keydown", (event) => {
                event.stopPropagation();
                if (event.key === "Enter" || event.key === "Escape") {
                    if (event.key === "Escape") {
                        input.value = thing[what];
                    }
                    input.blur();
                }
            });
            input.addEventListener("blur", take);
            return input;
        };
        const colour = h("input", { type: "color", class: "thing-colour", "aria-label": "colour", title: "Colour", value: thing.colour });
        colour.addEventListener("change", () => this.events.describe(thing.id, { colour: colour.value }));
        const remove = iconButton("trash", "Remove the object", keyOf("removeThing"), () => {
            this.events.select(thing.id);
            this.events.removeThing();
        });
        const row = h("div", { class: `thing${isSelected ? " selected" : ""}`, "data-id": thing.id }, colour, h("div", { class: "thing-words" }, field("name", "Name"), field("class", "Class")), isSelected ? remove : null);
        row.addEventListener("pointerdown", (event) => {
            if (!isSelected && !(event.target instanceof HTMLInputElement)) {
                this.events.select(thing.id);
            }
        });
        return row;
    }

    private placeRow(place: Place, thing: Thing | undefined, frame: number): HTMLElement {
        const span = place.first === place.last ? "" : ` (${place.first + 1}–${place.last + 1})`;
        const button = h(
            "button",
            { type: "button", class: frame >= place.first && frame <= place.last ? "place here" : "place", onclick: () => this.events.goToPlace(place) },
            icon(ICONS.look),
            h("span", { class: "place-where" }, `frame ${place.frame + 1}${span}`),
            h("span", { class: "place-who" }, thing?.name ?? ""),
            h("span", { class: "place-doubt", title: "Probability that the box is right" }, `${Math.round(place.confidence * 100)}%`),
        );
        button.style.setProperty("--thing", thing?.colour ?? "gray");
        button.addEventListener("pointerup", () => button.blur());
        return h("li", {}, button);
    }
}
