// The demo clip: a synthetic walker whom the engine renders.

import { everyFrame, type About, type DemoFrames, type Pixels, type Sample, type Source } from "./source.ts";

const FRAMES_PER_SECOND = 25;

class Rendered implements Sample {
    constructor(
        private readonly bytes: Pixels,
        private readonly about: About,
    ) {}

    pixels(): Promise<Pixels> {
        return Promise.resolve(this.bytes);
    }

    picture(): Promise<ImageBitmap> {
        return createImageBitmap(new ImageData(new Uint8ClampedArray(this.bytes.buffer), this.about.width, this.about.height));
    }

    close(): void {}
}

export function openDemo(engine: DemoFrames): Source {
    const { width, height, frames } = engine.demoSize();
    const about: About = {
        name: "demo walk",
        fingerprint: `demo ${frames} ${width}x${height}`,
        width,
        height,
        frames,
        times: Float64Array.from({ length: frames }, (_, frame) => frame / FRAMES_PER_SECOND),
        start: 0,
        labels: Array.from({ length: frames }, (_, frame) => `frame ${frame + 1}`),
        startsAt: everyFrame(frames),
    };
    return {
        about,
        sample: (frame) => Promise.resolve(new Rendered(engine.demoFrame(frame), about)),
        close: () => {},
    };
}
