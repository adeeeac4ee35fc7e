// Marks of constant size on the screen: arrows, springs, names, the way that a body takes.

import { Camera2 } from "./camera2d";
import { cssColor } from "./materials";
import { Recording } from "./recording";
import { Theme } from "./theme";

type Point = [number, number];

export function drawArrow(
    context: CanvasRenderingContext2D,
    [x, y]: Point,
    [dx, dy]: Point,
    color: string,
    width: number,
) {
    const length = Math.hypot(dx, dy);
    if (length < 1) return;
    const [ux, uy] = [dx / length, dy / length];
    const head = Math.min(length * 0.6, 3 + 2.5 * width);
    context.strokeStyle = context.fillStyle = color;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + dx - ux * head * 0.8, y + dy - uy * head * 0.8);
    context.stroke();
    context.beginPath();
    context.moveTo(x + dx, y + dy);
    context.lineTo(x + dx - ux * head - uy * head * 0.45, y + dy - uy * head + ux * head * 0.45);
    context.lineTo(x + dx - ux * head + uy * head * 0.45, y + dy - uy * head - ux * head * 0.45);
    context.fill();
}

/** A spring is a zigzag of sixteen strokes that stretches, anything else a straight line. */
export function drawLink(context: CanvasRenderingContext2D, type: string, from: Point, to: Point, color: string) {
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const length = Math.hypot(dx, dy);
    context.strokeStyle = context.fillStyle = color;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(...from);
    if (type === "spring" && length > 0) {
        const amplitude = Math.min(7, length / 8) / length;
        for (let i = 0; i < 16; ++i) {
            const along = 0.1 + (0.8 * (i + 0.5)) / 16;
            const aside = (i % 2 ? 1 : -1) * amplitude;
            context.lineTo(from[0] + dx * along - dy * aside, from[1] + dy * along + dx * aside);
        }
    }
    context.lineTo(...to);
    context.stroke();
    for (const end of [from, to]) {
        context.beginPath();
        context.arc(end[0], end[1], 3, 0, 2 * Math.PI);
        context.fill();
    }
}

export function drawName(context: CanvasRenderingContext2D, name: string, [x, y]: Point, theme: Theme) {
    context.font = "600 12px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    const width = context.measureText(name).width + 16;
    context.fillStyle = cssColor(theme.background, 0.82);
    context.beginPath();
    context.roundRect(x - width / 2, y - 10, width, 20, 10);
    context.fill();
    context.fillStyle = cssColor(theme.accent);
    context.fillText(name, x, y + 0.5);
}

/** The way of a body's centre through the whole recording, stronger where it has been. */
export function drawTrail(
    context: CanvasRenderingContext2D,
    camera: Camera2,
    recording: Recording,
    body: number,
    time: number,
    theme: Theme,
) {
    if (recording.bodies[body].type === "fixed") return;
    const stride = Math.max(1, Math.floor(recording.frames / 3000));
    const part = (begin: number, end: number, alpha: number) => {
        context.beginPath();
        for (let frame = begin; frame <= end; frame += stride)
            if (recording.isPresent(body, frame))
                context.lineTo(...camera.toScreen(recording.coordinate(body, frame, 0), recording.coordinate(body, frame, 1)));
        context.strokeStyle = cssColor(theme.accent, alpha);
        context.lineWidth = 1.5;
        context.stroke();
    };
    context.lineJoin = "round";
    const now = recording.frameAt(time);
    part(0, now, 0.6);
    context.setLineDash([3, 5]);
    part(now, recording.frames - 1, 0.35);
    context.setLineDash([]);
}

/** Fills a half-plane as far as the view goes. */
export function drawPlane(
    context: CanvasRenderingContext2D,
    camera: Camera2,
    recording: Recording,
    body: number,
    index: number,
) {
    const shape = recording.bodies[body].shapes[index];
    if (shape.type !== "plane") return;
    const { centers, turns } = recording.poses;
    const { center_of_mass } = recording.bodies[body];
    const rotated = ([x, y]: number[], angle: number): Point => [
        x * Math.cos(angle) - y * Math.sin(angle),
        x * Math.sin(angle) + y * Math.cos(angle),
    ];
    const local = rotated(shape.normal, shape.angle ?? 0);
    const size = Math.hypot(...local);
    const normal = rotated([local[0] / size, local[1] / size], turns[body]);
    // A point of the surface, then the one nearest to the middle of the view.
    const [px, py] = rotated(
        [
            shape.center[0] - center_of_mass[0] + (local[0] / size) * shape.offset,
            shape.center[1] - center_of_mass[1] + (local[1] / size) * shape.offset,
        ],
        turns[body],
    );
    const [x, y] = [centers[2 * body] + px, centers[2 * body + 1] + py];
    const above = (camera.x - x) * normal[0] + (camera.y - y) * normal[1];
    const [sx, sy] = camera.toScreen(camera.x - normal[0] * above, camera.y - normal[1] * above);
    const far = 2 * (camera.width + camera.height) + Math.abs(above) * camera.scale;
    const [nx, ny] = [normal[0], -normal[1]];
    context.lineWidth = 1.6;
    context.beginPath();
    context.moveTo(sx - ny * far, sy + nx * far);
    context.lineTo(sx + ny * far, sy - nx * far);
    context.stroke();
    context.lineTo(sx + ny * far - nx * far, sy - nx * far - ny * far);
    context.lineTo(sx - ny * far - nx * far, sy + nx * far - ny * far);
    context.fill();
}
