// A browser without a window, for tests and pictures. It uses the Chromium of the system (or the program
// that CHROMIUM names), with software rendering, and a profile of its own.
import { access } from "node:fs/promises";
import { chromium } from "playwright-core";

export const program = process.env.CHROMIUM ?? "/usr/bin/chromium";

export async function launch() {
    await access(program).catch(() => {
        throw new Error(`no browser at ${program}: install Debian's package chromium, or let CHROMIUM name one`);
    });
    return chromium.launch({
        executablePath: program,
        headless: true,
        args: [
            "--no-sandbox",
            "--disable-gpu",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ],
    });
}

/** Opens a replay, once its page has read it. Throws when anything goes wrong on the page. */
export async function openReplay(browser, url, { width = 1280, height = 800, ratio = 1, prepare } = {}) {
    const page = await browser.newPage({ viewport: { width, height }, deviceScaleFactor: ratio });
    if (prepare) await page.addInitScript(prepare);
    page.errors = [];
    page.requests = [];
    page.on("pageerror", (error) => page.errors.push(String(error)));
    page.on("console", (message) => message.type() === "error" && page.errors.push(message.text()));
    page.on("request", (request) => page.requests.push(request.url()));
    await page.goto(url);
    try {
        await page.waitForFunction(() => window.caromReplay, null, { timeout: 60_000 });
    } catch (error) {
        throw new Error([String(error), ...page.errors].join("\n"));
    }
    return page;
}
