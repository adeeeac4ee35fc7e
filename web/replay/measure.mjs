// node measure.mjs FILE.html…: what a picture of each replay costs the processor, in milliseconds: to move
// everything (update), and to hand it to the graphics (draw), in the middle of 120 pictures. WebGL runs on a
// driver that draws nothing, so that in 3D the time of the graphics processor does not count; a canvas in 2D
// has no such driver, so that its drawing by software does.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launch, openReplay } from "./browser.mjs";

const browser = await launch("null");
try {
    for (const file of process.argv.slice(2)) {
        const page = await openReplay(browser, `${pathToFileURL(resolve(file))}#quality=high`);
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
