// A sentence at the foot of the page, read out by screen readers too.

import { h } from "./dom.ts";

const box = h("div", { class: "toasts", role: "status", "aria-live": "polite" });

/** Says something for some seconds; a problem stays until it is clicked away or replaced. */
export function say(words: string, isProblem = false): void {
    if (!box.isConnected) {
        document.body.append(box);
    }
    const toast = h("div", { class: isProblem ? "toast problem" : "toast", onclick: () => toast.remove() }, words);
    box.replaceChildren(toast);
    if (!isProblem) {
        setTimeout(() => toast.remove(), 5000);
    }
}
