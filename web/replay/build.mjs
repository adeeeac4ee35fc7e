// node build.mjs [--out DIR]: bundles the viewer into one page, DIR/replay.html (DIR is dist by default).
// The page holds its script and its styles, and asks nothing of the network; the program fills in the
// recording at the markers in src/page.html.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({ options: { out: { type: "string", default: join(here, "dist") } } });

async function bundle(entry) {
    const result = await build({
        entryPoints: [join(here, "src", entry)],
        bundle: true,
        minify: true,
        write: false,
        charset: "ascii",
        format: "iife",
        target: "es2022",
        legalComments: "inline",
        logLevel: "warning",
    });
    return result.outputFiles[0].text;
}

const page = await readFile(join(here, "src", "page.html"), "utf8");
const parts = {
    "@styles@": await bundle("styles.css"),
    // A script element ends at the first "</script", wherever that stands.
    "@script@": (await bundle("main.ts")).replaceAll("</script", "<\\/script"),
};
const html = Object.entries(parts).reduce((text, [marker, part]) => text.replace(marker, () => part), page);

await mkdir(values.out, { recursive: true });
await writeFile(join(values.out, "replay.html"), html);
