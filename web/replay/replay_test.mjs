// Plays replays in a browser without a window and looks at what happens. Replays are written by the program
// that CAROM_SAMPLE_WRITER names (the C++ tests of replays) and by CAROM_PROGRAM (carom) if it is given.
// node --test replay_test.mjs
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { deflateSync } from "node:zlib";
import pngjs from "pngjs";
import { launch, openReplay } from "./browser.mjs";

const folder = mkdtempSync(join(tmpdir(), "carom-replay-"));
const writer = resolve(process.env.CAROM_SAMPLE_WRITER ?? "../tests/test_replay");
let browser;

before(async () => {
    assert.ok(existsSync(writer), `${writer} writes the samples, but it is not there: build test_replay`);
    execFileSync(writer, ["--gtest_filter=ReplaySamples.*"], { env: { ...process.env, CAROM_SAMPLES: folder }, stdio: "pipe" });
    browser = await launch();
});

after(async () => {
    await browser?.close();
    rmSync(folder, { recursive: true, force: true });
});

const fileOf = (name) => join(folder, `${name}.html`);

/** Opens a replay, hands its page over, and sees that the page made no error and asked for nothing else. */
async function withReplay(file, options, size, work) {
    const page = await openReplay(browser, `${pathToFileURL(file)}#${options}`, size);
    try {
        await work(page);
        assert.deepEqual(page.errors, []);
        assert.equal(page.requests.filter((url) => /^(https?|wss?):/.test(url)).length, 0, "the network was asked");
    } finally {
        await page.close();
    }
}

const replay = (page, expression) => page.evaluate(`window.caromReplay.${expression}`);
const small = { width: 760, height: 560 };

async function picture(page) {
    await page.waitForTimeout(150);
    return pngjs.PNG.sync.read(await page.screenshot());
}

/** How many different colours a part of a picture has, each counted that covers more than a few pixels. */
function colors(png, left = 0, top = 0, right = 1, bottom = 1) {
    const counts = new Map();
    for (let y = Math.floor(png.height * top); y < png.height * bottom; ++y)
        for (let x = Math.floor(png.width * left); x < png.width * right; ++x) {
            const at = 4 * (y * png.width + x);
            const color = ((png.data[at] >> 3) << 10) | ((png.data[at + 1] >> 3) << 5) | (png.data[at + 2] >> 3);
            counts.set(color, (counts.get(color) ?? 0) + 1);
        }
    return [...counts.values()].filter((count) => count > 8).length;
}

function differentPixels(a, b) {
    let count = 0;
    for (let i = 0; i < a.data.length; i += 4)
        if (a.data[i] !== b.data[i] || a.data[i + 1] !== b.data[i + 1] || a.data[i + 2] !== b.data[i + 2]) ++count;
    return count;
}

/** A place in the picture where there is a body that can move, and its name. */
function findBody(page) {
    return page.evaluate(() => {
        for (let y = innerHeight * 0.25; y < innerHeight * 0.6; y += 6)
            for (let x = innerWidth * 0.2; x < innerWidth * 0.8; x += 6) {
                const name = window.caromReplay.pick(x, y);
                if (name !== null && window.caromReplay.body(name).type === "dynamic") return { x, y, name };
            }
        return null;
    });
}

