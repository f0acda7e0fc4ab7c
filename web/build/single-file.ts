// Makes the page one file that works when it is opened from disk, where a browser loads neither modules nor workers nor WebAssembly
// beside it; and lets it speak to nobody: its content security policy allows what is inside the file and no connection.

import { createHash } from "node:crypto";
import type { Plugin } from "vite";

/** What the policy allows. `blob:` is what the page makes itself: its worker, pictures, downloads. */
function policy(scripts: readonly string[]): string {
    const hashes = scripts.map((text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`);
    return [
        "default-src 'none'",
        `script-src ${hashes.join(" ")} 'wasm-unsafe-eval'`,
        "worker-src blob:",
        "style-src 'unsafe-inline'",
        "img-src blob: data:",
        "connect-src 'none'",
        "form-action 'none'",
        "base-uri 'none'",
    ].join("; ");
}

export function singleFile(): Plugin {
    return {
        name: "single-file",
        apply: "build",
        enforce: "post",
        generateBundle(_, bundle) {
            const page = bundle["index.html"];
            if (page?.type !== "asset") {
                this.error("there is no index.html");
            }
            let html = String(page.source);
            const scripts: string[] = [];
            for (const [name, file] of Object.entries(bundle)) {
                const reference = name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
                if (file.type === "chunk") {
                    const code = file.code.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
                    scripts.push(`\n${code}`);
                    const tag = new RegExp(`<script type="module"[^>]*src="[^"]*${reference}"></script>`);
                    html = html.replace(tag, "").replace("</body>", () => `<script type="module">\n${code}</script></body>`);
                } else if (name.endsWith(".css")) {
                    const tag = new RegExp(`<link rel="stylesheet"[^>]*href="[^"]*${reference}">`);
                    html = html.replace(tag, () => `<style>${String(file.source)}</style>`);
                } else {
                    continue;
                }
                delete bundle[name];
            }
            const meta = `<meta http-equiv="Content-Security-Policy" content="${policy(scripts)}">`;
            page.source = html.replace("<head>", `<head>\n    ${meta}`);
        },
    };
}
