// The plane, drawn on a canvas: every line as sharp as the screen allows, at any zoom.

import { Camera2 } from "./camera2d";
import { Contacts, contactsOf } from "./decode";
import { Content, contentOf, reachOf } from "./framing";
import { cssColor, lookOf, materialOf, mix, stateColor } from "./materials";
import { Recording, Vector } from "./recording";
import { Insets, Scene } from "./scene";
import { Flow, flowOf } from "./flow2d";
import { DrawnShape, drawnShape } from "./shapes2d";
import { Theme } from "./theme";
import { drawBackdrop, drawScaleBar } from "./backdrop2d";
import { drawArrow, drawLink, drawName, drawPlane, drawTrail } from "./marks2d";

interface Style {
    fill: string;
    stroke: string;
    mark: string;
}

interface Item {
    body: number;
    shape: number;
    drawn: DrawnShape | null;
    flow: Flow | null;
    sensor: boolean;
    awake: Style;
    asleep: Style;
}

export class Scene2 implements Scene {
    readonly element = document.createElement("canvas");
    onChange = () => {};
    private readonly context = this.element.getContext("2d")!;
    private readonly camera = new Camera2(this.element, () => this.onChange());
    private readonly content: Content;
    private readonly items: Item[] = [];
    private readonly reaches: number[];
    private pixelRatio = 1;
    private theme!: Theme;
    private contacts: Contacts | null = null;
    private selected = -1;
    private following = false;
    private lastCenter: Vector | null = null;
    private time = 0;

    constructor(private readonly recording: Recording) {
        this.content = contentOf(recording);
        this.reaches = recording.bodies.map(reachOf);
        const grain = Math.hypot(...this.content.high.map((high, i) => high - this.content.low[i])) / 110;
        const none = { fill: "", stroke: "", mark: "" };
        recording.bodies.forEach((body, index) =>
            body.shapes.forEach((shape, i) =>
                this.items.push({
                    body: index, shape: i, drawn: drawnShape(body, shape, grain), flow: flowOf(body, shape),
                    sensor: !!shape.sensor, awake: none, asleep: none,
                })));
        // What is fixed lies behind what moves.
        const rank = (item: Item) => (recording.bodies[item.body].type === "fixed" ? 0 : 1);
        this.items.sort((a, b) => rank(a) - rank(b) || a.body - b.body);
    }

    setTheme(theme: Theme) {
        this.theme = theme;
        const edge = theme.name === "dark" ? ([1, 1, 1] as const) : ([0, 0, 0] as const);
        for (const item of this.items) {
            const { type } = this.recording.bodies[item.body];
            const { color } = lookOf(materialOf(this.recording, item.body, item.shape));
            const style = (asleep: boolean): Style => {
                const plain = stateColor(color, type, asleep, theme.neutral, item.body);
                const base = item.drawn?.hatches ? mix(plain, color, 0.4) : plain; // lines have less to show
                const line = mix(base, [...edge], theme.name === "dark" ? 0.28 : 0.34);
                return {
                    fill: cssColor(mix(base, theme.background, type === "fixed" ? 0.35 : 0.18), type === "fixed" ? 1 : 0.9),
                    stroke: cssColor(type === "fixed" ? mix(line, theme.background, 0.25) : line),
                    mark: cssColor(line, 0.8),
                };
            };
            item.awake = style(false);
            item.asleep = style(true);
        }
    }

    update(time: number) {
        this.time = time;
        this.recording.pose(time);
        const center = this.selected < 0 ? null : this.centerOf(this.selected);
        if (this.following && center && this.lastCenter) {
            this.camera.x += center[0] - this.lastCenter[0];
            this.camera.y += center[1] - this.lastCenter[1];
        }
        this.lastCenter = center;
    }

    private centerOf(body: number): Vector {
        const { centers } = this.recording.poses;
        return [centers[2 * body], centers[2 * body + 1]];
    }

    tick(): boolean {
        return false;
    }

    draw() {
        const { context, camera } = this;
        context.setTransform(this.pixelRatio, 0, 0, this.pixelRatio, 0, 0);
        drawBackdrop(context, camera, this.theme, this.pixelRatio);
        if (this.selected >= 0) drawTrail(context, camera, this.recording, this.selected, this.time, this.theme);
        this.drawShapes();
        context.setTransform(this.pixelRatio, 0, 0, this.pixelRatio, 0, 0);
        this.drawLinks();
        if (this.selected >= 0) this.drawSelected();
        if (this.contacts) this.drawContacts(this.contacts);
        drawScaleBar(context, camera, this.theme);
    }

    /** From metres in the frame of a body to the pixels of the canvas. */
    private enterBody(body: number) {
        const [x, y] = this.camera.toScreen(...(this.centerOf(body) as [number, number]));
        const angle = this.recording.poses.turns[body];
        const scale = this.camera.scale * this.pixelRatio;
        const cos = Math.cos(angle) * scale;
        const sin = Math.sin(angle) * scale;
        this.context.setTransform(cos, -sin, -sin, -cos, x * this.pixelRatio, y * this.pixelRatio);
    }

