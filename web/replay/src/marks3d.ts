// What is drawn over the world on demand: contacts, links, and the marks of the body that is selected.

import {
    BackSide, BufferGeometry, Color, ConeGeometry, CylinderGeometry, Float32BufferAttribute, Group, InstancedMesh,
    InterleavedBufferAttribute, Matrix4, Mesh, MeshBasicMaterial, Quaternion, ShaderMaterial, SphereGeometry,
    Vector2, Vector3,
} from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { Part } from "./batches";
import { Contacts, contactsOf } from "./decode";
import { Recording } from "./recording";
import { Theme } from "./theme";

const up = new Vector3(0, 1, 0);
const point = new Vector3();

/** An arrow of unit length along y. */
function arrowGeometry(): BufferGeometry {
    const shaft = new CylinderGeometry(0.022, 0.022, 0.75, 8).translate(0, 0.375, 0);
    const head = new ConeGeometry(0.075, 0.26, 12).translate(0, 0.86, 0);
    return mergeGeometries([shaft, head]);
}

/** Points and pushes of the contacts of a frame, drawn through everything. */
export class ContactMarks extends Group {
    private readonly material = new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.92 });
    private readonly points: InstancedMesh;
    private readonly arrows: InstancedMesh;

    constructor(private readonly contacts: Contacts) {
        super();
        let most = 1;
        for (let i = 0; i + 1 < contacts.first.length; ++i) most = Math.max(most, contacts.first[i + 1] - contacts.first[i]);
        this.points = new InstancedMesh(new SphereGeometry(1, 10, 6), this.material, most);
        this.arrows = new InstancedMesh(arrowGeometry(), this.material, most);
        for (const mesh of [this.points, this.arrows]) {
            mesh.frustumCulled = false;
            mesh.renderOrder = 10;
        }
        this.add(this.points, this.arrows);
    }

    setTheme(theme: Theme) {
        this.material.color.setRGB(...theme.contact, "srgb");
    }

    /** `size` is the length of a strong arrow in metres. */
    update(recording: Recording, frame: number, origin: Vector3, size: number) {
        const { contacts } = this;
        const [begin, end] = contactsOf(contacts, frame);
        const matrix = new Matrix4();
        const place = new Vector3();
        const normal = new Vector3();
        const turn = new Quaternion();
        const scale = new Vector3();
        for (let i = begin; i < end; ++i) {
            place.fromArray(contacts.positions, 3 * i).sub(origin);
            this.points.setMatrixAt(i - begin, matrix.compose(place, turn.identity(), scale.setScalar(0.05 * size)));
            // The normal points from a to b; what is drawn is the push on the one that can move.
            const side = recording.bodies[contacts.b[i]].type === "fixed" ? -1 : 1;
            normal.fromArray(contacts.normals, 3 * i).multiplyScalar(side).normalize();
            const strength = Math.min(1.6, Math.sqrt(contacts.impulses[i] / contacts.greatImpulse));
            const length = strength > 0.02 ? size * (0.15 + strength) : 0;
            scale.set(Math.min(length, size), length, Math.min(length, size));
            this.arrows.setMatrixAt(i - begin, matrix.compose(place, turn.setFromUnitVectors(up, normal), scale));
        }
        for (const mesh of [this.points, this.arrows]) {
            mesh.count = end - begin;
            mesh.instanceMatrix.needsUpdate = true;
        }
    }
}

const coilTurns = 10;
const coilSegments = 12 * coilTurns;

/** Springs as coils, other links as straight lines; all in one draw call. */
export class LinkMarks extends Group {
    private readonly material = new LineMaterial({ linewidth: 2.5 });
    private readonly geometry = new LineSegmentsGeometry();
    private readonly places: Float32Array;

