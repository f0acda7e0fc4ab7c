// A video file: Mediabunny reads the container, WebCodecs decodes, and frames are counted as they are shown.

import { ALL_FORMATS, BlobSource, EncodedPacketSink, Input, VideoSampleSink, type InputVideoTrack, type VideoSample } from "mediabunny";
import { SourceError, type About, type Pixels, type Sample, type Source } from "./source.ts";

/** Half a microsecond: times that are closer are one time. */
const SAME_TIME = 0.5e-6;

const REMEDY = "ffmpeg -i IN -c:v libx264 -crf 18 OUT.mp4 makes a file that it can";

class Decoded implements Sample {
    constructor(
        private readonly sample: VideoSample,
        private readonly about: About,
    ) {}

    async pixels(): Promise<Pixels> {
        const { width, height } = this.about;
        const { rotation, flip, visibleRect } = this.sample;
        if (rotation === 0 && !flip && visibleRect.width === width && visibleRect.height === height) {
            const bytes = new Uint8Array(width * height * 4);
            await this.sample.copyTo(bytes, { format: "RGBA", colorSpace: "srgb" });
            return bytes;
        }
        const context = this.drawn();
        return new Uint8Array(context.getImageData(0, 0, width, height).data.buffer as ArrayBuffer);
    }

    picture(): Promise<ImageBitmap> {
        return Promise.resolve(this.drawn().canvas.transferToImageBitmap());
    }

    close(): void {
        this.sample.close();
    }

    /** Upright, with square pixels. */
    private drawn(): OffscreenCanvasRenderingContext2D {
        const { width, height } = this.about;
        const context = new OffscreenCanvas(width, height).getContext("2d", { alpha: false, willReadFrequently: true });
        if (context === null) {
            throw new SourceError("this browser gave no canvas to draw frames on");
        }
        this.sample.draw(context, 0, 0, width, height);
        return context;
    }
}

class Container implements Source {
    private readonly sink: VideoSampleSink;
    private stream: AsyncGenerator<VideoSample, void, unknown> | null = null;
    /** The number of the frame that the stream gives next. */
    private next = -1;

    constructor(
        private readonly input: Input,
        track: InputVideoTrack,
        readonly about: About,
    ) {
        this.sink = new VideoSampleSink(track);
    }

    async sample(frame: number): Promise<Sample> {
        // A little ahead the stream gets there by itself; the decoder has to pass what lies between anyway.
        const isAhead = this.next >= 0 && frame >= this.next && (this.about.startsAt[frame] ?? 0) <= this.next;
        if (!isAhead || this.stream === null) {
            await this.stream?.return();
            this.stream = this.sink.samples(this.time(frame) - SAME_TIME);
        }
        // Until it is known that the frame came, the stream stands nowhere.
        this.next = -1;
        for (;;) {
            const found = await this.stream.next();
            if (found.done) {
                throw new SourceError(`${this.about.name}: frame ${frame + 1} cannot be decoded; the file may be damaged there`);
            }
            const sample = found.value;
            if (sample.timestamp < this.time(frame) - SAME_TIME) {
                sample.close();
                continue;
            }
            if (sample.timestamp > this.time(frame) + SAME_TIME) {
                sample.close();
                throw new SourceError(`${this.about.name}: frame ${frame + 1} is missing; the file may be damaged there`);
            }
            this.next = frame + 1;
            return new Decoded(sample, this.about);
        }
    }

    private time(frame: number): number {
        return (this.about.times?.[frame] ?? 0) + this.about.start;
    }

    close(): void {
        void this.stream?.return();
        this.input.dispose();
    }
}

export async function openContainer(file: File, known: About | null): Promise<Source> {
    const input = new Input({ formats: ALL_FORMATS, source: new BlobSource(file) });
    try {
        const track = await videoTrack(file, input);
        return new Container(input, track, known ?? (await describe(file, track)));
    } catch (error) {
        input.dispose();
        throw error;
    }
}

async function videoTrack(file: File, input: Input): Promise<InputVideoTrack> {
    if (!(await input.canRead())) {
        throw new SourceError(`${file.name} is not a video that a browser can read (mp4, mov, webm, mkv, ts); ${REMEDY}`);
    }
    const track = await input.getPrimaryVideoTrack();
    if (track === null) {
        throw new SourceError(`${file.name} has no pictures in it, only sound or text; choose another file`);
    }
    if (!(await track.canDecode())) {
        const codec = (await track.getCodecParameterString()) ?? (await track.getCodec()) ?? "unknown";
        throw new SourceError(`${file.name}: this browser cannot decode ${codec}; ${REMEDY}`);
    }
    return track;
}

interface Index {
    /** In order of presentation, in seconds, as the container has them. */
    readonly times: Float64Array;
    readonly isKey: readonly boolean[];
}

/** Every frame that is shown. What a container cuts away has a time before 0. */
async function indexOf(track: InputVideoTrack): Promise<Index> {
    const packets: { time: number; isKey: boolean }[] = [];
    for await (const packet of new EncodedPacketSink(track).packets(undefined, undefined, { metadataOnly: true })) {
        if (packet.timestamp > -SAME_TIME) {
            packets.push({ time: packet.timestamp, isKey: packet.type === "key" });
        }
    }
    packets.sort((a, b) => a.time - b.time);
    return { times: Float64Array.from(packets, (packet) => packet.time), isKey: packets.map((packet) => packet.isKey) };
}

async function describe(file: File, track: InputVideoTrack): Promise<About> {
    const { times, isKey } = await indexOf(track);
    const [offset] = times;
    if (offset === undefined) {
        throw new SourceError(`${file.name} has no frame in it; choose another file`);
    }
    const [width, height] = await Promise.all([track.getDisplayWidth(), track.getDisplayHeight()]);
    const frames = times.length;
    let start = 0;
    const startsAt = Uint32Array.from(isKey, (key, frame) => (start = key ? frame : start));
    return {
        name: file.name,
        fingerprint: `${file.name} ${file.size} bytes ${frames} frames ${width}x${height}`,
        width,
        height,
        frames,
        times: times.map((time) => time - offset),
        start: offset,
        labels: Array.from({ length: frames }, (_, frame) => `frame ${frame + 1}`),
        startsAt,
    };
}
