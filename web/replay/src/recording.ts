// What was recorded, decoded: bodies, and for each frame their states. See docs/replay-format.md.

export type Vector = number[];

export type Shape = {
    center: Vector;
    angle?: number;
    rotation?: Vector;
    material: string;
    sensor?: boolean;
    one_way?: Vector;
    surface_velocity?: Vector;
} & (
    | { type: "ball"; radius: number }
    | { type: "box"; size: Vector; rounding: number }
    | { type: "capsule"; from: Vector; to: Vector; radius: number }
    | { type: "hull"; points: Vector[]; faces?: number[][]; rounding: number }
    | { type: "cylinder" | "cone"; radius: number; height: number }
    | { type: "plane"; normal: Vector; offset: number }
    | { type: "chain"; points: Vector[]; segments: number[][]; two_sided: boolean }
    | { type: "mesh"; vertices: Vector[]; triangles: number[][]; two_sided: boolean }
);

export interface Body {
    name: string;
    type: "fixed" | "kinematic" | "dynamic";
    mass: number;
    inertia: number | Vector;
    center_of_mass: Vector;
    start: Vector;
    shapes: Shape[];
}

export interface Link {
    type: string;
    a: number;
    b: number;
    anchor_a: Vector;
    anchor_b: Vector;
}

export interface ColumnHeader {
    name: string;
    planes: number;
}

export interface Header {
    carom_replay: number;
    dimension: 2 | 3;
    name: string;
    step: number;
    frames: number;
    gravity: Vector;
    bodies: Body[];
    links: Link[];
    energy: { kinetic: number[]; potential: number[] };
    motion: { channels: (ColumnHeader & { scale: number; order: number })[] };
    contacts: {
        every: number;
        total: number;
        position_scale: number;
        normal_scale: number;
        impulse_unit: number;
        impulse_steps: number;
        columns: ColumnHeader[];
    };
}

/** One number of every body in every frame: `values[body * frames + frame] * scale`. */
export interface Channel {
    values: Int32Array;
    scale: number;
}

const present = 1;
const awake = 2;
const jumped = 4;
const sensing = 8;

/** Where all bodies are at one moment. Angles in 2D are `turns`, rotations in 3D unit quaternions. */
export interface Poses {
    /** Centres of mass, dimension numbers a body. */
    centers: Float64Array;
    turns: Float64Array;
    present: Uint8Array;
    awake: Uint8Array;
    /** Is something inside a sensor of the body? */
    sensing: Uint8Array;
}

export interface BodyState {
    position: Vector;
    rotation: Vector;
    velocity: Vector;
    angularVelocity: Vector;
    present: boolean;
    awake: boolean;
    sensing: boolean;
}

export class Recording {
    readonly dimension: 2 | 3;
    readonly frames: number;
    readonly bodies: Body[];
    readonly duration: number;
    readonly poses: Poses;

    constructor(
        readonly header: Header,
        private readonly channels: Map<string, Channel>,
    ) {
        this.dimension = header.dimension;
        this.frames = header.frames;
        this.bodies = header.bodies;
        this.duration = Math.max(0, header.frames - 1) * header.step;
        const count = this.bodies.length;
        this.poses = {
            centers: new Float64Array(count * this.dimension),
            turns: new Float64Array(count * (this.dimension === 2 ? 1 : 4)),
            present: new Uint8Array(count),
            awake: new Uint8Array(count),
            sensing: new Uint8Array(count),
        };
    }

    private channel(name: string): Channel {
        const channel = this.channels.get(name);
        if (!channel) throw new Error(`the recording has no channel ${name}`);
        return channel;
    }

    frameAt(time: number): number {
        return Math.min(Math.max(0, this.frames - 1), Math.max(0, Math.floor(time / this.header.step + 1e-6)));
    }

    private flags(body: number, frame: number): number {
        return this.channel("flags").values[body * this.frames + frame];
    }

    isPresent(body: number, frame: number): boolean {
        return (this.flags(body, frame) & present) !== 0;
    }

    /** The centre of mass of a body in a frame, one coordinate of it. */
    coordinate(body: number, frame: number, axis: number): number {
        const { values, scale } = this.channel("xyz"[axis]);
        return this.bodies[body].start[axis] + values[body * this.frames + frame] * scale;
    }

