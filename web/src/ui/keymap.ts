// Every action has a key, and this is the list of them: what is pressed is looked up here, and `?` shows it.

export type Action =
    | "play" | "forth" | "back" | "forth10" | "back10" | "first" | "last" | "goto" | "nextKey" | "previousKey" | "nextDoubt" | "previousDoubt"
    | "newThing" | "placeBox" | "key" | "absent" | "removeKey" | "removeThing" | "rename" | "nextThing"
    | "left" | "right" | "up" | "down" | "wider" | "narrower" | "taller" | "shorter"
    | "track" | "trackBack" | "trackAll" | "stop"
    | "undo" | "redo" | "save" | "open" | "export" | "import" | "zoomIn" | "zoomOut" | "zoomFit" | "theme" | "help";

interface Binding {
    readonly action: Action;
    /** As people write it; the first is shown. */
    readonly keys: readonly string[];
    readonly meaning: string;
}

export interface Group {
    readonly title: string;
    readonly bindings: readonly Binding[];
}

export const KEYMAP: readonly Group[] = [
    {
        title: "Track",
        bindings: [
            { action: "track", keys: ["T"], meaning: "Track forward to the next key frame" },
            { action: "trackBack", keys: ["Shift+T"], meaning: "Track backward to the key frame before" },
            { action: "trackAll", keys: ["A"], meaning: "Track whatever is missing, both ways" },
            { action: "stop", keys: ["Esc"], meaning: "Stop tracking; let go" },
            { action: "nextDoubt", keys: ["N"], meaning: "Next doubtful place" },
            { action: "previousDoubt", keys: ["Shift+N"], meaning: "Doubtful place before" },
        ],
    },
    {
        title: "Draw",
        bindings: [
            { action: "newThing", keys: ["O"], meaning: "New object: then drag on the picture" },
            { action: "placeBox", keys: ["B"], meaning: "Put a box in the middle, to be moved by keys" },
            { action: "key", keys: ["Enter"], meaning: "This box is right: make it a key frame" },
            { action: "absent", keys: ["X"], meaning: "Absent from this frame on" },
            { action: "removeKey", keys: ["Delete", "Backspace"], meaning: "Remove the key frame here" },
            { action: "rename", keys: ["R", "F2"], meaning: "Rename the object" },
            { action: "removeThing", keys: ["Shift+Delete", "Shift+Backspace"], meaning: "Remove the object" },
            { action: "nextThing", keys: ["`"], meaning: "Next object; 1 to 9 choose one" },
        ],
    },
    {
        title: "Move the box",
        bindings: [
            { action: "up", keys: ["I"], meaning: "Up (hold for more)" },
            { action: "left", keys: ["J"], meaning: "Left" },
            { action: "down", keys: ["K"], meaning: "Down" },
            { action: "right", keys: ["L"], meaning: "Right" },
            { action: "taller", keys: ["Shift+I"], meaning: "Taller" },
            { action: "narrower", keys: ["Shift+J"], meaning: "Narrower" },
            { action: "shorter", keys: ["Shift+K"], meaning: "Less tall" },
            { action: "wider", keys: ["Shift+L"], meaning: "Wider" },
        ],
    },
    {
        title: "Go",
        bindings: [
            { action: "play", keys: ["Space"], meaning: "Play and pause" },
            { action: "forth", keys: ["→", "."], meaning: "One frame on" },
            { action: "back", keys: ["←", ","], meaning: "One frame back" },
            { action: "forth10", keys: ["Shift+→"], meaning: "Ten frames on" },
            { action: "back10", keys: ["Shift+←"], meaning: "Ten frames back" },
            { action: "nextKey", keys: ["↓", "]"], meaning: "Next key frame" },
            { action: "previousKey", keys: ["↑", "["], meaning: "Key frame before" },
            { action: "first", keys: ["Home"], meaning: "First frame" },
            { action: "last", keys: ["End"], meaning: "Last frame" },
            { action: "goto", keys: ["G"], meaning: "Go to a frame by number" },
        ],
    },
    {
        title: "Everything else",
        bindings: [
            { action: "undo", keys: ["Ctrl+Z"], meaning: "Undo" },
            { action: "redo", keys: ["Ctrl+Shift+Z", "Ctrl+Y"], meaning: "Redo" },
            { action: "save", keys: ["Ctrl+S"], meaning: "Save a project file" },
            { action: "export", keys: ["Ctrl+E"], meaning: "Export boxes" },
            { action: "import", keys: ["Ctrl+I"], meaning: "Import boxes or a project" },
            { action: "open", keys: ["Ctrl+O"], meaning: "Open another video" },
            { action: "zoomIn", keys: ["+", "="], meaning: "Closer; the wheel does it too" },
            { action: "zoomOut", keys: ["-"], meaning: "Farther" },
            { action: "zoomFit", keys: ["0"], meaning: "The whole picture" },
            { action: "theme", keys: ["M"], meaning: "Light or dark" },
            { action: "help", keys: ["?", "H"], meaning: "This list" },
        ],
    },
];

const NAMES: Record<string, string> = {
    " ": "Space", ArrowRight: "→", ArrowLeft: "←", ArrowUp: "↑", ArrowDown: "↓", Escape: "Esc",
};

const ACTIONS = new Map(KEYMAP.flatMap((group) => group.bindings).flatMap(({ action, keys }) => keys.map((key) => [key, action] as const)));

/** What the key that was pressed means. */
export function actionOf(event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">): Action | undefined {
    if (event.altKey) {
        return undefined;
    }
    const isLetter = /^[a-z]$/i.test(event.key);
    const name = NAMES[event.key] ?? (isLetter ? event.key.toUpperCase() : event.key);
    // Signs such as ? have what Shift does to them in their name already.
    const isSign = name.length === 1 && !isLetter && !/[→←↑↓]/.test(name);
    const shift = event.shiftKey && !isSign ? "Shift+" : "";
    return ACTIONS.get(`${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${shift}${name}`);
}

/** The key that is shown for an action. */
export function keyOf(action: Action): string {
    return KEYMAP.flatMap((group) => group.bindings).find((binding) => binding.action === action)?.keys[0] ?? "";
}
