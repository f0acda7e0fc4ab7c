// The first page: give it a video, take the demo clip, or go on with what was begun.

import type { Work } from "../store/library.ts";
import { h, icon, iconButton, ICONS } from "./dom.ts";
import { toggleTheme } from "./theme.ts";

export interface WelcomeEvents {
    pickVideo(): void;
    pickFolder(): void;
    demo(): void;
    resume(work: Work): void;
    forget(work: Work): void;
}

export function welcome(works: readonly Work[], events: WelcomeEvents): HTMLElement {
    const rows = works.map((work) => {
        const things = work.history.steps[work.history.at]?.document.things.length ?? 0;
        const when = new Date(work.saved).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
        return h(
            "li",
            {},
            h(
                "button",
                { type: "button", class: "resume", onclick: () => events.resume(work) },
                icon(ICONS.film),
                h("strong", {}, work.name),
                h("span", {}, `${things} ${things === 1 ? "object" : "objects"}, ${when}`),
            ),
            iconButton("trash", `Forget ${work.name}`, "", () => events.forget(work)),
        );
    });
    return h(
        "div",
        { class: "welcome" },
        h("div", { class: "corner" }, iconButton("theme", "Light or dark", "M", toggleTheme)),
        h(
            "div",
            { class: "hero" },
            h("h1", {}, "A box in every frame, from a few that you draw"),
            h("p", {}, "Draw somebody once. The tracker follows forward and backward, and shows where it is unsure. Correct it there, and you are done."),
            h(
                "div",
                { class: "drop" },
                icon(ICONS.import),
                h("p", {}, h("strong", {}, "Drop a video"), " or a folder of pictures here"),
                h(
                    "div",
                    { class: "choices" },
                    h("button", { type: "button", class: "primary", onclick: events.pickVideo }, "Choose a video"),
                    h("button", { type: "button", onclick: events.pickFolder }, "Choose a folder"),
                    h("button", { type: "button", class: "demo", onclick: events.demo }, icon(ICONS.play), "Try the demo clip"),
                ),
            ),
            h("p", { class: "private" }, "Nothing leaves this computer: the page asks no server for anything, and works without a network."),
            works.length > 0 && h("section", { class: "works" }, h("h2", {}, "Go on with"), h("ul", {}, ...rows)),
        ),
    );
}