    constructor(private readonly recording: Recording, private readonly radius: number) {
        super();
        const { links } = recording.header;
        this.places = new Float32Array(links.length * coilSegments * 6);
        if (links.length === 0) return;
        this.geometry.setPositions(this.places);
        const lines = new LineSegments2(this.geometry, this.material);
        lines.frustumCulled = false;
        this.add(lines);
    }

    setTheme(theme: Theme) {
        this.material.color.setRGB(...theme.line, "srgb");
    }

    resize(width: number, height: number) {
        this.material.resolution.set(width, height);
    }

    update(origin: Vector3) {
        const { recording, places } = this;
        const { links } = recording.header;
        if (links.length === 0) return;
        const { present } = recording.poses;
        links.forEach((link, i) => {
            const from = this.anchor(link.a, link.anchor_a).sub(origin);
            const shown = (link.a < 0 || present[link.a]) && (link.b < 0 || present[link.b]);
            const to = shown ? this.anchor(link.b, link.anchor_b).sub(origin) : from;
            this.coil(from, to, link.type === "spring" && shown ? this.radius : 0, i * coilSegments * 6);
        });
        // Both ends of all segments are views of one buffer.
        const buffer = (this.geometry.getAttribute("instanceStart") as InterleavedBufferAttribute).data;
        buffer.array.set(places);
        buffer.needsUpdate = true;
    }

    private coil(from: Vector3, to: Vector3, radius: number, start: number) {
        const along = to.clone().sub(from);
        const axis = along.clone().normalize();
        const aside = new Vector3(axis.y, axis.z, axis.x).cross(axis).normalize().multiplyScalar(radius);
        const across = axis.clone().cross(aside);
        for (let i = 0; i <= coilSegments; ++i) {
            const share = i / coilSegments;
            const width = Math.min(1, 14 * Math.min(share, 1 - share));
            const angle = 2 * Math.PI * coilTurns * share;
            point.copy(from)
                .addScaledVector(along, share)
                .addScaledVector(aside, width * Math.cos(angle))
                .addScaledVector(across, width * Math.sin(angle));
            if (i < coilSegments) point.toArray(this.places, start + 6 * i);
            if (i > 0) point.toArray(this.places, start + 6 * i - 3);
        }
    }

    private anchor(body: number, local: number[]): Vector3 {
        const place = new Vector3(...local);
        if (body < 0) return place;
        const { centers, turns } = this.recording.poses;
        return place
            .sub(new Vector3(...this.recording.bodies[body].center_of_mass))
            .applyQuaternion(new Quaternion().fromArray(turns, 4 * body))
            .add(new Vector3().fromArray(centers, 3 * body));
    }
}

/** The normals of a solid's corners as if it were round, so that an outline pushed along them stays closed. */
function outlineGeometry(geometry: BufferGeometry): BufferGeometry {
    const places = geometry.getAttribute("position");
    const normals = geometry.getAttribute("normal");
    const sums = new Map<string, Vector3>();
    const keyOf = (i: number) => [places.getX(i), places.getY(i), places.getZ(i)].map((v) => v.toFixed(5)).join();
    for (let i = 0; i < places.count; ++i) {
        const sum = sums.get(keyOf(i)) ?? new Vector3();
        sums.set(keyOf(i), sum.add(new Vector3().fromBufferAttribute(normals, i)));
    }
    const round = Array.from({ length: places.count }, (_, i) => sums.get(keyOf(i))!.clone().normalize().toArray());
    const outline = new BufferGeometry();
    outline.setAttribute("position", places);
    outline.setAttribute("normal", new Float32BufferAttribute(round.flat(), 3));
    return outline;
}

