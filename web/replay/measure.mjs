// node measure.mjs FILE.html…: what a picture of each replay costs the processor, in milliseconds: to move
// everything (update), and to hand it to the graphics (draw), in the middle of 120 pictures. WebGL's own draw
// calls are left out, so that the time of a graphics processor, or of software in its place, does not count.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launch, openReplay } from "./browser.mjs";

/** Runs in the page, before its own script. */
function leaveOutDrawCalls() {
    const contexts = WebGL2RenderingContext.prototype;
    for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced"])
        contexts[name] = () => {};
    const { getExtension } = contexts;
    contexts.getExtension = function (name) {
        const extension = getExtension.call(this, name);
        if (name === "WEBGL_multi_draw" && extension) extension.multiDrawArraysWEBGL = () => {};
        return extension;
    };
}

const browser = await launch();
try {
    for (const file of process.argv.slice(2)) {
        const url = `${pathToFileURL(resolve(file))}#quality=high`;
        const page = await openReplay(browser, url, { prepare: leaveOutDrawCalls });
        const cost = await page.evaluate(async () => {
            const { caromReplay } = window;
            const samples = { update: [], draw: [] };
            for (let i = 0; i < 120; ++i) {
                caromReplay.seekFrame((caromReplay.frames() * (i + 0.5)) / 120);
                await new Promise((done) => requestAnimationFrame(done));
                const { update, draw } = caromReplay.draw();
                samples.update.push(update);
                samples.draw.push(draw);
            }
            const middle = (values) => values.sort((a, b) => a - b)[values.length >> 1].toFixed(2);
            return { update: middle(samples.update), draw: middle(samples.draw), ...caromReplay.stats() };
        });
        console.log(file, cost);
        await page.close();
    }
} finally {
    await browser.close();
}
