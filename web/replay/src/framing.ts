// What the view should hold at the start: where things move, with some of what they stand on.

import { Body, Recording, Shape, Vector, rotateBack } from "./recording";

export interface Bounds {
    low: Vector;
    high: Vector;
}

/** What the view should hold: bounds, and balls (a point and a radius) that fill them more closely. */
export interface Content extends Bounds {
    balls: { center: Vector; radius: number }[];
}

const length = (v: Vector) => Math.hypot(...v);
const dot = (a: Vector, b: Vector) => a.reduce((sum, value, i) => sum + value * b[i], 0);

/** How far a shape goes along a unit direction, both in its own frame; infinite for planes. */
export function support(shape: Shape, direction: Vector): number {
    switch (shape.type) {
        case "ball": return shape.radius;
        case "box": return dot(shape.size, direction.map(Math.abs)) / 2;
        case "capsule": return Math.max(dot(shape.from, direction), dot(shape.to, direction)) + shape.radius;
        case "hull": return Math.max(...shape.points.map((p) => dot(p, direction))) + shape.rounding;
        case "cylinder":
        case "cone": {
            const across = shape.radius * Math.hypot(direction[0], direction[2]);
            const along = (shape.height / 2) * direction[1];
            return shape.type === "cylinder" ? across + Math.abs(along) : Math.max(across - along, along);
        }
        case "plane": return Infinity;
        case "chain": return furthest(shape.points, (p) => dot(p, direction));
        case "mesh": return furthest(shape.vertices, (p) => dot(p, direction));
    }
}

/** The greatest measure of a list of points, of which there may be very many. */
function furthest(points: Vector[], measure: (point: Vector) => number): number {
    return points.reduce((most, point) => Math.max(most, measure(point)), -Infinity);
}

/** The bounds of a body in a frame, along each axis. */
function bodyBounds(recording: Recording, index: number, frame: number): Bounds {
    const body = recording.bodies[index];
    const flat = recording.dimension === 2;
    const turn = (rotation: Vector, v: Vector) => (flat ? rotateBack2(rotation[0], v) : rotateBack(rotation, v));
    const { rotation } = recording.state(index, frame * recording.header.step);
    const bounds: Bounds = { low: [], high: [] };
    for (let axis = 0; axis < recording.dimension; ++axis) {
        const along = Array.from({ length: recording.dimension }, (_, i) => (i === axis ? 1 : 0));
        const inBody = turn(rotation, along);
        const ends = body.shapes.map((shape) => {
            const inShape = turn(flat ? [shape.angle ?? 0] : (shape.rotation ?? [0, 0, 0, 1]), inBody);
            const middle = dot(shape.center, inBody) - dot(body.center_of_mass, inBody);
            return [middle - support(shape, inShape.map((v) => -v)), middle + support(shape, inShape)];
        });
        const center = recording.coordinate(index, frame, axis);
        bounds.low.push(center + ends.reduce((least, [low]) => Math.min(least, low), 0));
        bounds.high.push(center + ends.reduce((most, [, high]) => Math.max(most, high), 0));
    }
    return bounds;
}

function rotateBack2(angle: number, [x, y]: Vector): Vector {
    return [x * Math.cos(angle) + y * Math.sin(angle), y * Math.cos(angle) - x * Math.sin(angle)];
}

/** How far a shape reaches from its body's centre of mass at most; infinite for planes. */
function reach(body: Body, shape: Shape): number {
    const away = length(shape.center.map((value, i) => value - body.center_of_mass[i]));
    switch (shape.type) {
        case "ball": return away + shape.radius;
        case "box": return away + length(shape.size) / 2;
        case "capsule": return away + Math.max(length(shape.from), length(shape.to)) + shape.radius;
        case "hull": return away + Math.max(...shape.points.map(length)) + shape.rounding;
        case "cylinder":
        case "cone": return away + Math.hypot(shape.radius, shape.height / 2);
        case "plane": return Infinity;
        case "chain": return away + furthest(shape.points, length);
        case "mesh": return away + furthest(shape.vertices, length);
    }
}

export function reachOf(body: Body): number {
    return body.shapes.reduce((most, shape) => Math.max(most, reach(body, shape)), 0);
}

const least = (values: number[]) => values.reduce((a, b) => Math.min(a, b));
const most = (values: number[]) => values.reduce((a, b) => Math.max(a, b));

