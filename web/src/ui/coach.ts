// One line that says what to do next: who follows it has annotated a video.

import type { Workshop } from "../workshop.ts";
import { hasBox } from "../model/document.ts";
import { TRACKED } from "../model/track.ts";
import { h } from "./dom.ts";

type Piece = string | { readonly key: string };

const key = (name: string): Piece => ({ key: name });

function advice(workshop: Workshop): Piece[] {
    const { things } = workshop.document;
    if (workshop.leftToDo !== null) {
        return ["Tracking… ", key("Esc"), " stops."];
    }
    if (workshop.isDrawingNew) {
        return ["Drag a box around the new object, or put one in the middle with ", key("B"), "."];
    }
    if (!things.some(hasBox)) {
        return ["Drag a box around somebody. ", key("?"), " lists every key."];
    }
    const isTracked = things.some((thing) => {
        const track = workshop.track(thing.id);
        return Array.from({ length: track.frames }, (_, frame) => frame).some((frame) => track.state(frame) === TRACKED);
    });
    if (!isTracked) {
        return ["Now ", key("T"), " tracks forward, ", key("Shift+T"), " backward. ", key("R"), " names the object."];
    }
    const { places, thing } = workshop;
    if (thing !== undefined && !thing.keys.has(workshop.frame) && places.some((place) => place.object === thing.id && place.first <= workshop.frame && workshop.frame <= place.last)) {
        return ["Is it right? Drag the box where it belongs, ", key("Enter"), " if it is, ", key("X"), " if the object is not to be seen. ", key("N"), " goes on."];
    }
    if (places.length > 0) {
        return [`${places.length === 1 ? "One place is" : `${places.length} places are`} doubtful: `, key("N"), " goes there. Only what a correction touches is tracked again."];
    }
    return ["Nothing is doubtful. Look through it with ", key("Space"), ", then ", key("Ctrl+E"), " exports."];
}

export class Coach {
    readonly element = h("p", { class: "coach" });
    private shown = "";

    show(workshop: Workshop): void {
        const pieces = advice(workshop);
        const text = JSON.stringify(pieces);
        if (text !== this.shown) {
            this.shown = text;
            this.element.replaceChildren(...pieces.map((piece) => (typeof piece === "string" ? piece : h("kbd", {}, piece.key))));
        }
    }
}
