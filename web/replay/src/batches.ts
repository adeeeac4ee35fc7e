// Many shapes in few draw calls: those of one geometry as instances, the odd ones out in one batch.

import {
    BatchedMesh, BufferGeometry, Color, InstancedMesh, Intersection, Material, Matrix4, Mesh, Object3D, Raycaster,
} from "three";
import { Solid } from "./solids";

/** A shape of a body in the scene. */
export interface Part {
    body: number;
    shape: number;
    solid: Solid;
    /** From its geometry to the frame of the body, with the centre of mass at the origin. */
    place: Matrix4;
    /** Parts of one surface share a material. */
    surface: string;
    /** Set by `buildBatches`. */
    slot: Slot;
}

/** Where a part is drawn. */
export interface Slot {
    geometry: BufferGeometry;
    setMatrix(matrix: Matrix4): void;
    setColor(color: Color): void;
}

const fewest = 4; // instances that make a draw call of their own worth while

/** Divides round shapes the finer the fewer there are. */
function detailFor(count: number, fine: boolean): number {
    return Math.round((count <= 60 ? 14 : count <= 300 ? 10 : 7) * (fine ? 1 : 0.7));
}

export class Batches {
    readonly objects: Mesh[] = [];
    private readonly partsOf = new Map<Object3D, Part[]>();

    constructor(parts: Part[], materialFor: (surface: string) => Material, fine: boolean) {
        const detail = detailFor(parts.length, fine);
        for (const [surface, members] of groupBy(parts, (part) => part.surface)) {
            const odd: [BufferGeometry, Part[]][] = [];
            for (const alike of groupBy(members, (part) => part.solid.key).values()) {
                const geometry = alike[0].solid.build(detail);
                if (alike.length >= fewest) this.addInstances(geometry, alike, materialFor(surface));
                else odd.push([geometry, alike]);
            }
            if (odd.length > 0) this.addBatch(odd, materialFor(surface));
        }
    }

    private add(mesh: Mesh, parts: Part[]) {
        mesh.castShadow = mesh.receiveShadow = !(mesh.material as Material).transparent;
        mesh.frustumCulled = false; // bounds of what moves would have to be found anew for every frame
        this.objects.push(mesh);
        this.partsOf.set(mesh, parts);
    }

    private addInstances(geometry: BufferGeometry, parts: Part[], material: Material) {
        const mesh = new InstancedMesh(geometry, material, parts.length);
        parts.forEach((part, i) => {
            part.slot = {
                geometry,
                setMatrix: (matrix) => {
                    mesh.setMatrixAt(i, matrix);
                    mesh.instanceMatrix.needsUpdate = true;
                },
                setColor: (color) => {
                    mesh.setColorAt(i, color);
                    mesh.instanceColor!.needsUpdate = true;
                },
            };
        });
        this.add(mesh, parts);
    }

    private addBatch(odd: [BufferGeometry, Part[]][], material: Material) {
        const parts = odd.flatMap(([, alike]) => alike);
        const vertices = odd.reduce((sum, [geometry]) => sum + geometry.attributes.position.count, 0);
        const mesh = new BatchedMesh(parts.length, vertices, 0, material);
        mesh.sortObjects = false;
        mesh.perObjectFrustumCulled = false;
        for (const [geometry, alike] of odd) {
            const id = mesh.addGeometry(geometry);
            for (const part of alike) {
                const instance = mesh.addInstance(id);
                part.slot = {
                    geometry,
                    setMatrix: (matrix) => mesh.setMatrixAt(instance, matrix),
                    setColor: (color) => mesh.setColorAt(instance, color),
                };
            }
        }
        this.add(mesh, parts);
    }

    /** The part that a ray meets first. */
    pick(raycaster: Raycaster): Part | null {
        for (const object of this.objects)
            if (object instanceof InstancedMesh || object instanceof BatchedMesh) object.boundingSphere = null;
        const hits: Intersection[] = raycaster.intersectObjects(this.objects, false);
        if (hits.length === 0) return null;
        const { object, instanceId, batchId } = hits[0];
        return this.partsOf.get(object)![(instanceId ?? batchId)!];
    }
}

function groupBy<T>(items: T[], key: (item: T) => string): Map<string, T[]> {
    const groups = new Map<string, T[]>();
    for (const item of items) {
        const group = groups.get(key(item));
        if (group) group.push(item);
        else groups.set(key(item), [item]);
    }
    return groups;
}
