// Undo and redo: the documents that were, and which of them is now.

import { EMPTY, type Document } from "./document.ts";

export interface Step {
    /** What was done, for the tooltip of undo. */
    readonly deed: string;
    readonly document: Document;
}

export interface History {
    readonly steps: readonly Step[];
    readonly at: number;
}

/** Steps that are remembered; older ones cannot be undone. */
const MOST = 200;

export const BEGINNING: History = { steps: [{ deed: "", document: EMPTY }], at: 0 };

export function now(history: History): Document {
    return history.steps[history.at]?.document ?? EMPTY;
}

/** One more step; what had been undone is gone. */
export function done(history: History, deed: string, document: Document): History {
    const steps = [...history.steps.slice(0, history.at + 1), { deed, document }].slice(-MOST);
    return { steps, at: steps.length - 1 };
}

/** The last step, done a little further: what a key that is held does is one step. */
export function amended(history: History, document: Document): History {
    const step = { deed: lastDeed(history), document };
    return canUndo(history) ? { steps: [...history.steps.slice(0, history.at), step], at: history.at } : history;
}

export function canUndo(history: History): boolean {
    return history.at > 0;
}

export function canRedo(history: History): boolean {
    return history.at + 1 < history.steps.length;
}

export function undone(history: History): History {
    return canUndo(history) ? { ...history, at: history.at - 1 } : history;
}

export function redone(history: History): History {
    return canRedo(history) ? { ...history, at: history.at + 1 } : history;
}

/** What undo would take back. */
export function lastDeed(history: History): string {
    return canUndo(history) ? (history.steps[history.at]?.deed ?? "") : "";
}
