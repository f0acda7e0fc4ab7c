// A folder of pictures, in the order of the numbers in their names.

import { SourceError, everyFrame, type About, type Pixels, type Sample, type Source } from "./source.ts";

export const PICTURE_NAMES = /\.(jpe?g|png|webp|bmp|gif|avif)$/i;

/** `2.jpg` comes before `10.jpg`. */
const inOrder = new Intl.Collator("en", { numeric: true, sensitivity: "base" });

export function sortedPictures(files: Iterable<File>): File[] {
    const path = (file: File): string => file.webkitRelativePath || file.name;
    return [...files].filter((file) => PICTURE_NAMES.test(file.name)).sort((a, b) => inOrder.compare(path(a), path(b)));
}

function decode(file: File): Promise<ImageBitmap> {
    const options: ImageBitmapOptions = { colorSpaceConversion: "none", premultiplyAlpha: "none", imageOrientation: "none" };
    return createImageBitmap(file, options).catch(() => {
        throw new SourceError(`${file.name} is not a picture that this browser can read; leave it out, or convert it to PNG`);
    });
}

class Picture implements Sample {
    constructor(
        private readonly bitmap: ImageBitmap,
        private readonly file: File,
        private readonly about: About,
    ) {}

    async pixels(): Promise<Pixels> {
        const { width, height } = this.about;
        if (this.bitmap.width !== width || this.bitmap.height !== height) {
            const size = `${this.bitmap.width}x${this.bitmap.height}`;
            throw new SourceError(`${this.file.name} is ${size}, but the first picture is ${width}x${height}: frames of a video are all of one size`);
        }
        const canvas = new OffscreenCanvas(width, height);
        const context = canvas.getContext("2d", { willReadFrequently: true });
        if (context === null) {
            throw new SourceError("this browser gave no canvas to read pixels from");
        }
        context.drawImage(this.bitmap, 0, 0);
        return new Uint8Array(context.getImageData(0, 0, width, height).data.buffer as ArrayBuffer);
    }

    picture(): Promise<ImageBitmap> {
        return createImageBitmap(this.bitmap);
    }

    close(): void {
        this.bitmap.close();
    }
}

export async function openPictures(name: string, files: readonly File[], known: About | null): Promise<Source> {
    const [first] = files;
    if (first === undefined) {
        throw new SourceError("there is no picture in this folder (jpg, png, webp, bmp, gif or avif)");
    }
    const about = known ?? (await describe(name, files, first));
    return {
        about,
        sample: async (frame) => {
            const file = files[frame];
            if (file === undefined) {
                throw new SourceError(`there is no frame ${frame + 1}`);
            }
            return new Picture(await decode(file), file, about);
        },
        close: () => {},
    };
}

async function describe(name: string, files: readonly File[], first: File): Promise<About> {
    const bitmap = await decode(first);
    const { width, height } = bitmap;
    bitmap.close();
    const bytes = files.reduce((sum, file) => sum + file.size, 0);
    return {
        name,
        fingerprint: `${name} ${files.length} pictures ${bytes} bytes ${width}x${height}`,
        width,
        height,
        frames: files.length,
        times: null,
        start: 0,
        labels: files.map((file) => file.name),
        startsAt: everyFrame(files.length),
    };
}
