import { defineConfig } from "vite";
import { singleFile } from "./build/single-file.ts";

export default defineConfig({
    plugins: [singleFile()],
    build: { target: "es2023", assetsInlineLimit: Number.MAX_SAFE_INTEGER, modulePreload: false, chunkSizeWarningLimit: 8000 },
    // A page that was opened from disk may start no module as a worker.
    worker: { format: "iife" },
    test: { include: ["test/**/*.test.ts"], testTimeout: 600_000, hookTimeout: 600_000, fileParallelism: false },
} as Parameters<typeof defineConfig>[0]);
