// node shoot.mjs [--size 1280x800] [--ratio 2] [--time 1.5] [--options "theme=dark&contacts"] [--out DIR] FILE.html…
// Takes a picture of each replay: DIR/FILE.png (or FILE-TIME.png for several times, "--time 1,2.5").
import { mkdir } from "node:fs/promises";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { parseArgs } from "node:util";
import { launch, openReplay } from "./browser.mjs";

const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: {
        size: { type: "string", default: "1280x800" },
        ratio: { type: "string", default: "1" },
        time: { type: "string", default: "0" },
        options: { type: "string", default: "" },
        out: { type: "string", default: "." },
    },
});
if (positionals.length === 0) throw new Error("which replay? node shoot.mjs FILE.html…");

const [width, height] = values.size.split("x").map(Number);
const times = values.time.split(",").map(Number);
await mkdir(values.out, { recursive: true });
const browser = await launch();
try {
    for (const file of positionals) {
        const url = `${pathToFileURL(resolve(file))}#quality=high&${values.options}`;
        const page = await openReplay(browser, url, { width, height, ratio: Number(values.ratio) });
        for (const time of times) {
            await page.evaluate((seconds) => window.caromReplay.seek(seconds), time);
            await page.waitForTimeout(400);
            const name = basename(file, ".html") + (times.length > 1 ? `-${time}` : "") + ".png";
            await page.screenshot({ path: join(values.out, name) });
            console.log(join(values.out, name));
        }
        await page.close();
    }
} finally {
    await browser.close();
}
