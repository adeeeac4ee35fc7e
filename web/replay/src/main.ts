// Puts the page together: reads the recording, shows it, and lets time pass.

import { Contacts, readContacts, readHeader, readRecording } from "./decode";
import { button, element, setIcon, setPressed } from "./elements";
import { EnergyPlot } from "./energy";
import { fillHeading } from "./heading";
import { Inspector } from "./inspector";
import { bindKeys } from "./keys";
import { readOptions } from "./options";
import { Player } from "./player";
import { Recording } from "./recording";
import { Scene } from "./scene";
import { Scene2 } from "./scene2d";
import { Scene3 } from "./scene3d";
import { watchTaps } from "./taps";
import { ThemeSwitch } from "./theme";
import { Timeline } from "./timeline";

const byId = (id: string) => document.getElementById(id)!;

class Page {
    readonly player: Player;
    private readonly scene: Scene;
    private readonly inspector: Inspector;
    private readonly plot: EnergyPlot;
    private readonly theme: ThemeSwitch;
    private readonly options = readOptions(location.hash);
    private readonly contactsButton: HTMLButtonElement;
    private readonly themeButton: HTMLButtonElement;
    private readonly panelButton: HTMLButtonElement;
    private contacts: Promise<Contacts> | null = null;
    private contactsShown = false;
    private contactsDrawn = 0;
    private stale = true;
    private drawn = 0;
    private selected = -1;
    private following = false;
    private lastTick = 0;

    constructor(
        readonly recording: Recording,
        private readonly decodeMs: number,
    ) {
        const { header } = recording;
        document.title = header.name ? `${header.name} · Carom replay` : "Carom replay";
        this.player = new Player(header.step, header.frames);
        this.player.speed = this.options.speed;
        this.scene = recording.dimension === 2 ? new Scene2(recording) : new Scene3(recording, this.options.quality);
        this.scene.onChange = () => (this.stale = true);
        byId("stage").append(this.scene.element);
        fillHeading(byId("heading"), recording);
        this.plot = new EnergyPlot(recording);
        new Timeline(byId("dock"), this.player, this.plot);
        this.inspector = new Inspector(byId("panel"), recording, (body) => this.select(body),
            () => this.follow(!this.following), () => this.showPanel(false));
        this.contactsButton = button("contacts", "Contacts (C)", () => this.showContacts(!this.contactsShown));
        this.themeButton = button("sun", "", () => this.theme.toggle());
        this.panelButton = button("list", "Bodies (B)", () => this.showPanel(!this.panelShown));
        byId("tools").append(this.contactsButton, button("fit", "Whole view (V)", () => this.fit()), this.themeButton, this.panelButton);
        this.theme = new ThemeSwitch(this.options.theme, (theme) => {
            this.scene.setTheme(theme);
            this.plot.setTheme(theme);
            setIcon(this.themeButton, theme.name === "dark" ? "sun" : "moon", theme.name === "dark" ? "Light (T)" : "Dark (T)");
            this.stale = true;
        });
        this.start();
    }

    private start() {
        document.body.classList.toggle("bare", !this.options.controls);
        this.theme.apply();
        this.player.onChange(() => (this.stale = true));
        this.player.seek(this.options.time);
        this.showPanel(this.options.panel ?? false);
        new ResizeObserver(() => this.resize()).observe(byId("stage"));
        new ResizeObserver(([dock]) => {
            document.body.style.setProperty("--dock", `${dock.borderBoxSize[0].blockSize}px`);
            this.scene.setInsets(this.insets());
            this.stale = true;
        }).observe(byId("dock"));
        this.resize();
        this.scene.setView(this.options.view);
        if (this.options.select !== null) this.select(this.recording.indexOf(this.options.select));
        if (this.options.follow) this.follow(true);
        if (this.options.contacts) this.showContacts(true);
        watchTaps(this.scene.element, (x, y) => this.select(this.scene.pick(x, y)));
        this.scene.element.addEventListener("dblclick", () => this.fit());
        bindKeys(this.player, {
            contacts: () => this.showContacts(!this.contactsShown),
            fit: () => this.fit(),
            theme: () => this.theme.toggle(),
            panel: () => this.showPanel(!this.panelShown),
            follow: () => this.follow(!this.following),
            deselect: () => this.select(-1),
        });
        if (this.options.play) this.player.play();
        requestAnimationFrame((now) => this.tick(now));
    }