for (const dimension of [2, 3]) {
    const sample = fileOf(`sample${dimension}`);

    test(`${dimension}D: shows what was recorded`, () => withReplay(sample, "controls=off&t=1.5", small, async (page) => {
        const stats = await replay(page, "stats()");
        assert.equal(stats.frames, 300);
        assert.equal(stats.bodies, dimension === 2 ? 45 : 65);
        assert.equal(await replay(page, "frame()"), 90);
        assert.match(await page.title(), /^Toy box/);
        // The samples' lift goes up and down by a sine.
        for (const frame of [0, 100, 299]) {
            await replay(page, `seekFrame(${frame})`);
            const lift = await replay(page, `state("lift")`);
            assert.ok(Math.abs(lift.position[1] - (7 + Math.sin(frame / 60))) < 1e-4);
            assert.ok(Math.abs(lift.velocity[1] - Math.cos(frame / 60)) < 1e-3);
        }
        await replay(page, "seek(1.5)");
        const start = await picture(page);
        assert.ok(colors(start) > 25, `${colors(start)} colours`);
        await replay(page, "seek(0.3)");
        assert.ok(differentPixels(start, await picture(page)) > 2000, "the picture does not change with time");
    }));

    test(`${dimension}D: plays and pauses`, () => withReplay(sample, "", small, async (page) => {
        assert.equal(await replay(page, "playing()"), false);
        await page.keyboard.press("Space");
        await page.waitForFunction(() => window.caromReplay.frame() > 5);
        await page.keyboard.press("Space");
        const frame = await replay(page, "frame()");
        assert.equal(await replay(page, "playing()"), false);
        await page.waitForTimeout(300);
        assert.equal(await replay(page, "frame()"), frame);
        await page.getByRole("button", { name: "4" }).click();
        await page.getByRole("button", { name: /^Play/ }).click();
        await page.waitForFunction(() => !window.caromReplay.playing());
        assert.equal(await replay(page, "frame()"), 299, "it stops at the end");
    }));

    test(`${dimension}D: goes where one drags and steps`, () => withReplay(sample, "", small, async (page) => {
        const track = await page.getByRole("slider", { name: "Time" }).boundingBox();
        const middle = track.y + track.height / 2;
        await page.mouse.move(track.x + track.width / 4, middle);
        await page.mouse.down();
        assert.ok(Math.abs((await replay(page, "frame()")) - 75) <= 1);
        await page.mouse.move(track.x + track.width / 2, middle, { steps: 4 });
        await page.mouse.up();
        assert.ok(Math.abs((await replay(page, "frame()")) - 150) <= 1);
        await page.mouse.click(track.x + track.width * 0.75, middle + 40); // the plot has the same axis
        assert.ok(Math.abs((await replay(page, "frame()")) - 224) <= 1);
        const keys = [["Home", 0], ["ArrowRight", 1], ["ArrowRight", 2], ["ArrowLeft", 1], ["Shift+ArrowRight", 11], ["End", 299]];
        for (const [key, frame] of keys) {
            await page.keyboard.press(key);
            assert.equal(await replay(page, "frame()"), frame, key);
        }
    }));

    test(`${dimension}D: tells about the body that one clicks`, () => withReplay(sample, "t=2", { width: 1100, height: 720 }, async (page) => {
        const found = await findBody(page);
        assert.ok(found, "nothing to pick in the picture");
        const plain = await picture(page);
        await page.mouse.click(found.x, found.y);
        assert.equal(await replay(page, "selected()"), found.name);
        const facts = page.locator(".facts");
        assert.equal(await facts.locator("h2").textContent(), found.name);
        assert.match(await facts.textContent(), /Speed.*m\/s.*Kinetic energy.*J/);
        assert.ok(differentPixels(plain, await picture(page)) > 500, "it is not highlighted");
        await page.keyboard.press("Escape");
        assert.equal(await replay(page, "selected()"), null);
        await page.getByRole("option", { name: "lift" }).click();
        assert.equal(await replay(page, "selected()"), "lift");
        const shown = () => facts.locator("dl", { hasText: "Position" }).textContent();
        const before = await shown();
        await replay(page, "seek(3)");
        await page.waitForFunction((text) => ![...document.querySelectorAll(".facts dl")].some((row) => row.textContent === text), before);
        await page.getByRole("button", { name: /^Follow/ }).click();
        const moved = await picture(page);
        await replay(page, "seek(1)");
        assert.ok(differentPixels(moved, await picture(page)) > 2000, "the view does not follow");
    }));

    test(`${dimension}D: shows contacts and themes on demand`, () => withReplay(sample, "t=1.2&theme=dark", small, async (page) => {
        const dark = await picture(page);
        await page.keyboard.press("c");
        await page.waitForFunction(() => window.caromReplay.stats().contacts > 0);
        const contacts = await picture(page);
        assert.ok(differentPixels(dark, contacts) > 300, "no contacts are drawn");
        await page.keyboard.press("c");
        await page.waitForFunction(() => window.caromReplay.stats().contacts === 0);
        assert.ok(differentPixels(contacts, await picture(page)) > 300, "contacts do not go away");
        await page.keyboard.press("t");
        assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "light");
        const mean = (png) => png.data.reduce((sum, value) => sum + value, 0) / png.data.length;
        assert.ok(mean(await picture(page)) > mean(dark) + 40, "light is not lighter");
    }));

    test(`${dimension}D: names stay text`, () => withReplay(sample, "", small, async (page) => {
        await page.keyboard.press("b");
        const name = "ball </script><b>\"\u00e9\" \ufffd";
        assert.equal(await page.getByRole("option", { name }).count(), 1);
        await page.getByRole("searchbox").fill("</SCRIPT>");
        assert.equal(await page.getByRole("option").count(), 1);
    }));

    test(`${dimension}D: fits a narrow window`, () => withReplay(sample, "t=1", { width: 380, height: 700, ratio: 2 }, async (page) => {
        for (const id of ["dock", "tools", "heading"]) {
            const box = await page.locator(`#${id}`).boundingBox();
            assert.ok(box.x >= 0 && box.x + box.width <= 380 && box.y >= 0 && box.y + box.height <= 700, id);
        }
        await page.keyboard.press("b");
        const panel = await page.locator("#panel").boundingBox();
        const dock = await page.locator("#dock").boundingBox();
        assert.ok(panel.y >= 0 && panel.y + panel.height <= dock.y, "the list covers the controls");
        const shot = await picture(page);
        assert.deepEqual([shot.width, shot.height], [760, 1400]);
        assert.ok(colors(shot, 0, 0.2, 1, 0.5) > 15);
    }));

    for (const key of ["sensor", "surface_velocity", "one_way"])
        test(`${dimension}D: shows which shape has a ${key}`, async () => {
            const without = fileOf(`${key}${dimension}`);
            const whole = readFileSync(sample, "utf8");
            const [start, header] = /id="carom-header">([^<]*)/.exec(whole);
            const changed = JSON.parse(header);
            for (const { shapes } of changed.bodies) for (const shape of shapes) delete shape[key];
            assert.notEqual(JSON.stringify(changed), JSON.stringify(JSON.parse(header)));
            const safe = JSON.stringify(changed).replaceAll("<", "\\u003c"); // names may hold the end of a script
            writeFileSync(without, whole.replace(start, () => `id="carom-header">${safe}`));
            const pictures = [];
            for (const file of [sample, without])
                await withReplay(file, "t=1&controls=off", small, async (page) => pictures.push(await picture(page)));
            assert.ok(differentPixels(...pictures) > 40, `${differentPixels(...pictures)} pixels tell it`);
        });

    test(`${dimension}D: a sensor lights up while something is in it`, () => withReplay(sample, "controls=off", small, async (page) => {
        // The samples' lift carries one that is full in the second half of every hundred frames.
        for (const [frame, full] of [[49, false], [50, true], [99, true], [100, false]]) {
            await replay(page, `seekFrame(${frame})`);
            assert.equal((await replay(page, `state("lift")`)).sensing, full, `frame ${frame}`);
        }
    }));

    test(`${dimension}D: a thousand bodies`, () => withReplay(fileOf(`large${dimension}`), "t=3&controls=off", small, async (page) => {
        const stats = await replay(page, "stats()");
        assert.deepEqual([stats.bodies, stats.frames], [1001, 600]);
        if (dimension === 3) assert.ok(stats.calls < 40, `${stats.calls} draw calls`);
        assert.ok(colors(await picture(page)) > 25);
    }));
}

