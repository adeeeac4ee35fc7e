// What the view should hold at the start: where things move, with some of what they stand on.

import { Body, Recording, Shape, Vector } from "./recording";

export interface Bounds {
    low: Vector;
    high: Vector;
}

/** How far a shape reaches from its body's centre of mass; infinite for planes. */
export function reach(body: Body, shape: Shape): number {
    const length = (v: Vector) => Math.hypot(...v);
    const away = length(shape.center.map((value, i) => value - body.center_of_mass[i]));
    switch (shape.type) {
        case "ball": return away + shape.radius;
        case "box": return away + length(shape.size) / 2;
        case "capsule": return away + Math.max(length(shape.from), length(shape.to)) + shape.radius;
        case "hull": return away + Math.max(...shape.points.map(length)) + shape.rounding;
        case "cylinder":
        case "cone": return away + Math.hypot(shape.radius, shape.height / 2);
        case "plane": return Infinity;
    }
}

export function reachOf(body: Body): number {
    return body.shapes.reduce((most, shape) => Math.max(most, reach(body, shape)), 0);
}

/** Bounds along one axis that a few strays cannot stretch: at most half again beyond the middle 98 %. */
function robust(unsorted: number[]): [number, number] {
    const values = Float64Array.from(unsorted).sort();
    const at = (share: number) => values[Math.round(share * (values.length - 1))];
    const spread = at(0.99) - at(0.01);
    const slack = spread * 0.5;
    return [Math.max(values[0], at(0.01) - slack), Math.min(values[values.length - 1], at(0.99) + slack)];
}

export function contentBounds(recording: Recording): Bounds {
    const { bodies, frames, dimension } = recording;
    const moving = bodies.map((_, i) => i).filter((i) => bodies[i].type !== "fixed");
    const stride = Math.max(1, Math.ceil((moving.length * frames) / 50_000));
    const axes: number[][] = Array.from({ length: dimension }, () => []);
    const collect = (body: number, frame: number) => {
        if (!recording.isPresent(body, frame)) return;
        const size = reachOf(bodies[body]);
        for (let axis = 0; axis < dimension; ++axis) {
            const value = recording.coordinate(body, frame, axis);
            axes[axis].push(value - size, value + size);
        }
    };
    for (const body of moving) for (let frame = 0; frame < frames; frame += stride) collect(body, frame);
    // A world in which nothing moves shows what stands in it.
    if (axes[0].length === 0)
        bodies.forEach((body, i) => Number.isFinite(reachOf(body)) && frames > 0 && collect(i, 0));
    if (axes[0].length === 0) return { low: Array(dimension).fill(-5), high: Array(dimension).fill(5) };
    const ranges = axes.map(robust);
    const bounds = { low: ranges.map((r) => r[0]), high: ranges.map((r) => r[1]) };
    addNearFixed(recording, bounds);
    return bounds;
}

/** Fixed things of about the size of what moves, beside it, belong to the picture. */
function addNearFixed(recording: Recording, bounds: Bounds) {
    const size = Math.max(...bounds.high.map((high, i) => high - bounds.low[i]));
    const own = { low: [...bounds.low], high: [...bounds.high] };
    recording.bodies.forEach((body, index) => {
        const radius = reachOf(body);
        if (body.type !== "fixed" || recording.frames === 0 || radius > 0.6 * size) return;
        const place = own.low.map((_, axis) => recording.coordinate(index, 0, axis));
        const near = place.every(
            (value, i) => value + radius > own.low[i] - size / 4 && value - radius < own.high[i] + size / 4,
        );
        if (!near) return;
        place.forEach((value, i) => {
            bounds.low[i] = Math.min(bounds.low[i], value - radius);
            bounds.high[i] = Math.max(bounds.high[i], value + radius);
        });
    });
}
