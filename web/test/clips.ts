// Videos that the tests make with ffmpeg, and what ffprobe says of them.

import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterAll } from "vitest";

export const folder = mkdtempSync(join(tmpdir(), "infopart-web-"));
afterAll(() => rmSync(folder, { recursive: true, force: true }));

function has(program: string): boolean {
    try {
        execFileSync(program, ["-version"], { stdio: "ignore" });
        return true;
    } catch {
        return false;
    }
}

export const hasFfmpeg = has("ffmpeg") && has("ffprobe");

/** Runs ffmpeg; the path of what it made. */
export function made(name: string, ...parameters: string[]): string {
    const path = join(folder, name);
    execFileSync("ffmpeg", ["-v", "error", "-y", ...parameters, path]);
    return path;
}

export interface Probed {
    readonly frames: number;
    readonly width: number;
    readonly height: number;
    /** Seconds since the first frame. */
    readonly times: readonly number[];
}

/** What ffprobe decodes. */
export function probed(path: string): Probed {
    const text = execFileSync("ffprobe", ["-v", "error", "-select_streams", "v:0", "-show_frames", "-show_entries", "frame=pts_time", "-show_streams", "-of", "json", path], { maxBuffer: 1 << 28 });
    const { frames, streams } = JSON.parse(String(text)) as {
        frames: { pts_time: string }[];
        streams: { width: number; height: number; side_data_list?: { rotation?: number }[] }[];
    };
    const stream = streams[0] ?? { width: 0, height: 0 };
    const isTurned = (stream.side_data_list ?? []).some(({ rotation }) => Math.abs(rotation ?? 0) % 180 === 90);
    const times = frames.map((frame) => Number(frame.pts_time));
    const [width, height] = isTurned ? [stream.height, stream.width] : [stream.width, stream.height];
    return { frames: frames.length, width, height, times: times.map((time) => time - (times[0] ?? 0)) };
}

/** Raw frames of the demo clip as a file that ffmpeg reads. */
export function rawFile(name: string, frames: readonly Uint8Array[]): string {
    const path = join(folder, name);
    writeFileSync(path, Buffer.concat(frames));
    return path;
}

/** Real data as CONTRIBUTING.md describes it. */
export function dataFolder(): string | null {
    const named = process.env["INFOPART_DATA"] ?? join(import.meta.dirname, "../../../shared/data");
    return existsSync(named) && statSync(named).isDirectory() ? named : null;
}
