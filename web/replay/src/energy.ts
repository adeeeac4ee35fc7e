// The energy of the world over time, under the timeline and on the same axis.

import { element } from "./elements";
import { cssColor } from "./materials";
import { withPrefix } from "./numbers";
import { Recording } from "./recording";
import { Theme } from "./theme";

interface Series {
    name: "kinetic" | "potential" | "total";
    values: number[];
    /** What is drawn as nothing: height has no natural zero, so its energy is drawn from its least. */
    floor: number;
}

export class EnergyPlot {
    readonly element = element("div", { className: "energy" });
    private readonly canvas = element("canvas");
    private readonly readings: HTMLElement[];
    private readonly series: Series[];
    private readonly high: number;
    /** The curves, drawn once; the cursor is drawn over them. */
    private readonly curves = document.createElement("canvas");
    private stale = true;
    private theme!: Theme;
    private time = 0;
    private width = 0;
    private height = 0;

    constructor(private readonly recording: Recording) {
        const { kinetic, potential } = recording.header.energy;
        const floor = potential.reduce((least, value) => Math.min(least, value), potential[0] ?? 0);
        this.series = [
            { name: "potential", values: potential, floor },
            { name: "kinetic", values: kinetic, floor: 0 },
            { name: "total", values: kinetic.map((value, i) => value + potential[i]), floor },
        ];
        this.high = this.series[2].values.reduce((most, value) => Math.max(most, value - floor), 1e-9);
        const rows = [...this.series].reverse().map(({ name }) => {
            const value = element("b");
            return { row: element("span", { className: name }, element("i"), name, value), value };
        });
        this.readings = rows.map(({ value }) => value).reverse();
        this.element.append(this.canvas, element("div", { className: "readings" }, ...rows.map(({ row }) => row)));
        new ResizeObserver(([{ contentRect }]) => {
            this.width = contentRect.width;
            this.height = contentRect.height;
            this.stale = true;
            this.draw(this.time);
        }).observe(this.canvas);
    }

    setTheme(theme: Theme) {
        this.theme = theme;
        this.stale = true;
    }

    draw(time: number) {
        this.time = time;
        if (this.width === 0) return;
        const ratio = devicePixelRatio;
        const [width, height] = [Math.round(this.width * ratio), Math.round(this.height * ratio)];
        if (this.stale || this.canvas.width !== width) {
            for (const canvas of [this.canvas, this.curves]) Object.assign(canvas, { width, height });
            this.drawCurves(width, height, ratio);
            this.stale = false;
        }
        const context = this.canvas.getContext("2d")!;
        context.clearRect(0, 0, width, height);
        context.drawImage(this.curves, 0, 0);
        this.drawCursor(context, width, height, ratio);
    }

    private drawCurves(width: number, height: number, ratio: number) {
        const context = this.curves.getContext("2d")!;
        context.clearRect(0, 0, width, height);
        for (const { name, values, floor } of this.series) {
            const path = this.curve(values, floor, width, height, ratio);
            context.lineJoin = "round";
            context.lineWidth = (name === "total" ? 1.25 : 1.75) * ratio;
            context.strokeStyle = this.color(name);
            if (name !== "total") {
                const area = new Path2D(path);
                const zero = this.heightOf(0, height, ratio);
                area.lineTo(width, zero);
                area.lineTo(0, zero);
                context.fillStyle = this.color(name, 0.13);
                context.fill(area);
            }
            context.setLineDash(name === "total" ? [3 * ratio, 3 * ratio] : []);
            context.stroke(path);
        }
    }

    private color(name: Series["name"], alpha = 1): string {
        const { kinetic, potential, text } = this.theme;
        return cssColor(name === "kinetic" ? kinetic : name === "potential" ? potential : text, name === "total" ? 0.65 : alpha);
    }

    private heightOf(value: number, height: number, ratio: number): number {
        const margin = 3 * ratio;
        return height - margin - (value / this.high) * (height - 2 * margin);
    }

    /** At most one point a pixel column's least and greatest value, so that no peak is lost. */
    private curve(values: number[], floor: number, width: number, height: number, ratio: number): Path2D {
        const path = new Path2D();
        const last = Math.max(1, values.length - 1);
        const perColumn = Math.max(1, Math.floor(values.length / width));
        for (let i = 0; i < values.length; i += perColumn) {
            const part = values.slice(i, i + perColumn);
            const ends = perColumn === 1 ? part : [Math.min(...part), Math.max(...part)];
            for (const value of ends) path.lineTo((i / last) * width, this.heightOf(value - floor, height, ratio));
        }
        return path;
    }

    private drawCursor(context: CanvasRenderingContext2D, width: number, height: number, ratio: number) {
        const { duration } = this.recording;
        const frame = this.recording.frameAt(this.time);
        const x = duration > 0 ? (this.time / duration) * width : 0;
        context.fillStyle = cssColor(this.theme.text, 0.5);
        context.fillRect(Math.min(width - ratio, Math.max(0, x - ratio / 2)), 0, ratio, height);
        this.series.forEach(({ name, values, floor }, i) => {
            if (values.length === 0) return;
            context.fillStyle = this.color(name);
            context.beginPath();
            context.arc(x, this.heightOf(values[frame] - floor, height, ratio), 2.6 * ratio, 0, 2 * Math.PI);
            context.fill();
            this.readings[i].textContent = withPrefix(values[frame], "J");
        });
    }
}
