// Chevrons on shapes of space that have a direction: belts, and shapes that are open from one side.

import { Matrix4, Vector3 } from "three";
import { support } from "./framing";
import { Shape } from "./recording";
import { Chevrons } from "./surface";

export class Flow {
    readonly chevrons: Chevrons;
    private readonly direction: Vector3; // in the shape's frame
    private readonly middle = new Vector3();
    private readonly speed: number;

    constructor(readonly body: number, shape: Shape, direction: number[], private readonly place: Matrix4) {
        this.direction = new Vector3(...direction).normalize();
        this.speed = shape.surface_velocity ? Math.hypot(...shape.surface_velocity) : 0;
        const extents = [0, 1, 2].map((axis) => {
            const unit = [0, 1, 2].map((i) => (i === axis ? 1 : 0));
            const [low, high] = [-support(shape, unit.map((v) => -v)), support(shape, unit)];
            this.middle.setComponent(axis, (low + high) / 2);
            return high - low;
        });
        const along = support(shape, this.direction.toArray()) + support(shape, this.direction.clone().negate().toArray());
        const middling = [...extents].sort((a, b) => a - b)[1];
        const spacing = this.speed > 0 ? Math.min(0.5 * middling, along) : Math.min(0.5 * middling, 0.7 * along);
        this.chevrons = {
            direction: { value: new Vector3() },
            middle: { value: new Vector3() },
            spacing: { value: spacing },
            way: { value: 0 },
        };
    }

    /** Follows the pose of the body. */
    update(pose: Matrix4, time: number) {
        const matrix = pose.clone().multiply(this.place);
        this.chevrons.direction.value.copy(this.direction).transformDirection(matrix);
        this.chevrons.middle.value.copy(this.middle).applyMatrix4(matrix);
        this.chevrons.way.value = (this.speed * time) % this.chevrons.spacing.value;
    }
}

/** Null where nothing flows, or the shape has no end. */
export function flowOf(body: number, shape: Shape, place: Matrix4): Flow | null {
    const direction = shape.surface_velocity ?? shape.one_way;
    return direction && shape.type !== "plane" ? new Flow(body, shape, direction, place) : null;
}
