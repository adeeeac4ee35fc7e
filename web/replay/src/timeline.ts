// The controls at the bottom: play, step, speed, and the line along which one drags through time.

import { button, element, setIcon, setPressed } from "./elements";
import { EnergyPlot } from "./energy";
import { Player, speeds } from "./player";

export class Timeline {
    private readonly playButton: HTMLButtonElement;
    private readonly loopButton: HTMLButtonElement;
    private readonly clock = element("span", { className: "clock" });
    private readonly frame = element("span", { className: "frame" });
    private readonly track = element("div", { className: "track", tabIndex: 0 });
    private readonly speedButtons: HTMLButtonElement[];

    constructor(
        dock: HTMLElement,
        private readonly player: Player,
        plot: EnergyPlot,
    ) {
        this.playButton = button("play", "Play (space)", () => player.toggle());
        this.playButton.classList.add("primary");
        this.loopButton = button("loop", "Repeat (L)", () => {
            player.loop = !player.loop;
            this.update();
        });
        this.speedButtons = speeds.map((speed) => {
            const made = element("button", { type: "button", onclick: () => player.setSpeed(speed) }, `${speed}×`);
            made.setAttribute("aria-label", `Speed ${speed}`);
            return made;
        });
        this.track.setAttribute("role", "slider");
        this.track.setAttribute("aria-label", "Time");
        this.track.append(element("div", { className: "rail" }, element("div", { className: "done" })), element("div", { className: "knob" }));
        const scrubbed = element("div", { className: "scrub" }, this.track, plot.element);
        this.watchDrags(scrubbed);
        dock.append(
            element("div", { className: "transport" },
                element("div", { className: "buttons" },
                    button("back", "One frame back (\u2190)", () => player.stepFrames(-1)),
                    this.playButton,
                    button("forward", "One frame on (\u2192)", () => player.stepFrames(1)),
                    this.loopButton),
                element("div", { className: "when" }, this.clock, this.frame),
                element("div", { className: "speeds", role: "group" }, ...this.speedButtons)),
            scrubbed,
        );
        player.onChange(() => this.update());
        this.update();
    }

    private watchDrags(scrubbed: HTMLElement) {
        let wasPlaying = false;
        const seek = (event: PointerEvent) => {
            const box = this.track.getBoundingClientRect();
            this.player.seek(((event.clientX - box.left) / box.width) * this.player.duration);
        };
        scrubbed.addEventListener("pointerdown", (event) => {
            if (event.button !== 0) return;
            scrubbed.setPointerCapture(event.pointerId);
            wasPlaying = this.player.playing;
            this.player.pause();
            seek(event);
        });
        scrubbed.addEventListener("pointermove", (event) => {
            if (scrubbed.hasPointerCapture(event.pointerId)) seek(event);
        });
        scrubbed.addEventListener("lostpointercapture", () => {
            if (wasPlaying && this.player.time < this.player.duration) this.player.play();
            wasPlaying = false;
        });
    }

    private update() {
        const { player } = this;
        const digits = player.step < 0.01 ? 3 : 2;
        setIcon(this.playButton, player.playing ? "pause" : "play", player.playing ? "Pause (space)" : "Play (space)");
        setPressed(this.loopButton, player.loop);
        this.clock.textContent = `${player.time.toFixed(digits)} / ${player.duration.toFixed(digits)} s`;
        this.frame.textContent = `frame ${player.frame} of ${Math.max(0, player.frames - 1)}`;
        const share = player.duration > 0 ? player.time / player.duration : 0;
        this.track.style.setProperty("--share", String(share));
        this.track.setAttribute("aria-valuemin", "0");
        this.track.setAttribute("aria-valuemax", player.duration.toFixed(digits));
        this.track.setAttribute("aria-valuenow", player.time.toFixed(digits));
        this.speedButtons.forEach((made, i) => setPressed(made, speeds[i] === player.speed));
    }
}
