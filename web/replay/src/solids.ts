// Shapes of space as triangles. Besides place and normal every corner carries
//   edge: three numbers, one of which falls to 0 towards an edge of the solid, by which the shader draws
//         edges as lines of constant width (1 where there is none), and
//   tint: a factor on the colour, which shows how round things turn.

import { BufferGeometry, Float32BufferAttribute, Matrix4, Quaternion, Vector3 } from "three";
import { Shape, Vector } from "./recording";

export interface Solid {
    /** Solids of the same key have the same geometry. */
    key: string;
    build: (detail: number) => BufferGeometry;
    /** From that geometry to the shape's frame. */
    place: Matrix4;
}

class Triangles {
    private readonly places: number[] = [];
    private readonly normals: number[] = [];
    private readonly edges: number[] = [];
    private readonly tints: number[] = [];

    add(corners: Vector3[], normals: Vector3[], edges: number[][], tint = 1) {
        for (let i = 0; i < 3; ++i) {
            this.places.push(...corners[i].toArray());
            this.normals.push(...normals[i].toArray());
            this.edges.push(...edges[i]);
            this.tints.push(tint);
        }
    }

    /** A flat convex face, with edges all around if it is `sharp`. */
    face(corners: Vector3[], sharp: boolean) {
        const normal = faceNormal(corners);
        for (let i = 1; i + 1 < corners.length; ++i) {
            // Which sides of this triangle, each opposite to a corner, are sides of the face.
            const border = [true, i + 2 === corners.length, i === 1];
            const edges = [0, 1, 2].map((corner) =>
                border.map((is, side) => (sharp && is && side !== corner ? 0 : 1)));
            this.add([corners[0], corners[i], corners[i + 1]], [normal, normal, normal], edges);
        }
    }

    /** A smooth surface over a grid of points, seen from where columns run rightwards and rows upwards;
     *  `sharpRows` are the rows that are edges. */
    grid(points: Vector3[][], normals: Vector3[][], sharpRows: number[] = [], tint = (_column: number) => 1) {
        // Neighbouring rows use different numbers, so that between two edges each keeps its own distance.
        const edge = (row: number) => [0, 1, 2].map((k) => (sharpRows.includes(row) && row % 2 === k ? 0 : 1));
        const add = (column: number, ...places: [number, number][]) =>
            this.add(places.map(([r, c]) => points[r][c]), places.map(([r, c]) => normals[r][c]),
                places.map(([r]) => edge(r)), tint(column));
        for (let r = 0; r + 1 < points.length; ++r)
            for (let c = 0; c + 1 < points[r].length; ++c) {
                add(c, [r, c], [r, c + 1], [r + 1, c + 1]);
                add(c, [r, c], [r + 1, c + 1], [r + 1, c]);
            }
    }

    finish(): BufferGeometry {
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new Float32BufferAttribute(this.places, 3));
        geometry.setAttribute("normal", new Float32BufferAttribute(this.normals, 3));
        geometry.setAttribute("edge", new Float32BufferAttribute(this.edges, 3));
        geometry.setAttribute("tint", new Float32BufferAttribute(this.tints, 1));
        return geometry;
    }
}

/** Newell's formula: right for any flat polygon, however its first corners lie. */
function faceNormal(corners: Vector3[]): Vector3 {
    const normal = new Vector3();
    corners.forEach((a, i) => {
        const b = corners[(i + 1) % corners.length];
        normal.x += (a.y - b.y) * (a.z + b.z);
        normal.y += (a.z - b.z) * (a.x + b.x);
        normal.z += (a.x - b.x) * (a.y + b.y);
    });
    return normal.normalize();
}

/** A point on the way between unit vectors, on the sphere. */
function between(a: Vector3, b: Vector3, share: number): Vector3 {
    return a.clone().lerp(b, share).normalize();
}

