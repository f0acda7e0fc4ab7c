// Windows that ask or tell.

import { h, icon, ICONS } from "./dom.ts";
import { KEYMAP } from "./keymap.ts";

/** Shows a dialog until it is closed. Keys pressed in it stay in it. */
function open(title: string, ...content: Node[]): HTMLDialogElement {
    const close = h("button", { type: "button", class: "icon-button", "aria-label": "Close", onclick: () => dialog.close() }, icon(ICONS.close));
    const dialog = h("dialog", { "aria-label": title }, h("header", {}, h("h2", {}, title), close), ...content);
    dialog.addEventListener("keydown", (event) => event.stopPropagation());
    dialog.addEventListener("close", () => dialog.remove());
    dialog.addEventListener("pointerdown", (event) => {
        if (event.target === dialog) {
            dialog.close();
        }
    });
    document.body.append(dialog);
    dialog.showModal();
    return dialog;
}

/** The first key for an action, and a second if that is short. */
function shown(keys: readonly string[]): readonly string[] {
    return keys.slice(0, 2).filter((key, at) => at === 0 || key.length <= 2);
}

/** Every key. */
export function showHelp(): void {
    const groups = KEYMAP.map((group) =>
        h(
            "section",
            {},
            h("h3", {}, group.title),
            h("dl", {}, ...group.bindings.flatMap(({ keys, meaning }) => [h("dt", {}, ...shown(keys).map((key) => h("kbd", {}, key))), h("dd", {}, meaning)])),
        ),
    );
    const mouse = h("p", { class: "note" }, "Mouse: drag to draw; drag a box or its edges to correct it; Shift-drag draws anew over it; the wheel zooms, the right button moves the picture.");
    open("Keys", h("div", { class: "keys" }, ...groups), mouse);
}

export interface Format {
    readonly name: string;
    readonly title: string;
    readonly extension: string;
    readonly meaning: string;
}

export const FORMATS: readonly Format[] = [
    { name: "csv", title: "CSV", extension: "csv", meaning: "A row for each object in each frame" },
    { name: "cvat", title: "CVAT", extension: "xml", meaning: "CVAT for video 1.1, tracks that can be edited there" },
    { name: "mot", title: "MOTChallenge", extension: "txt", meaning: "Ground truth: frame, id, box; the first pixel is 1" },
    { name: "coco", title: "COCO", extension: "json", meaning: "JSON with track_id" },
    { name: "yolo", title: "YOLO", extension: "zip", meaning: "A text a frame, fractions of the picture" },
    { name: "jsonl", title: "JSON lines", extension: "jsonl", meaning: "The rows of CSV as JSON" },
    { name: "otb", title: "OTB", extension: "txt", meaning: "x,y,w,h a frame; one object; the first pixel is 1" },
];

export function chooseFormat(things: number): Promise<Format | null> {
    return new Promise((resolve) => {
        let chosen: Format | null = null;
        const buttons = FORMATS.map((format) => {
            const isPossible = format.name !== "otb" || things === 1;
            return h(
                "button",
                {
                    type: "button",
                    class: "format",
                    disabled: !isPossible,
                    onclick: () => {
                        chosen = format;
                        dialog.close();
                    },
                },
                h("strong", {}, format.title),
                h("span", {}, isPossible ? format.meaning : "Has room for one object only"),
            );
        });
        const dialog = open("Export boxes", h("div", { class: "formats" }, ...buttons));
        dialog.addEventListener("close", () => resolve(chosen));
    });
}

export function askFrame(now: number, frames: number): Promise<number | null> {
    return new Promise((resolve) => {
        let chosen: number | null = null;
        const input = h("input", { type: "number", min: 1, max: frames, value: now + 1, "aria-label": "Frame" });
        const form = h("form", { method: "dialog", class: "goto" }, input, h("span", {}, `of ${frames}`), h("button", { class: "primary" }, "Go"));
        form.addEventListener("submit", () => {
            chosen = input.valueAsNumber - 1;
        });
        const dialog = open("Go to frame", form);
        input.select();
        dialog.addEventListener("close", () => resolve(chosen !== null && Number.isFinite(chosen) ? chosen : null));
    });
}
