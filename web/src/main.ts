// Begins: the first page, and from there to a video and back.

import { engineCode } from "./engine/module.ts";
import { Engine } from "./engine/wasm.ts";
import { dropped, given, pick } from "./files/given.ts";
import { Library, type Work } from "./store/library.ts";
import "./ui/style.css";
import { restoreTheme, toggleTheme } from "./ui/theme.ts";
import { say } from "./ui/toast.ts";
import { welcome } from "./ui/welcome.ts";
import { Workbench } from "./ui/workbench.ts";
import { openSource } from "./video/open.ts";
import type { SourceSpec } from "./video/source.ts";
import { Workshop } from "./workshop.ts";

const page = document.querySelector<HTMLElement>("#app") ?? document.body;

let library: Library | null = null;
let bench: Workbench | null = null;

function fail(error: unknown): void {
    say(error instanceof Error ? error.message : String(error), true);
}

async function showWelcome(): Promise<void> {
    bench?.close();
    bench = null;
    document.title = "InfoPart: a box in every frame";
    const works = (await library?.works()) ?? [];
    page.replaceChildren(
        welcome(works, {
            pickVideo: () => void pick("video/*,.mkv,.ts,.mp4,.webm,.mov", false).then(take),
            pickFolder: () => void pick("image/*", true).then(take),
            demo: () => void open({ kind: "demo" }),
            resume: (work) => void resume(work),
            forget: (work) => void library?.forget(work.fingerprint).then(showWelcome, fail),
        }),
    );
}

async function open(spec: SourceSpec): Promise<void> {
    page.classList.add("opening");
    try {
        const code = engineCode();
        const workshop = await Workshop.open(code, spec, library, {
            changed: () => bench?.changed(),
            moved: (picture) => (bench === null ? picture?.close() : bench.moved(picture)),
            told: say,
            failed: fail,
        });
        const source = await openSource(spec, workshop.about, () => Engine.start(code));
        bench?.close();
        bench = new Workbench(workshop, source, () => void showWelcome().catch(fail));
        page.replaceChildren(bench.element);
        document.title = `${workshop.about.name} — InfoPart`;
        bench.start();
        const isKept = await library?.saveVideo(workshop.about.fingerprint, spec);
        if (isKept === false) {
            say("The browser has no room to keep this video. Your boxes are kept: after closing the page, drop the same video again.");
        }
    } catch (error) {
        fail(error);
    } finally {
        page.classList.remove("opening");
    }
}

async function resume(work: Work): Promise<void> {
    const spec = await library?.video(work.fingerprint);
    if (spec === undefined) {
        say(`${work.name} itself is not kept: drop it here again, and its boxes are there.`);
    } else {
        await open(spec);
    }
}

function take(files: readonly File[], folder = ""): void {
    const what = given(files, folder);
    if (what?.is === "source") {
        void open(what.spec);
    } else if (what?.is === "annotation") {
        if (bench === null) {
            say(`${what.file.name} is no video. Open the video first, then drop its annotation on it.`, true);
        } else {
            void bench.take(what.file);
        }
    }
}

addEventListener("dragover", (event) => {
    event.preventDefault();
    page.classList.add("dragging");
});
addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) {
        page.classList.remove("dragging");
    }
});
addEventListener("drop", (event) => {
    event.preventDefault();
    page.classList.remove("dragging");
    if (event.dataTransfer !== null) {
        void dropped(event.dataTransfer).then(({ files, folder }) => take(files, folder), fail);
    }
});
addEventListener("keydown", (event) => {
    if (bench !== null) {
        bench.press(event);
    } else if (event.key === "m" && !event.ctrlKey && !event.metaKey) {
        toggleTheme();
    }
});

restoreTheme();
try {
    library = await Library.open();
} catch {
    say("This browser keeps nothing here (a private window?): save a project file before you close the page.", true);
}
await showWelcome();