/** A unit ball: each eighth of the sphere is divided alike, and their borders are drawn. */
function ball(detail: number): BufferGeometry {
    const triangles = new Triangles();
    for (let eighth = 0; eighth < 8; ++eighth) {
        const signs = [1, 2, 4].map((bit) => (eighth & bit ? -1 : 1));
        const even = signs[0] * signs[1] * signs[2] > 0;
        const add = (...corners: [number, number][]) => {
            const ordered = even ? corners : [corners[0], corners[2], corners[1]];
            const shares = ordered.map(([i, j]) => new Vector3(i, j, detail - i - j).normalize());
            const places = shares.map((p) => new Vector3(signs[0] * p.x, signs[1] * p.y, signs[2] * p.z));
            triangles.add(places, places, shares.map((p) => p.toArray()), even ? 1 : 0.86);
        };
        for (let i = 0; i < detail; ++i)
            for (let j = 0; i + j < detail; ++j) {
                add([i, j], [i + 1, j], [i, j + 1]);
                if (i + j + 1 < detail) add([i + 1, j], [i + 1, j + 1], [i, j + 1]);
            }
    }
    return triangles.finish();
}

/** A surface of revolution about y, by (radius, height, slope of the normal) from the bottom to the top. */
function turned(profile: { radius: number; y: number; normal: [number, number] }[], sharpRows: number[], detail: number) {
    const around = 4 * detail;
    const points: Vector3[][] = [];
    const normals: Vector3[][] = [];
    for (const { radius, y, normal } of profile) {
        const directions = Array.from({ length: around + 1 }, (_, k) => {
            const angle = (2 * Math.PI * k) / around;
            return new Vector3(Math.sin(angle), 0, Math.cos(angle));
        });
        points.push(directions.map((d) => new Vector3(d.x * radius, y, d.z * radius)));
        normals.push(directions.map((d) => new Vector3(d.x * normal[0], normal[1], d.z * normal[0]).normalize()));
    }
    const triangles = new Triangles();
    const tint = (column: number) => (Math.floor(column / detail) % 2 ? 0.88 : 1);
    triangles.grid(points, normals, sharpRows, tint);
    return triangles;
}

/** A flat round end of unit radius at the height y, facing up or down. */
function cap(triangles: Triangles, y: number, detail: number) {
    const around = 4 * detail;
    const normal = new Vector3(0, Math.sign(y), 0);
    const center = new Vector3(0, y, 0);
    const rim = (k: number) =>
        new Vector3(Math.sin((2 * Math.PI * k) / around), y, Math.cos((2 * Math.PI * k) / around));
    for (let k = 0; k < around; ++k) {
        const ends = y > 0 ? [rim(k), rim(k + 1)] : [rim(k + 1), rim(k)];
        const tint = Math.floor(k / detail) % 2 ? 0.88 : 1;
        triangles.add([center, ...ends], [normal, normal, normal], [[1, 1, 1], [0, 1, 1], [0, 1, 1]], tint);
    }
}

function cylinder(detail: number): BufferGeometry {
    const side: [number, number] = [1, 0];
    const triangles = turned(
        [{ radius: 1, y: -0.5, normal: side }, { radius: 1, y: 0.5, normal: side }], [0, 1], detail);
    cap(triangles, 0.5, detail);
    cap(triangles, -0.5, detail);
    return triangles.finish();
}

function cone(detail: number): BufferGeometry {
    const side: [number, number] = [1, 1];
    const triangles = turned(
        [{ radius: 1, y: -0.5, normal: side }, { radius: 0, y: 0.5, normal: side }], [0], detail);
    cap(triangles, -0.5, detail);
    return triangles.finish();
}

/** A capsule of unit radius about the y axis, `length` between the centres of its ends. */
function capsule(length: number, detail: number): BufferGeometry {
    const rows = Math.ceil(detail / 2); // of each end
    const profile: { radius: number; y: number; normal: [number, number] }[] = [];
    for (let k = 0; k <= 2 * rows + 1; ++k) {
        const upper = k > rows;
        const angle = (Math.PI / 2) * ((upper ? k - 1 : k) / rows - 1);
        const normal: [number, number] = [Math.cos(angle), Math.sin(angle)];
        profile.push({ radius: normal[0], y: normal[1] + (upper ? length / 2 : -length / 2), normal });
    }
    return turned(profile, [rows, rows + 1], detail).finish();
}

/** A convex solid grown by `rounding`: its faces moved outwards, joined along the edges by parts of
 *  cylinders and at the corners by parts of spheres. */
function hull(points: Vector[], faces: number[][], rounding: number): BufferGeometry {
    const corners = points.map((p) => new Vector3(...p));
    const triangles = new Triangles();
    const normals = faces.map((face) => faceNormal(face.map((i) => corners[i])));
    faces.forEach((face, f) =>
        triangles.face(face.map((i) => corners[i].clone().addScaledVector(normals[f], rounding)), rounding === 0));
    if (rounding > 0) roundEdges(triangles, corners, faces, normals, rounding);
    return triangles.finish();
}

