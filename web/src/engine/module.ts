// The engine's code: the page carries it inside, so that nothing has to be fetched.

import inlined from "./infopart.wasm?url&inline";

/** Bytes and not a compiled module, which a page that was opened from disk cannot send to its worker. */
export function engineCode(): Uint8Array<ArrayBuffer> {
    const text = atob(inlined.slice(inlined.indexOf(",") + 1));
    const bytes = new Uint8Array(text.length);
    for (let at = 0; at < text.length; at++) {
        bytes[at] = text.charCodeAt(at);
    }
    return bytes;
}