/** Where the moving bodies are in some frames, and how far each one gets. */
class Ways {
    readonly samples: number[] = [];
    readonly starts: number[] = [];
    readonly ends: number[] = [];

    /** Bounds along one axis that strays cannot stretch: where bodies start and where most of them are, and
     *  beyond that what goes no further than half of its size. */
    bounds(): [number, number] {
        const values = Float64Array.from(this.samples).sort();
        const at = (share: number) => values[Math.round(share * (values.length - 1))];
        const low = least([at(0.02), ...this.starts]);
        const high = most([at(0.98), ...this.starts]);
        const slack = Math.max(0.5 * (high - low), 1e-3);
        const near = this.ends.filter((end) => end >= low - slack && end <= high + slack);
        return [least([low, ...near]), most([high, ...near])];
    }
}

function waysOf(recording: Recording, bodies: number[]): Ways[] {
    const { frames, dimension } = recording;
    const stride = Math.max(1, Math.ceil((bodies.length * frames) / 50_000));
    const axes = Array.from({ length: dimension }, () => new Ways());
    for (const body of bodies) {
        const size = reachOf(recording.bodies[body]);
        if (!Number.isFinite(size)) continue;
        axes.forEach((ways, axis) => {
            let [low, high] = [Infinity, -Infinity];
            for (let frame = 0; frame < frames; frame += stride) {
                if (!recording.isPresent(body, frame)) continue;
                const value = recording.coordinate(body, frame, axis);
                if (low === Infinity) ways.starts.push(value - size, value + size);
                ways.samples.push(value - size, value + size);
                low = Math.min(low, value - size);
                high = Math.max(high, value + size);
            }
            if (low < high) ways.ends.push(low, high);
        });
    }
    return axes;
}

export function contentOf(recording: Recording): Content {
    const { bodies, dimension } = recording;
    const all = bodies.map((_, i) => i);
    let shown = all.filter((i) => bodies[i].type !== "fixed");
    let ways = waysOf(recording, shown);
    // A world in which nothing moves shows what stands in it.
    if (ways[0].ends.length === 0) ways = waysOf(recording, (shown = all));
    if (ways[0].ends.length === 0)
        return { low: Array(dimension).fill(-5), high: Array(dimension).fill(5), balls: [] };
    const ranges = ways.map((one) => one.bounds());
    const content = { low: ranges.map(([low]) => low), high: ranges.map(([, high]) => high), balls: [] };
    addMoving(recording, shown, content);
    addNearFixed(recording, content);
    return content;
}

/** Where bodies are in some frames, as far as that lies within the bounds. */
function addMoving(recording: Recording, shown: number[], content: Content) {
    const stride = Math.max(1, Math.ceil((shown.length * recording.frames) / 4000));
    for (const body of shown) {
        const radius = reachOf(recording.bodies[body]);
        for (let frame = body % stride; frame < recording.frames; frame += stride) {
            if (!recording.isPresent(body, frame)) continue;
            const center = content.low.map((_, axis) => recording.coordinate(body, frame, axis));
            const inside = center.every((v, i) => v - radius >= content.low[i] && v + radius <= content.high[i]);
            if (inside) content.balls.push({ center, radius });
        }
    }
}

/** Of what is fixed, things no larger than all that moves and beside it belong to the picture; of greater
 *  ones, as much as lies close by. */
function addNearFixed(recording: Recording, content: Content) {
    const size = most(content.high.map((high, i) => high - content.low[i]));
    const own = { low: [...content.low], high: [...content.high] };
    recording.bodies.forEach((body, index) => {
        if (body.type !== "fixed" || !recording.isPresent(index, 0)) return;
        const { low, high } = bodyBounds(recording, index, 0);
        const near = low.every((value, i) => value < own.high[i] + size / 4 && high[i] > own.low[i] - size / 4);
        if (!near) return;
        const margin = low.some((value, i) => high[i] - value > 1.2 * size) ? 0.06 * size : Infinity;
        const from = low.map((value, i) => Math.max(value, own.low[i] - margin));
        const to = high.map((value, i) => Math.min(value, own.high[i] + margin));
        content.low = content.low.map((value, i) => Math.min(value, from[i]));
        content.high = content.high.map((value, i) => Math.max(value, to[i]));
        for (let corner = 0; corner < 2 ** low.length; ++corner)
            content.balls.push({ center: from.map((value, i) => ((corner >> i) & 1 ? to[i] : value)), radius: 0 });
    });
}