    /** Fills `poses` for a time between frames. */
    pose(time: number): Poses {
        const frame = this.frameAt(time);
        const next = Math.min(frame + 1, this.frames - 1);
        const between = Math.min(1, Math.max(0, time / this.header.step - frame));
        const { poses, frames } = this;
        const flags = this.channel("flags").values;
        const places = ["x", "y", "z"].slice(0, this.dimension).map((name) => this.channel(name));
        const turns = (this.dimension === 2 ? ["angle"] : ["qx", "qy", "qz", "qw"]).map((name) => this.channel(name));
        for (let body = 0; body < this.bodies.length; ++body) {
            const at = body * frames + frame;
            const then = body * frames + next;
            poses.present[body] = flags[at] & present;
            poses.awake[body] = flags[at] & awake;
            poses.sensing[body] = flags[at] & sensing;
            // What jumps or vanishes at the next frame stays where it is until then.
            const share = (flags[then] & jumped) !== 0 || (flags[then] & present) === 0 ? 0 : between;
            for (let i = 0; i < places.length; ++i) {
                const { values, scale } = places[i];
                poses.centers[body * places.length + i] =
                    this.bodies[body].start[i] + (values[at] + (values[then] - values[at]) * share) * scale;
            }
            this.turn(body, at, then, share, turns);
        }
        return poses;
    }

    private turn(body: number, at: number, then: number, share: number, channels: Channel[]) {
        const { turns } = this.poses;
        let squared = 0;
        const first = body * channels.length;
        for (let i = 0; i < channels.length; ++i) {
            const { values, scale } = channels[i];
            const value = (values[at] + (values[then] - values[at]) * share) * scale;
            turns[first + i] = value;
            squared += value * value;
        }
        if (channels.length === 1 || squared === 0) return;
        const length = Math.sqrt(squared);
        for (let i = 0; i < 4; ++i) turns[first + i] /= length;
    }

    /** Everything known of one body at the frame that a time lies in. */
    state(body: number, time: number): BodyState {
        const frame = this.frameAt(time);
        const read = (...names: string[]) =>
            names.map((name) => {
                const { values, scale } = this.channel(name);
                return values[body * this.frames + frame] * scale;
            });
        const flags = this.flags(body, frame);
        const flat = this.dimension === 2;
        return {
            position: this.bodies[body].start.map((_, axis) => this.coordinate(body, frame, axis)),
            rotation: flat ? read("angle") : read("qx", "qy", "qz", "qw"),
            velocity: flat ? read("vx", "vy") : read("vx", "vy", "vz"),
            angularVelocity: flat ? read("w") : read("wx", "wy", "wz"),
            present: (flags & present) !== 0,
            awake: (flags & awake) !== 0,
            sensing: (flags & sensing) !== 0,
        };
    }

    /** Energies of one body: of its motion, and of its height against gravity. */
    energy(body: number, state: BodyState): { kinetic: number; potential: number } {
        const { mass, inertia } = this.bodies[body];
        const dot = (a: Vector, b: Vector) => a.reduce((sum, value, i) => sum + value * b[i], 0);
        const linear = (mass * dot(state.velocity, state.velocity)) / 2;
        const potential = -mass * dot(this.header.gravity, state.position);
        if (typeof inertia === "number")
            return { kinetic: linear + (inertia * state.angularVelocity[0] ** 2) / 2, potential };
        const [wx, wy, wz] = rotateBack(state.rotation, state.angularVelocity);
        const [xx, yy, zz, xy, xz, yz] = inertia;
        const turning =
            xx * wx * wx + yy * wy * wy + zz * wz * wz + 2 * (xy * wx * wy + xz * wx * wz + yz * wy * wz);
        return { kinetic: linear + turning / 2, potential };
    }

    indexOf(name: string): number {
        const byName = this.bodies.findIndex((body) => body.name === name);
        if (byName >= 0) return byName;
        const number = /^#(\d+)$/.exec(name);
        return number && Number(number[1]) < this.bodies.length ? Number(number[1]) : -1;
    }

    label(body: number): string {
        return this.bodies[body].name || `#${body}`;
    }
}

/** A vector of the world as the body that is turned by the unit quaternion `q` sees it. */
export function rotateBack(q: Vector, v: Vector): Vector {
    const [x, y, z, w] = [-q[0], -q[1], -q[2], q[3]];
    const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
    return [
        v[0] + w * t[0] + y * t[2] - z * t[1],
        v[1] + w * t[1] + z * t[0] - x * t[2],
        v[2] + w * t[2] + x * t[1] - y * t[0],
    ];
}
