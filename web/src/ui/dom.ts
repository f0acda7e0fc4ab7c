// Elements without markup: text is text, whatever it holds.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | ((event: never) => void) | undefined>;

/** An element with attributes (`onclick` and the like are listeners) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === "function") {
            element.addEventListener(name.slice(2), value as EventListener);
        } else if (value === true) {
            element.setAttribute(name, "");
        } else if (value !== undefined && value !== false) {
            element.setAttribute(name, String(value));
        }
    }
    element.append(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
    return element;
}

/** A picture of a few strokes on a 24 x 24 grid. */
export function icon(path: string): SVGSVGElement {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("viewBox", "0 0 24 24");
    svg.setAttribute("class", "icon");
    svg.setAttribute("aria-hidden", "true");
    const stroke = document.createElementNS("http://www.w3.org/2000/svg", "path");
    stroke.setAttribute("d", path);
    svg.append(stroke);
    return svg;
}

export const ICONS = {
    undo: "M9 7 4 12l5 5M4 12h11a5 5 0 0 1 0 10h-3",
    redo: "m15 7 5 5-5 5M20 12H9a5 5 0 0 0 0 10h3",
    play: "M7 5v14l12-7z",
    pause: "M8 5v14M16 5v14",
    back: "M15 5 8 12l7 7",
    forth: "m9 5 7 7-7 7",
    toStart: "M6 5v14M18 5l-8 7 8 7",
    toEnd: "M18 5v14M6 5l8 7-8 7",
    trackForward: "M4 12h14M13 6l6 6-6 6",
    trackBackward: "M20 12H6M11 6l-6 6 6 6",
    absent: "M3 3l18 18M10 6a9 9 0 0 1 11 6 12 12 0 0 1-2 3M6 8a12 12 0 0 0-3 4 9.500 9.500 0 0 0 12 5.500",
    key: "M12 3 21 12 12 21 3 12z",
    trash: "M4 7h16M9 7V4h6v3M6 7l1 13h10l1-13",
    plus: "M12 5v14M5 12h14",
    export: "M12 15V4M7 9l5-5 5 5M5 15v5h14v-5",
    import: "M12 4v11M7 10l5 5 5-5M5 15v5h14v-5",
    save: "M5 4h11l3 3v13H5zM8 4v5h7V4M8 20v-6h8v6",
    theme: "M12 3a9 9 0 1 0 9 9 7 7 0 0 1-9-9z",
    help: "M9 9a3 3 0 1 1 4 2.800c-.7.300-1 .9-1 1.700V14M12 17.500v.01",
    close: "M6 6l12 12M18 6 6 18",
    film: "M4 5h16v14H4zM8 5v14M16 5v14M4 9.500h4M4 14.500h4M16 9.500h4M16 14.500h4",
    look: "M2 12s4-7 10-7 10 7 10 7-4 7-10 7-10-7-10-7zM12 9a3 3 0 1 1 0 6 3 3 0 0 1 0-6z",
} as const;

/** A button with an icon and a key that does the same. */
export function iconButton(name: keyof typeof ICONS, label: string, key: string, action: () => void): HTMLButtonElement {
    const title = key === "" ? label : `${label} (${key})`;
    const button = h("button", { type: "button", class: "icon-button", title, "aria-label": label, onclick: action }, icon(ICONS[name]));
    // Keys go on meaning what they mean after a click: the space bar plays.
    button.addEventListener("pointerup", () => button.blur());
    return button;
}
