// The clock of the replay: what time it shows, and whether and how fast that goes on.

export const speeds = [0.1, 0.25, 0.5, 1, 2, 4];

export class Player {
    time = 0;
    playing = false;
    speed = 1;
    loop = false;
    private readonly listeners: (() => void)[] = [];

    constructor(
        readonly step: number,
        readonly frames: number,
    ) {}

    get duration(): number {
        return Math.max(0, this.frames - 1) * this.step;
    }

    get frame(): number {
        return Math.min(Math.max(0, this.frames - 1), Math.floor(this.time / this.step + 1e-6));
    }

    onChange(listener: () => void) {
        this.listeners.push(listener);
    }

    private changed() {
        for (const listener of this.listeners) listener();
    }

    seek(time: number) {
        this.time = Math.min(this.duration, Math.max(0, Number.isFinite(time) ? time : 0));
        this.changed();
    }

    seekFrame(frame: number) {
        this.seek(frame * this.step);
    }

    /** To the next or an earlier frame; from between two frames, to the nearer end first. */
    stepFrames(count: number) {
        this.pause();
        const whole = Math.abs(this.time / this.step - Math.round(this.time / this.step)) < 1e-6;
        this.seekFrame(whole || count > 0 ? this.frame + count : this.frame + count + 1);
    }

    play() {
        if (this.time >= this.duration) this.time = 0;
        this.playing = this.frames > 1;
        this.changed();
    }

    pause() {
        this.playing = false;
        this.changed();
    }

    toggle() {
        if (this.playing) this.pause();
        else this.play();
    }

    setSpeed(speed: number) {
        this.speed = Math.min(speeds[speeds.length - 1], Math.max(speeds[0], speed));
        this.changed();
    }

    /** The next faster (+1) or slower (−1) of the speeds on offer. */
    shiftSpeed(direction: number) {
        const nearest = speeds.reduce((best, speed, i) =>
            Math.abs(speed - this.speed) < Math.abs(speeds[best] - this.speed) ? i : best, 0);
        this.setSpeed(speeds[Math.min(speeds.length - 1, Math.max(0, nearest + direction))]);
    }

    /** Lets `seconds` of real time pass. */
    advance(seconds: number) {
        if (!this.playing) return;
        // A page that was hidden or stuck for a while goes on from where it was.
        this.time += Math.min(seconds, 0.1) * this.speed;
        if (this.time >= this.duration) {
            if (this.loop && this.duration > 0) this.time %= this.duration;
            else {
                this.time = this.duration;
                this.playing = false;
            }
        }
        this.changed();
    }
}