    private visible(body: number): boolean {
        if (!this.recording.poses.present[body]) return false;
        const [x, y] = this.camera.toScreen(...(this.centerOf(body) as [number, number]));
        const radius = this.reaches[body] * this.camera.scale + 4;
        return x > -radius && y > -radius && x < this.camera.width + radius && y < this.camera.height + radius;
    }

    private drawShapes() {
        const { context, camera, recording } = this;
        const { awake } = recording.poses;
        // Lines grow thinner where bodies are small on the screen.
        const line = Math.min(1.6, Math.max(0.5, camera.scale / 24)) / camera.scale;
        context.lineJoin = "round";
        context.lineCap = "round";
        const visible = this.items.filter(({ body }) => this.visible(body));
        const shown = visible.filter(({ sensor }) => !sensor);
        this.drawFixed(shown.filter(({ body }) => recording.bodies[body].type === "fixed"), line);
        for (const item of visible) if (item.sensor) this.drawSensor(item, line);
        for (const { body, drawn, flow, ...styles } of shown) {
            if (!drawn || recording.bodies[body].type === "fixed") continue;
            const style = awake[body] ? styles.awake : styles.asleep;
            this.enterBody(body);
            context.fillStyle = style.fill;
            context.strokeStyle = style.stroke;
            context.lineWidth = line;
            context.fill(drawn.outline);
            context.stroke(drawn.outline);
            if (flow) this.drawFlow(drawn, flow, style, line);
            if (!drawn.mark) continue;
            context.strokeStyle = style.mark;
            context.lineWidth = line * 1.4;
            context.stroke(drawn.mark);
        }
    }

    /** First all outlines, then all areas over their inner halves, a little grown: fixed shapes that touch
     *  look like one. */
    private drawFixed(items: Item[], line: number) {
        const { context, camera } = this;
        const overlap = 1 / camera.scale;
        for (const { body, shape, drawn, awake } of items) {
            context.strokeStyle = awake.stroke;
            context.fillStyle = awake.fill;
            if (drawn?.hatches) continue;
            if (drawn) {
                this.enterBody(body);
                context.lineWidth = 2 * line + overlap;
                context.stroke(drawn.outline);
            } else {
                context.setTransform(this.pixelRatio, 0, 0, this.pixelRatio, 0, 0);
                drawPlane(context, camera, this.recording, body, shape);
            }
        }
        context.lineWidth = overlap;
        for (const { body, drawn, flow, awake } of items) {
            if (!drawn) continue;
            this.enterBody(body);
            context.fillStyle = context.strokeStyle = awake.fill;
            context.lineWidth = overlap;
            context.fill(drawn.outline);
            if (drawn.hatches) {
                context.strokeStyle = awake.stroke;
                context.lineWidth = 2.4 * line;
                context.stroke(drawn.outline);
                context.lineWidth = line;
                context.stroke(drawn.hatches);
                continue;
            }
            context.stroke(drawn.outline);
            if (flow) this.drawFlow(drawn, flow, awake, line);
        }
    }

    /** What notices but does not touch lets everything shine through, and lights up while something is in it. */
    private drawSensor({ body, drawn }: Item, line: number) {
        if (!drawn) return;
        const { context, theme } = this;
        const color = this.recording.poses.sensing[body] ? theme.accent : theme.potential;
        this.enterBody(body);
        context.fillStyle = cssColor(color, this.recording.poses.sensing[body] ? 0.3 : 0.13);
        context.fill(drawn.outline);
        context.strokeStyle = cssColor(color, 0.8);
        context.lineWidth = line;
        context.setLineDash([4 * line, 4 * line]);
        context.stroke(drawn.outline);
        context.setLineDash([]);
    }

    private drawFlow(drawn: DrawnShape, flow: Flow, style: Style, line: number) {
        const { context } = this;
        context.save();
        context.clip(drawn.outline);
        context.strokeStyle = style.mark;
        context.lineWidth = Math.max(line, flow.width);
        context.stroke(flow.chevrons(this.time));
        context.restore();
    }

    private drawLinks() {
        const { context, camera, recording, theme } = this;
        for (const link of recording.header.links) {
            if (link.a >= 0 && !recording.poses.present[link.a]) continue;
            if (link.b >= 0 && !recording.poses.present[link.b]) continue;
            const from = camera.toScreen(...this.anchor(link.a, link.anchor_a));
            const to = camera.toScreen(...this.anchor(link.b, link.anchor_b));
            drawLink(context, link.type, from, to, cssColor(theme.line, 0.75));
        }
    }

