// The worker: the engine, and the video as it sees it. It never shows anything.

import type { ThingEntry } from "../model/document.ts";
import { FrameCache, TO_PIXELS } from "../video/cache.ts";
import { openSource } from "../video/open.ts";
import { SourceError, type Pixels } from "../video/source.ts";
import type { Message, Request, Services } from "./protocol.ts";
import { Tracking } from "./tracking.ts";
import { Engine } from "./wasm.ts";

/** Decoded frames that are kept, in bytes, so that a correction does not decode them again. */
const KEPT = 768 << 20;

const say = (message: Message): void => {
    const picture = message.is === "seen" ? message.picture : null;
    postMessage(message, { transfer: picture === null ? [] : [picture] });
};

let open: { engine: Engine; frames: FrameCache<Pixels>; tracking: Tracking } | null = null;

function opened(): NonNullable<typeof open> {
    if (open === null) {
        throw new SourceError("no video is open");
    }
    return open;
}

type Answers = { [S in keyof Services]: (...parameters: Parameters<Services[S]>) => ReturnType<Services[S]> | Promise<ReturnType<Services[S]>> };

const answers: Answers = {
    async open(code, spec) {
        open?.tracking.stop();
        open?.frames.close();
        open = null;
        const engine = await Engine.start(code);
        const source = await openSource(spec, null, () => Promise.resolve(engine));
        engine.video(source.about);
        const frames = new FrameCache(source, TO_PIXELS, KEPT);
        open = { engine, frames, tracking: new Tracking(engine, frames, source.about.width, source.about.height, say) };
        return source.about;
    },
    objects(objects: readonly ThingEntry[]) {
        opened().engine.objects(objects);
        opened().tracking.outdate();
    },
    track: (object, before, after, withPictures) => opened().tracking.run(object, before, after, withPictures),
    stop: () => opened().tracking.stop(),
    knownPasses: (passes) => passes.forEach((pass) => opened().engine.knownPass(pass)),
    rows: (object) => opened().engine.rows(object),
    places: () => opened().engine.places(),
    export: (format) => opened().engine.export(format),
    project: () => opened().engine.project(),
    openFile: (name, text) => opened().engine.openFile(name, text),
};

addEventListener("messageerror", () => {
    throw new Error("a request could not be read");
});
addEventListener("message", ({ data }: MessageEvent<Request>) => {
    const { id, service, parameters } = data;
    const answer = answers[service] as (...parameters: readonly unknown[]) => unknown;
    void Promise.resolve()
        .then(() => answer(...parameters))
        .then((result) => say({ is: "answer", id, result }))
        .catch((error: unknown) => {
            const message = error instanceof Error ? error.message : String(error);
            say({ is: "refusal", id, message, isOurs: !(error instanceof SourceError) });
        });
});
