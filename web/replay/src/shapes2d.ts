// Shapes of the plane as paths, in metres, in the frame of their body with the centre of mass at its origin.

import { Body, Shape, Vector } from "./recording";

export interface DrawnShape {
    outline: Path2D;
    /** A line inside that shows how the body is turned, where the outline does not. */
    mark: Path2D | null;
    /** For lines without an area: strokes into what is solid. */
    hatches: Path2D | null;
}

/** Null for planes, which have no end: they are drawn to the edge of the view. Hatches are a `grain` apart, m. */
export function drawnShape(body: Body, shape: Shape, grain: number): DrawnShape | null {
    const local = localPath(shape);
    if (!local) return null;
    const place = new DOMMatrix()
        .translate(shape.center[0] - body.center_of_mass[0], shape.center[1] - body.center_of_mass[1])
        .rotate(((shape.angle ?? 0) * 180) / Math.PI);
    const placed = (path: Path2D) => {
        const result = new Path2D();
        result.addPath(path, place);
        return result;
    };
    return {
        outline: placed(local),
        mark: shape.type === "ball" ? placed(ballMark(shape.radius)) : null,
        hatches: shape.type === "chain" ? placed(hatches(shape.points, shape.two_sided ? [] : shape.segments, grain)) : null,
    };
}

function localPath(shape: Shape): Path2D | null {
    const path = new Path2D();
    switch (shape.type) {
        case "ball":
            path.arc(0, 0, shape.radius, 0, 2 * Math.PI);
            return path;
        case "box": {
            const [width, height] = shape.size;
            if (shape.rounding > 0) path.roundRect(-width / 2, -height / 2, width, height, shape.rounding);
            else path.rect(-width / 2, -height / 2, width, height);
            return path;
        }
        case "capsule":
            roundedPolygon(path, [shape.from, shape.to], shape.radius);
            return path;
        case "hull":
            roundedPolygon(path, shape.points, shape.rounding);
            return path;
        case "chain":
            for (const [i, j] of shape.segments) {
                path.moveTo(shape.points[i][0], shape.points[i][1]);
                path.lineTo(shape.points[j][0], shape.points[j][1]);
            }
            return path;
        default:
            return null;
    }
}

/** Strokes from segments into the solid, which is to the right of their direction. */
function hatches(points: Vector[], segments: number[][], grain: number): Path2D {
    const path = new Path2D();
    const lengthOf = ([i, j]: number[]) => Math.hypot(points[j][0] - points[i][0], points[j][1] - points[i][1]);
    const spacing = Math.max(grain, segments.reduce((sum, segment) => sum + lengthOf(segment), 0) / 2000);
    let next = spacing / 2;
    for (const [i, j] of segments) {
        const from = points[i];
        const length = lengthOf([i, j]);
        const along = [(points[j][0] - from[0]) / length, (points[j][1] - from[1]) / length];
        for (; next < length; next += spacing) {
            const foot = [from[0] + next * along[0], from[1] + next * along[1]];
            path.moveTo(foot[0], foot[1]);
            path.lineTo(foot[0] + 0.7 * spacing * (along[1] - along[0]), foot[1] - 0.7 * spacing * (along[0] + along[1]));
        }
        next -= length;
    }
    return path;
}

/** A convex polygon (or a segment), its corners counter-clockwise, grown by `radius`. */
function roundedPolygon(path: Path2D, corners: Vector[], radius: number) {
    corners.forEach((corner, i) => {
        const before = corners[(i + corners.length - 1) % corners.length];
        const after = corners[(i + 1) % corners.length];
        // The outward normal of an edge lies a quarter turn clockwise of it.
        const normal = (a: Vector, b: Vector) => Math.atan2(b[1] - a[1], b[0] - a[0]) - Math.PI / 2;
        if (radius > 0) path.arc(corner[0], corner[1], radius, normal(before, corner), normal(corner, after));
        else path.lineTo(corner[0], corner[1]);
    });
    path.closePath();
}

function ballMark(radius: number): Path2D {
    const path = new Path2D();
    path.moveTo(radius * 0.25, 0);
    path.lineTo(radius * 0.82, 0);
    return path;
}