/** Outline, way and velocity of the selected body. */
export class SelectionMarks extends Group {
    private readonly outlineMaterial = new ShaderMaterial({
        side: BackSide,
        uniforms: { color: { value: new Color() }, pixels: { value: new Vector2(1, 1) } },
        vertexShader: /* glsl */ `
            uniform vec2 pixels; // of clip space
            void main() {
                gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
                vec3 facing = normalize(transpose(inverse(mat3(modelViewMatrix))) * normal);
                gl_Position.xy += 3.0 * normalize(facing.xy + 1e-6) * pixels * gl_Position.w;
            }`,
        fragmentShader: /* glsl */ `
            uniform vec3 color;
            void main() {
                gl_FragColor = vec4(color, 1.0);
                #include <colorspace_fragment>
            }`,
    });
    /** So that it is seen behind others, too. */
    private readonly ghostMaterial = new MeshBasicMaterial({ depthTest: false, depthWrite: false, transparent: true, opacity: 0.22 });
    private readonly lineMaterial = new LineMaterial({ linewidth: 2, transparent: true, opacity: 0.75, worldUnits: false });
    private readonly arrowMaterial = new MeshBasicMaterial({ depthTest: false, transparent: true });
    private readonly arrow = new Mesh(arrowGeometry(), this.arrowMaterial);
    private outlines: { mesh: Mesh; part: Part }[] = [];
    private trail: Line2 | null = null;

    constructor(private readonly recording: Recording) {
        super();
        this.arrow.renderOrder = 9;
    }

    setTheme(theme: Theme) {
        for (const material of [this.lineMaterial, this.arrowMaterial, this.ghostMaterial]) material.color.setRGB(...theme.accent, "srgb");
        this.outlineMaterial.uniforms.color.value.setRGB(...theme.accent, "srgb");
    }

    resize(width: number, height: number) {
        this.outlineMaterial.uniforms.pixels.value.set(2 / width, 2 / height);
        this.lineMaterial.resolution.set(width, height);
    }

    show(body: number, parts: Part[], origin: Vector3) {
        for (const { mesh } of this.outlines) mesh.geometry.dispose();
        this.trail?.geometry.dispose();
        this.trail = null;
        this.clear();
        this.outlines = parts
            .filter((part) => part.body === body)
            .flatMap((part) => {
                const geometry = outlineGeometry(part.slot.geometry);
                return [this.outlineMaterial, this.ghostMaterial].map((material) => ({ mesh: new Mesh(geometry, material), part }));
            });
        for (const { mesh } of this.outlines) {
            mesh.renderOrder = 8;
            mesh.matrixAutoUpdate = false;
            mesh.frustumCulled = false;
            this.add(mesh);
        }
        if (body >= 0 && this.recording.bodies[body].type !== "fixed") {
            this.addTrail(body, origin);
            this.add(this.arrow);
        }
    }

    private addTrail(body: number, origin: Vector3) {
        const { recording } = this;
        const stride = Math.max(1, Math.floor(recording.frames / 3000));
        const points: number[] = [];
        for (let frame = 0; frame < recording.frames; frame += stride)
            if (recording.isPresent(body, frame))
                for (let axis = 0; axis < 3; ++axis)
                    points.push(recording.coordinate(body, frame, axis) - origin.getComponent(axis));
        if (points.length < 6) return;
        this.trail = new Line2(new LineGeometry().setPositions(points), this.lineMaterial);
        this.trail.frustumCulled = false;
        this.add(this.trail);
    }

    update(body: number, pose: Matrix4, time: number) {
        for (const { mesh, part } of this.outlines) {
            mesh.matrix.multiplyMatrices(pose, part.place);
            mesh.matrixWorldNeedsUpdate = true;
        }
        if (body < 0) return;
        const velocity = new Vector3(...this.recording.state(body, time).velocity);
        const speed = velocity.length();
        this.arrow.visible = speed > 0.05;
        if (!this.arrow.visible) return;
        const length = 0.25 * speed; // the way of a quarter of a second
        this.arrow.position.setFromMatrixPosition(pose);
        this.arrow.quaternion.setFromUnitVectors(up, velocity.divideScalar(speed));
        this.arrow.scale.set(Math.min(length, 1), length, Math.min(length, 1));
    }
}