function roundEdges(triangles: Triangles, corners: Vector3[], faces: number[][], normals: Vector3[], rounding: number) {
    const steps = 4;
    const faceOf = new Map<string, number>(); // by the edge that runs along its border
    faces.forEach((face, f) => face.forEach((i, k) => faceOf.set(`${i},${face[(k + 1) % face.length]}`, f)));
    const arc = (a: number, b: number) =>
        Array.from({ length: steps + 1 }, (_, k) => between(normals[a], normals[b], k / steps));
    const grown = (corner: number, normal: Vector3) => corners[corner].clone().addScaledVector(normal, rounding);
    const middles = corners.map(() => new Vector3());
    faces.forEach((face, f) => face.forEach((i) => middles[i].add(normals[f])));
    middles.forEach((middle) => middle.normalize());

    for (const [edge, face] of faceOf) {
        const [i, j] = edge.split(",").map(Number);
        const other = faceOf.get(`${j},${i}`);
        if (other === undefined) continue;
        const across = arc(face, other);
        if (i < j)
            triangles.grid([i, j].map((corner) => across.map((n) => grown(corner, n))), [across, across]);
        // The part of the sphere about corner i between this edge and the middle of the corner.
        const rings = Array.from({ length: steps + 1 }, (_, r) => across.map((n) => between(middles[i], n, r / steps)));
        triangles.grid(rings.map((ring) => ring.map((n) => grown(i, n))), rings);
    }
}

const boxFaces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

function boxCorners(size: Vector): Vector[] {
    return Array.from({ length: 8 }, (_, i) =>
        size.map((length, axis) => ((i >> axis) & 1 ? 1 : -1) * (length / 2)));
}

/** Any surface of triangles, each flat; from behind too if it is two-sided. */
function mesh(vertices: Vector[], corners: number[][], twoSided: boolean): BufferGeometry {
    const triangles = new Triangles();
    for (const [i, j, k] of corners) {
        const places = [i, j, k].map((corner) => new Vector3(...vertices[corner]));
        triangles.face(places, false);
        if (twoSided) triangles.face([places[0], places[2], places[1]], false);
    }
    return triangles.finish();
}

/** Meshes are never alike, and too large to be compared. */
let meshes = 0;

/** Null for planes, which have no end, and for lines. */
export function solidOf(shape: Shape): Solid | null {
    const scaled = (x: number, y: number, z: number) => new Matrix4().makeScale(x, y, z);
    switch (shape.type) {
        case "ball": {
            const r = shape.radius;
            return { key: "ball", build: ball, place: scaled(r, r, r) };
        }
        case "box": {
            const { size, rounding } = shape;
            if (rounding === 0)
                return { key: "box", build: () => hull(boxCorners([1, 1, 1]), boxFaces, 0), place: scaled(size[0], size[1], size[2]) };
            const core = size.map((length) => Math.max(0, length - 2 * rounding));
            return { key: `box ${size} ${rounding}`, build: () => hull(boxCorners(core), boxFaces, rounding), place: new Matrix4() };
        }
        case "capsule": {
            const from = new Vector3(...shape.from);
            const along = new Vector3(...shape.to).sub(from);
            const length = along.length();
            const ratio = Number((length / shape.radius).toPrecision(4));
            const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), length > 0 ? along.clone().normalize() : new Vector3(0, 1, 0));
            const place = new Matrix4().compose(from.addScaledVector(along, 0.5), turn, new Vector3().setScalar(shape.radius));
            return { key: `capsule ${ratio}`, build: (detail) => capsule(ratio, detail), place };
        }
        case "cylinder":
        case "cone":
            return { key: shape.type, build: shape.type === "cone" ? cone : cylinder, place: scaled(shape.radius, shape.height, shape.radius) };
        case "hull": {
            const { points, faces = [], rounding } = shape;
            return { key: `hull ${JSON.stringify(points)} ${rounding}`, build: () => hull(points, faces, rounding), place: new Matrix4() };
        }
        case "mesh": {
            const { vertices, triangles, two_sided } = shape;
            return { key: `mesh ${++meshes}`, build: () => mesh(vertices, triangles, two_sided), place: new Matrix4() };
        }
        case "plane":
        case "chain":
            return null;
    }
}
