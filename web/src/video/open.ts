// Opens whatever the page was given.

import { openContainer } from "./container.ts";
import { openDemo } from "./demo.ts";
import { openPictures } from "./pictures.ts";
import type { About, DemoFrames, Source, SourceSpec } from "./source.ts";

/** `about` spares looking through the frames again; `demo` is asked only for the demo clip. */
export async function openSource(spec: SourceSpec, about: About | null, demo: () => Promise<DemoFrames>): Promise<Source> {
    switch (spec.kind) {
        case "video":
            return openContainer(spec.file, about);
        case "pictures":
            return openPictures(spec.name, spec.files, about);
        case "demo":
            return openDemo(await demo());
    }
}
