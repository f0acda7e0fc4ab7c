// The page's side of the worker.

import { SourceError } from "../video/source.ts";
import type { Message, Service, Services } from "./protocol.ts";
import { EngineFailure } from "./wasm.ts";
import EngineWorker from "./worker.ts?worker&inline";

export type Notice = Exclude<Message, { is: "answer" } | { is: "refusal" }>;

interface Waiting {
    resolve(result: unknown): void;
    reject(error: Error): void;
}

export class EngineClient {
    private readonly worker = new EngineWorker();
    private readonly waiting = new Map<number, Waiting>();
    private nextId = 0;

    constructor(hear: (notice: Notice) => void) {
        this.worker.onmessage = ({ data }: MessageEvent<Message>) => {
            if (data.is === "answer") {
                this.taken(data.id)?.resolve(data.result);
            } else if (data.is === "refusal") {
                const error = data.isOurs ? new EngineFailure(data.message) : new SourceError(data.message);
                this.taken(data.id)?.reject(error);
            } else {
                hear(data);
            }
        };
        this.worker.onerror = (event) => this.giveUp(event.message);
        this.worker.onmessageerror = () => this.giveUp("what it said could not be read");
    }

    ask<S extends Service>(service: S, ...parameters: Parameters<Services[S]>): Promise<ReturnType<Services[S]>> {
        const id = this.nextId++;
        return new Promise((resolve, reject) => {
            this.waiting.set(id, { resolve: (result) => resolve(result as ReturnType<Services[S]>), reject });
            this.worker.postMessage({ id, service, parameters });
        });
    }

    close(): void {
        this.worker.terminate();
        this.waiting.clear();
    }

    private giveUp(reason: string | undefined): void {
        const error = new EngineFailure(`The tracker's worker failed (${reason ?? "no reason given"}). Load the page again: what you did is saved.`);
        this.waiting.forEach((waiting) => waiting.reject(error));
        this.waiting.clear();
    }

    private taken(id: number): Waiting | undefined {
        const waiting = this.waiting.get(id);
        this.waiting.delete(id);
        return waiting;
    }
}