test("a link sets the page up", () => withReplay(fileOf("sample2"), "t=1&select=lift&theme=light&speed=2&contacts&play", small, async (page) => {
    assert.equal(await replay(page, "selected()"), "lift");
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "light");
    await page.waitForFunction(() => window.caromReplay.stats().contacts > 0 && window.caromReplay.time() > 1.2);
}));

for (const dimension of [2, 3])
    test(`${dimension}D: an empty world is shown`, async () => {
        const empty = fileOf(`empty${dimension}`);
        const whole = readFileSync(fileOf(`sample${dimension}`), "utf8");
        const [start, header] = /id="carom-header">([^<]*)/.exec(whole);
        const changed = JSON.parse(header);
        Object.assign(changed, { frames: 0, bodies: [], links: [], energy: { kinetic: [], potential: [] } });
        changed.contacts.total = 0;
        const nothing = deflateSync(Buffer.alloc(0)).toString("base64");
        writeFileSync(empty, whole
            .replace(start, () => `id="carom-header">${JSON.stringify(changed)}`)
            .replace(/(id="carom-(motion|contacts)">)[^<]*/g, `$1${nothing}`));
        await withReplay(empty, "contacts&play", small, async (page) => {
            assert.equal(await replay(page, "frame()"), 0);
            assert.ok((await picture(page)).width > 0);
        });
    });

test("a broken file says so", async () => {
    const broken = fileOf("broken");
    const whole = readFileSync(fileOf("sample2"), "utf8");
    writeFileSync(broken, whole.replace(/(id="carom-motion">[^<]{200})[^<]*/, "$1"));
    const page = await browser.newPage();
    await page.goto(String(pathToFileURL(broken)));
    await page.locator("#notice", { hasText: "cannot be shown" }).waitFor();
    await page.close();
});

if (process.env.CAROM_PROGRAM) {
    const scenes = resolve(process.env.CAROM_SCENES ?? "../../../scenes");
    for (const scene of ["2d/lunar_lander", "3d/half_life"])
        test(`carom's own replay of ${scene}`, async () => {
            const file = fileOf(scene.replace("/", "-"));
            execFileSync(resolve(process.env.CAROM_PROGRAM),
                ["run", join(scenes, `${scene}.json`), "--steps", "120", "--quiet", "--replay", file], { stdio: "pipe" });
            assert.ok(statSync(file).size < 15e6);
            await withReplay(file, "t=1&controls=off", small, async (page) => {
                assert.equal(await replay(page, "frames()"), 121);
                assert.ok(colors(await picture(page)) > 12, "the picture is blank");
            });
        });
}
