// Chromium, the built page in it, and what a hand does there.

import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium, type Browser, type BrowserContext, type Page } from "playwright-core";

const PLACES = ["/usr/bin/chromium", "/usr/bin/google-chrome", "/usr/bin/chromium-browser"];
const FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

export const chromiumPath = PLACES.find((path) => existsSync(path)) ?? null;

export const builtPage = pathToFileURL(join(import.meta.dirname, "../dist/index.html")).href;

export function launch(): Promise<Browser> {
    return chromium.launch({ executablePath: chromiumPath ?? "chromium", args: FLAGS });
}

export interface Rect {
    readonly x: number;
    readonly y: number;
    readonly w: number;
    readonly h: number;
}

/** The page as somebody uses it; whatever goes wrong in it, and every address it asks for, is kept. */
export class Visitor {
    readonly problems: string[] = [];
    readonly asked: string[] = [];

    private constructor(
        readonly page: Page,
        private readonly context: BrowserContext,
    ) {}

    static async arrive(context: BrowserContext): Promise<Visitor> {
        const page = await context.newPage();
        // A machine may be busy with other work.
        page.setDefaultTimeout(120_000);
        const visitor = new Visitor(page, context);
        page.on("pageerror", (error) => visitor.problems.push(error.message));
        page.on("console", (message) => message.type() === "error" && visitor.problems.push(message.text()));
        page.on("request", (request) => visitor.asked.push(request.url()));
        await page.goto(builtPage);
        await page.waitForSelector(".welcome");
        return visitor;
    }

    /** Drops files or folders from disk on the page. */
    async drop(...files: string[]): Promise<void> {
        const session = await this.context.newCDPSession(this.page);
        const { width, height } = this.page.viewportSize() ?? { width: 800, height: 600 };
        const data = { items: [], files, dragOperationsMask: 1 };
        const drag = (type: "dragEnter" | "dragOver" | "drop"): Promise<unknown> => session.send("Input.dispatchDragEvent", { type, x: width / 2, y: height / 2, data });
        await drag("dragEnter");
        await drag("dragOver");
        // A busy page says late that it would take the files, and a drop before that is none.
        await this.page.waitForSelector("#app.dragging");
        await drag("dragOver");
        await this.frames();
        await drag("dragOver");
        await drag("drop");
        await this.page.waitForSelector("#app:not(.dragging)");
        await session.detach();
    }

    async opened(name: string): Promise<void> {
        await this.page.waitForFunction((expected) => document.querySelector(".brand")?.textContent === expected, name, { timeout: 60_000 });
    }

    press(...keys: string[]): Promise<void> {
        return keys.reduce((before, key) => before.then(() => this.page.keyboard.press(key)), Promise.resolve());
    }

    /** Until the picture is that of the frame where the visitor is. */
    async seen(): Promise<void> {
        await this.page.waitForFunction(() => {
            const shown = document.querySelector<HTMLElement>(".stage")?.dataset["frame"];
            return document.querySelector(".where")?.textContent?.startsWith(`${Number(shown) + 1} / `);
        });
    }

    /** Drags on the picture, in pixels of the frame. */
    async drag(width: number, height: number, from: { x: number; y: number }, to: { x: number; y: number }): Promise<void> {
        await this.seen();
        const stage = await this.page.locator(".stage").boundingBox();
        if (stage === null) {
            throw new Error("there is no stage");
        }
        const scale = Math.min(stage.width / width, stage.height / height);
        const left = stage.x + (stage.width - width * scale) / 2;
        const top = stage.y + (stage.height - height * scale) / 2;
        const { mouse } = this.page;
        await mouse.move(left + from.x * scale, top + from.y * scale);
        await mouse.down();
        await mouse.move(left + ((from.x + to.x) / 2) * scale, top + ((from.y + to.y) / 2) * scale);
        await mouse.move(left + to.x * scale, top + to.y * scale);
        await mouse.up();
    }

    draw(width: number, height: number, box: Rect): Promise<void> {
        return this.drag(width, height, box, { x: box.x + box.w, y: box.y + box.h });
    }

    async where(): Promise<string> {
        return (await this.page.locator(".where").textContent()) ?? "";
    }

    /** Waits until nothing is being tracked any more. */
    async tracked(): Promise<string> {
        await this.settled();
        return (await this.page.locator(".progress").textContent()) ?? "";
    }

    async goTo(frame: number): Promise<void> {
        await this.press("g");
        await this.page.keyboard.type(String(frame + 1));
        await this.press("Enter");
        await this.page.waitForFunction((text) => document.querySelector(".where")?.textContent?.startsWith(text), `${frame + 1} / `);
    }

    /** Two pictures of the screen. */
    private frames(): Promise<unknown> {
        return this.page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    }

    /** Until nothing is being worked out; two pictures of the screen later it would show. */
    async settled(): Promise<void> {
        await this.frames();
        await this.page.waitForSelector('.workbench[aria-busy="false"]', { timeout: 300_000 });
    }

    /** What the export of this name gives. */
    async exported(title: string): Promise<{ name: string; bytes: Buffer }> {
        await this.press("Control+e");
        const [download] = await Promise.all([this.page.waitForEvent("download"), this.page.locator(".format").filter({ has: this.page.getByText(title, { exact: true }) }).click()]);
        return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
    }

    async csv(): Promise<string> {
        return String((await this.exported("CSV")).bytes);
    }

    async toast(): Promise<string> {
        await this.page.waitForSelector(".toast");
        return (await this.page.locator(".toast").textContent()) ?? "";
    }
}

/** Boxes of a CSV export by frame, counted from 0, of the object with this number. */
export function boxesOf(csv: string, object = 1): Map<number, Rect & { confidence: number; isKey: boolean }> {
    const boxes = new Map<number, Rect & { confidence: number; isKey: boolean }>();
    for (const line of csv.trim().split("\n").slice(1)) {
        // The last numbers of a row; names may hold commas.
        const cells = line.split(",");
        const [x = 0, y = 0, w = 0, h = 0, confidence = 0, key = 0] = cells.slice(-7, -1).map(Number);
        if (Number(cells[1]) === object) {
            boxes.set(Number(cells[0]) - 1, { x, y, w, h, confidence, isKey: key === 1 });
        }
    }
    return boxes;
}

export function overlap(a: Rect, b: Rect): number {
    const w = Math.min(a.x + a.w, b.x + b.w) - Math.max(a.x, b.x);
    const h = Math.min(a.y + a.h, b.y + b.h) - Math.max(a.y, b.y);
    const both = Math.max(0, w) * Math.max(0, h);
    return both / (a.w * a.h + b.w * b.h - both);
}