    private tick(now: number) {
        requestAnimationFrame((next) => this.tick(next));
        if (this.lastTick > 0) this.player.advance((now - this.lastTick) / 1000);
        this.lastTick = now;
        if (this.scene.tick()) this.stale = true;
        if (this.stale) this.draw();
    }

    /** Returns the milliseconds that it took to move everything, and to draw it. */
    draw() {
        this.stale = false;
        const { time } = this.player;
        const begin = performance.now();
        this.scene.update(time);
        const updated = performance.now();
        this.scene.draw();
        this.plot.draw(time);
        this.inspector.update(time);
        ++this.drawn;
        return { update: updated - begin, draw: performance.now() - updated };
    }

    private resize() {
        const { width, height } = byId("stage").getBoundingClientRect();
        this.scene.resize(width, height, devicePixelRatio);
        this.scene.setInsets(this.insets());
        this.draw();
    }

    /** What heading, panel and dock cover of the stage. */
    private insets() {
        if (!this.options.controls) return { left: 0, right: 0, top: 0, bottom: 0 };
        const narrow = innerWidth < 720;
        const dock = byId("dock").getBoundingClientRect();
        const panel = byId("panel").getBoundingClientRect();
        const stage = byId("stage").getBoundingClientRect();
        return {
            left: 0,
            right: this.panelShown && !narrow ? innerWidth - panel.left : 0,
            top: narrow ? byId("heading").getBoundingClientRect().bottom : 40,
            bottom: Math.max(0, stage.bottom - dock.top),
        };
    }

    private get panelShown(): boolean {
        return !byId("panel").hidden;
    }

    private showPanel(on: boolean) {
        byId("panel").hidden = !on;
        setPressed(this.panelButton, on);
        this.scene.setInsets(this.insets());
        this.stale = true;
    }

    private fit() {
        this.follow(false);
        this.scene.fit();
        this.stale = true;
    }

    select(body: number) {
        this.selected = body;
        if (body < 0) this.follow(false);
        this.scene.select(body);
        this.inspector.select(body);
        if (body >= 0 && this.options.panel !== false && innerWidth >= 720) this.showPanel(true);
        this.stale = true;
    }

    follow(on: boolean) {
        this.following = on && this.selected >= 0;
        this.scene.follow(this.following);
        this.inspector.setFollowing(this.following);
        this.stale = true;
    }

    async showContacts(on: boolean) {
        this.contactsShown = on;
        setPressed(this.contactsButton, on);
        if (on) this.contacts ??= readContacts(this.recording);
        const contacts = on ? await this.contacts : null;
        if (this.contactsShown !== on) return; // toggled again meanwhile
        this.scene.setContacts(contacts);
        this.contactsDrawn = contacts?.a.length ?? 0;
        this.stale = true;
    }

    /** What tests and pictures need to know and do. */
    api() {
        return {
            frame: () => this.player.frame,
            time: () => this.player.time,
            frames: () => this.player.frames,
            playing: () => this.player.playing,
            play: () => this.player.play(),
            pause: () => this.player.pause(),
            seek: (time: number) => this.player.seek(time),
            seekFrame: (frame: number) => this.player.seekFrame(frame),
            setSpeed: (speed: number) => this.player.setSpeed(speed),
            select: (name: string | null) => this.select(name === null ? -1 : this.recording.indexOf(name)),
            selected: () => (this.selected < 0 ? null : this.recording.label(this.selected)),
            state: (name: string) => this.recording.state(this.recording.indexOf(name), this.player.time),
            body: (name: string) => this.recording.bodies[this.recording.indexOf(name)],
            pick: (x: number, y: number) => {
                const body = this.scene.pick(x, y);
                return body < 0 ? null : this.recording.label(body);
            },
            contacts: (on: boolean) => this.showContacts(on),
            draw: () => this.draw(),
            stats: () => ({
                bodies: this.recording.bodies.length,
                frames: this.player.frames,
                drawn: this.drawn,
                decodeMs: this.decodeMs,
                contacts: this.contactsDrawn,
                ...this.scene.cost(),
            }),
        };
    }
}

declare global {
    interface Window {
        caromReplay?: ReturnType<Page["api"]>;
    }
}

async function open() {
    const begin = performance.now();
    const recording = await readRecording(readHeader());
    const page = new Page(recording, performance.now() - begin);
    window.caromReplay = page.api();
}

open().catch((error: unknown) => {
    byId("notice").append(element("b", {}, "This replay cannot be shown. "), error instanceof Error ? error.message : String(error));
    throw error;
});