    /** A point of a body, given in its own frame, in the world. */
    private anchor(body: number, local: Vector): [number, number] {
        if (body < 0) return [local[0], local[1]];
        const { center_of_mass } = this.recording.bodies[body];
        const angle = this.recording.poses.turns[body];
        const [x, y] = [local[0] - center_of_mass[0], local[1] - center_of_mass[1]];
        const center = this.centerOf(body);
        return [
            center[0] + x * Math.cos(angle) - y * Math.sin(angle),
            center[1] + x * Math.sin(angle) + y * Math.cos(angle),
        ];
    }

    private drawSelected() {
        const { context, camera, theme, recording, selected } = this;
        if (!recording.poses.present[selected]) return;
        for (const { body, drawn } of this.items) {
            if (body !== selected || !drawn) continue;
            this.enterBody(body);
            context.strokeStyle = cssColor(theme.accent, 0.28);
            context.lineWidth = 8 / camera.scale;
            context.stroke(drawn.outline);
            context.strokeStyle = cssColor(theme.accent);
            context.lineWidth = 2.2 / camera.scale;
            context.stroke(drawn.outline);
        }
        context.setTransform(this.pixelRatio, 0, 0, this.pixelRatio, 0, 0);
        const center = camera.toScreen(...(this.centerOf(selected) as [number, number]));
        const { velocity } = recording.state(selected, this.time);
        const shown = 0.25 * camera.scale; // the way of a quarter of a second
        if (Math.hypot(...velocity) * shown > 6)
            drawArrow(context, center, [velocity[0] * shown, -velocity[1] * shown], cssColor(theme.accent), 2);
        const above = Math.min(this.reaches[selected] * camera.scale, camera.height);
        drawName(context, recording.label(selected), [center[0], center[1] - above - 12], theme);
    }

    private drawContacts(contacts: Contacts) {
        const { context, camera, recording, theme } = this;
        const [begin, end] = contactsOf(contacts, recording.frameAt(this.time));
        const color = cssColor(theme.contact);
        for (let i = begin; i < end; ++i) {
            const [x, y] = camera.toScreen(contacts.positions[2 * i], contacts.positions[2 * i + 1]);
            if (x < 0 || y < 0 || x > camera.width || y > camera.height) continue;
            // The normal points from a to b; what is drawn is the push on the one that can move.
            const side = recording.bodies[contacts.b[i]].type === "fixed" ? -1 : 1;
            const strength = Math.min(1.6, Math.sqrt(contacts.impulses[i] / contacts.greatImpulse));
            if (strength > 0.02) {
                const length = side * (5 + 32 * strength);
                drawArrow(context, [x, y], [contacts.normals[2 * i] * length, -contacts.normals[2 * i + 1] * length],
                    color, 1.5);
            }
            context.fillStyle = color;
            context.beginPath();
            context.arc(x, y, 2.4, 0, 2 * Math.PI);
            context.fill();
        }
    }

    resize(width: number, height: number, pixelRatio: number) {
        this.pixelRatio = pixelRatio;
        this.element.width = Math.round(width * pixelRatio);
        this.element.height = Math.round(height * pixelRatio);
        this.camera.width = width;
        this.camera.height = height;
        if (this.camera.untouched) this.fit();
    }

    setInsets(insets: Insets) {
        this.camera.insets = insets;
        if (this.camera.untouched) this.fit();
    }

    setContacts(contacts: Contacts | null) {
        this.contacts = contacts;
    }

    select(body: number) {
        this.selected = body;
        this.lastCenter = null;
        if (body < 0) this.following = false;
    }

    follow(on: boolean) {
        this.following = on;
        if (!on || this.selected < 0) return;
        const state = this.recording.state(this.selected, this.time);
        [this.camera.x, this.camera.y] = state.position;
        this.camera.untouched = false;
    }

    pick(x: number, y: number): number {
        const { context, camera, recording } = this;
        const [worldX, worldY] = camera.toWorld(x, y);
        context.setTransform(1, 0, 0, 1, 0, 0);
        context.lineWidth = 8 / camera.scale; // fingers and thin things
        let nearMiss = -1;
        for (const { body, drawn } of [...this.items].reverse()) {
            if (!drawn || !recording.poses.present[body]) continue;
            const center = this.centerOf(body);
            const angle = recording.poses.turns[body];
            const [dx, dy] = [worldX - center[0], worldY - center[1]];
            const localX = dx * Math.cos(angle) + dy * Math.sin(angle);
            const localY = dy * Math.cos(angle) - dx * Math.sin(angle);
            if (context.isPointInPath(drawn.outline, localX, localY)) return body;
            if (nearMiss < 0 && context.isPointInStroke(drawn.outline, localX, localY)) nearMiss = body;
        }
        return nearMiss;
    }

    fit() {
        this.camera.fit(this.content);
    }

    setView([near]: number[]) {
        if (near === undefined) return;
        this.camera.scale *= near;
        this.camera.untouched = false;
    }

    cost() {
        return { calls: this.items.length, triangles: 0 };
    }
}
