// Chevrons on shapes that have a direction: they run along belts, and stand on one-way shapes towards the
// side from which others land.

import { support } from "./framing";
import { Body, Shape } from "./recording";

export interface Flow {
    /** The chevrons at a time, in the frame of the body with the centre of mass at its origin. */
    chevrons(time: number): Path2D;
    /** Strokes of this width suit them, m. */
    width: number;
}

const mostCells = 600;

/** Null where nothing flows, or the shape has no area to show it on. */
export function flowOf(body: Body, shape: Shape): Flow | null {
    const direction = shape.surface_velocity ?? shape.one_way;
    if (!direction || shape.type === "plane" || shape.type === "chain") return null;
    const length = Math.hypot(...direction);
    const speed = shape.surface_velocity ? length : 0;
    const [ux, uy] = direction.map((v) => v / length);
    // Bounds along the direction and to its left.
    const [front, back] = [support(shape, [ux, uy]), -support(shape, [-ux, -uy])];
    const [left, right] = [support(shape, [-uy, ux]), -support(shape, [uy, -ux])];
    const [along, across] = [front - back, left - right];
    const cell = Math.max(Math.min(along, across), Math.sqrt((along * across) / mostCells));
    const rows = Math.max(1, Math.round(across / cell));
    const spacing = speed > 0 ? 1.4 * cell : along / Math.max(1, Math.round(along / cell));
    const half = 0.22 * Math.min(cell, across / rows);
    const angle = shape.angle ?? 0;
    const [cx, cy] = [shape.center[0] - body.center_of_mass[0], shape.center[1] - body.center_of_mass[1]];
    const place = (a: number, b: number): [number, number] => {
        const [x, y] = [a * ux - b * uy, a * uy + b * ux];
        return [cx + x * Math.cos(angle) - y * Math.sin(angle), cy + x * Math.sin(angle) + y * Math.cos(angle)];
    };
    const chevrons = (time: number) => {
        const path = new Path2D();
        const moved = speed > 0 ? (speed * time) % spacing : spacing / 2;
        for (let a = back + moved; a < front + half; a += spacing)
            for (let row = 0; row < rows; ++row) {
                const b = right + ((row + 0.5) * across) / rows;
                path.moveTo(...place(a - half / 2, b + half));
                path.lineTo(...place(a + half / 2, b));
                path.lineTo(...place(a - half / 2, b - half));
            }
        return path;
    };
    return { chevrons, width: 0.35 * half };
}
