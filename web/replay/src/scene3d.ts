// Space, drawn by three.js.

import {
    BufferAttribute, BufferGeometry, CanvasTexture, Color, Fog, Material, Matrix4, Mesh, MeshStandardMaterial, NeutralToneMapping, PCFShadowMap, PerspectiveCamera, PlaneGeometry, Quaternion,
    Raycaster, SRGBColorSpace, Scene as Space, Spherical, Texture, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Batches, Part } from "./batches";
import { Contacts } from "./decode";
import { Flow, flowOf } from "./flow3d";
import { Content, contentOf, reachOf } from "./framing";
import { Lights, environment } from "./lights3d";
import { ContactMarks, LinkMarks, SelectionMarks } from "./marks3d";
import { Finish, cssColor, lookOf, materialOf, mix, stateColor } from "./materials";
import { Recording } from "./recording";
import { Insets, Scene } from "./scene";
import { solidOf } from "./solids";
import { sensorMaterial, surfaceMaterial, surfaceUniforms } from "./surface";
import { Theme } from "./theme";

const one = new Vector3(1, 1, 1);
const mostPixels = 5e6; // beyond that, sharpness is not worth the frames it costs
const nowhere = new Matrix4().makeScale(0, 0, 0);

export class Scene3 implements Scene {
    readonly element = document.createElement("div");
    onChange = () => {};
    private readonly renderer: WebGLRenderer;
    private width = 1;
    private height = 1;
    private readonly space = new Space();
    private readonly camera = new PerspectiveCamera(38, 1, 0.1, 1000);
    private readonly controls: OrbitControls;
    private readonly label = document.createElement("div");
    private readonly lights: Lights;
    private readonly content: Content;
    /** The middle of the content: what is drawn is relative to it, so that far from the world's origin
     *  single precision suffices. Whole numbers, for the grid. */
    private readonly origin: Vector3;
    private readonly size: number;
    private readonly up: Vector3;
    private readonly parts: Part[] = [];
    private readonly batches: Batches;
    private readonly planes: { mesh: Mesh; body: number; shape: number; place: Matrix4 }[] = [];
    private readonly surfaces = new Map<string, Material>();
    private readonly flows = new Map<string, Flow>();
    private readonly reaches: number[];
    private readonly moving: number[];
    private readonly selection: SelectionMarks;
    private readonly links: LinkMarks;
    private contactMarks: ContactMarks | null = null;
    private theme!: Theme;
    /** What each body was drawn as: not at all (0), asleep (1), awake (2); 4 more with something in its sensors. */
    private readonly shown: Uint8Array;
    private insets: Insets = { left: 0, right: 0, top: 0, bottom: 0 };
    private untouched = true;
    private selected = -1;
    private following = false;
    private lastCenter: Vector3 | null = null;
    private time = 0;

    constructor(private readonly recording: Recording, quality: "high" | "low" | null) {
        const high = quality === null ? hasGraphicsProcessor() : quality === "high";
        this.renderer = new WebGLRenderer({ antialias: high, powerPreference: "high-performance" });
        this.content = contentOf(recording);
        const [from, to] = [new Vector3(...this.content.low), new Vector3(...this.content.high)];
        this.size = to.distanceTo(from);
        this.origin = from.clone().add(to).divideScalar(2).round();
        this.up = upwards(recording.header.gravity);
        this.reaches = recording.bodies.map(reachOf);
        this.moving = recording.bodies.map((_, i) => i).filter((i) => recording.bodies[i].type !== "fixed");
        this.shown = new Uint8Array(recording.bodies.length).fill(255);

        this.renderer.toneMapping = NeutralToneMapping;
        this.renderer.shadowMap.enabled = true;
        this.renderer.shadowMap.type = PCFShadowMap;
        this.label.className = "name-tag";
        this.element.append(this.renderer.domElement, this.label);

        this.camera.up.copy(this.up);
        this.controls = new OrbitControls(this.camera, this.renderer.domElement);
        this.controls.enableDamping = true;
        this.controls.dampingFactor = 0.12;
        this.controls.addEventListener("start", () => (this.untouched = false));
        this.controls.addEventListener("change", () => this.onChange());

        const reflections = high ? environment(this.renderer) : null;
        this.addParts();
        this.batches = new Batches(this.parts, (surface) => this.surface(surface, reflections), high);
        this.lights = new Lights(this.up, high);
        this.links = new LinkMarks(recording, this.size * 0.012);
        this.selection = new SelectionMarks(recording);
        this.addPlanes((surface) => this.surface(surface, reflections));
        this.space.add(this.lights, this.links, this.selection, ...this.batches.objects);
        surfaceUniforms.gridOrigin.value.copy(this.origin);
        surfaceUniforms.gridSpacing.value = 10 ** Math.round(Math.log10(this.size / 14));
    }

    private addParts() {
        this.recording.bodies.forEach((body, index) =>
            body.shapes.forEach((shape, i) => {
                const solid = solidOf(shape);
                if (!solid) return;
                const { finish } = lookOf(materialOf(this.recording, index, i));
                const fixed = shape.type === "mesh" ? "ground" : "fixed";
                let surface: string = shape.sensor ? "sensor" : body.type === "fixed" ? fixed : finish;
                const inBody = placeOf(body.center_of_mass, shape);
                const flow = shape.sensor ? null : flowOf(index, shape, inBody.clone());
                if (flow) this.flows.set((surface += ` flow ${index} ${i}`), flow);
                const place = inBody.multiply(solid.place);
                // The slot is given when all parts are known.
                this.parts.push({ body: index, shape: i, solid, place, surface, slot: undefined! });
            }),
        );
    }

    private addPlanes(materialFor: (surface: string) => Material) {
        this.recording.bodies.forEach((body, index) =>
            body.shapes.forEach((shape, i) => {
                if (shape.type !== "plane") return;
                const side = 60 * this.size;
                const geometry = new PlaneGeometry(side, side).toNonIndexed();
                const mesh = new Mesh(withSurfaceAttributes(geometry), materialFor(`fixed plane ${index}`));
                mesh.receiveShadow = true;
                mesh.matrixAutoUpdate = false;
                const normal = new Vector3(...shape.normal).normalize();
                const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), normal);
                const surface = new Matrix4().compose(normal.clone().multiplyScalar(shape.offset), turn, one);
                this.planes.push({ mesh, body: index, shape: i, place: placeOf(body.center_of_mass, shape).multiply(surface) });
                this.space.add(mesh);
            }),
        );
    }

    private surface(name: string, reflections: Texture | null): Material {
        let material = this.surfaces.get(name);
        if (!material) {
            const [kind] = name.split(" ");
            const fixed = kind === "fixed" || kind === "ground";
            material =
                kind === "sensor"
                    ? sensorMaterial()
                    : surfaceMaterial(fixed ? "matte" : (kind as Finish), kind === "fixed", reflections, this.flows.get(name)?.chevrons);
            this.surfaces.set(name, material);
        }
        return material;
    }

    setTheme(theme: Theme) {
        this.theme = theme;
        const dark = theme.name === "dark";
        this.space.background = sky(theme);
        this.space.fog = new Fog(new Color().setRGB(...theme.horizon, "srgb"), this.size * 2, this.size * 8);
        this.lights.setTheme(theme);
        this.renderer.toneMappingExposure = dark ? 0.92 : 1;
        surfaceUniforms.edgeStrength.value = dark ? 0.5 : 0.42;
        surfaceUniforms.gridStrength.value = dark ? 0.4 : 0.28;
        for (const material of this.surfaces.values())
            (material as MeshStandardMaterial).envMapIntensity = dark ? 0.35 : 0.5;
        for (const marks of [this.links, this.selection, this.contactMarks]) marks?.setTheme(theme);
        for (const { mesh, body, shape } of this.planes) {
            const { color } = lookOf(materialOf(this.recording, body, shape));
            const shade = stateColor(color, this.recording.bodies[body].type, false, theme.neutral, body);
            (mesh.material as MeshStandardMaterial).color.setRGB(...shade, "srgb");
        }
        this.shown.fill(255); // all colours anew
    }

    update(time: number) {
        this.time = time;
        const { present, awake, sensing } = this.recording.pose(time);
        const pose = new Matrix4();
        const matrix = new Matrix4();
        const color = new Color();
        let last = -1;
        let state = 0;
        let before = 0;
        for (const part of this.parts) {
            const { body, slot } = part;
            if (body !== last) {
                before = this.shown[body];
                state = present[body] ? (awake[body] ? 2 : 1) + (sensing[body] ? 4 : 0) : 0;
                this.shown[body] = state;
                this.poseOf(body, pose);
                last = body;
            }
            // What neither moves nor changes keeps what was written for it.
            if (state === before && (state === 0 || this.recording.bodies[body].type === "fixed")) continue;
            slot.setMatrix(state === 0 ? nowhere : matrix.multiplyMatrices(pose, part.place));
            if (state !== before && state !== 0) {
                const { type } = this.recording.bodies[body];
                const look = lookOf(materialOf(this.recording, body, part.shape));
                const shade = stateColor(look.color, type, (state & 3) === 1, this.theme.neutral, body);
                const { sensor, type: kind } = this.recording.bodies[body].shapes[part.shape];
                if (sensor) color.setRGB(...(state & 4 ? this.theme.accent : this.theme.potential), "srgb");
                else color.setRGB(...(kind === "mesh" ? mix(shade, look.color, 0.3) : shade), "srgb");
                slot.setColor(color);
            }
        }
        for (const { mesh, body, place } of this.planes) {
            mesh.visible = !!present[body];
            mesh.matrix.multiplyMatrices(this.poseOf(body, pose), place);
            mesh.matrixWorldNeedsUpdate = true;
        }
        for (const flow of this.flows.values()) flow.update(this.poseOf(flow.body, pose), time);
        this.links.update(this.origin);
        this.updateSelection(pose);
        this.coverShadow();
    }

    /** Body to scene; the centre of mass is the body's own origin here. */
    private poseOf(body: number, pose: Matrix4): Matrix4 {
        const { centers, turns } = this.recording.poses;
        position.fromArray(centers, 3 * body).sub(this.origin);
        return pose.compose(position, rotation.fromArray(turns, 4 * body), one);
    }

    private updateSelection(pose: Matrix4) {
        const present = this.selected >= 0 && !!this.recording.poses.present[this.selected];
        this.selection.visible = present;
        if (!present) return;
        this.selection.update(this.selected, this.poseOf(this.selected, pose), this.time);
        const center = new Vector3().setFromMatrixPosition(pose);
        if (this.following && this.lastCenter) {
            const way = center.clone().sub(this.lastCenter);
            this.controls.target.add(way);
            this.camera.position.add(way);
        }
        this.lastCenter = center;
    }

    private coverShadow() {
        const { centers, present } = this.recording.poses;
        const low = new Vector3(Infinity, Infinity, Infinity);
        const high = low.clone().negate();
        for (const body of this.moving) {
            if (!present[body]) continue;
            position.fromArray(centers, 3 * body).sub(this.origin);
            low.min(position.clone().subScalar(this.reaches[body]));
            high.max(position.addScalar(this.reaches[body]));
        }
        const whole = this.size / 2;
        const empty = low.x > high.x;
        const radius = empty ? whole : Math.min(whole, low.distanceTo(high) / 2);
        this.lights.cover(empty ? new Vector3() : low.add(high).divideScalar(2), radius);
    }

    tick(): boolean {
        return this.controls.update();
    }

    draw() {
        const distance = this.camera.position.distanceTo(this.controls.target);
        this.camera.near = distance / 100;
        this.camera.far = distance * 10 + this.size * 20;
        this.camera.updateProjectionMatrix();
        this.contactMarks?.update(this.recording, this.recording.frameAt(this.time), this.origin, distance * 0.04);
        this.placeLabel();
        this.renderer.render(this.space, this.camera);
    }

    private placeLabel() {
        const shown = this.selected >= 0 && this.selection.visible;
        this.label.hidden = !shown;
        if (!shown) return;
        this.poseOf(this.selected, new Matrix4());
        const top = position.clone().addScaledVector(this.up, Math.min(this.reaches[this.selected], this.size));
        const { x, y, z } = top.project(this.camera);
        const { width, height } = this;
        this.label.hidden = z > 1;
        this.label.style.transform =
            `translate(-50%, -100%) translate(${((x + 1) / 2) * width}px, ${((1 - y) / 2) * height - 8}px)`;
    }

    resize(width: number, height: number, pixelRatio: number) {
        this.width = width;
        this.height = height;
        this.renderer.setPixelRatio(Math.min(pixelRatio, Math.sqrt(mostPixels / Math.max(1, width * height))));
        this.renderer.setSize(width, height);
        this.selection.resize(width, height);
        this.links.resize(width, height);
        this.camera.aspect = width / Math.max(1, height);
        this.applyInsets();
        if (this.untouched) this.fit();
    }

    setInsets(insets: Insets) {
        this.insets = insets;
        this.applyInsets();
        if (this.untouched) this.fit();
    }

    /** Moves the middle of the picture to the middle of what the controls leave free. */
    private applyInsets() {
        const { width, height } = this;
        const { left, right, top, bottom } = this.insets;
        this.camera.setViewOffset(width, height, (right - left) / 2, (bottom - top) / 2, width, height);
    }

    setContacts(contacts: Contacts | null) {
        if (this.contactMarks) this.space.remove(this.contactMarks);
        this.contactMarks = contacts && new ContactMarks(contacts);
        if (!this.contactMarks) return;
        this.contactMarks.setTheme(this.theme);
        this.space.add(this.contactMarks);
    }

    select(body: number) {
        this.selected = body;
        this.lastCenter = null;
        if (body < 0) this.following = false;
        this.selection.show(body, this.parts, this.origin);
        this.label.textContent = body < 0 ? "" : this.recording.label(body);
        this.updateSelection(new Matrix4());
    }

    follow(on: boolean) {
        this.following = on;
        if (!on || this.selected < 0) return;
        this.poseOf(this.selected, new Matrix4());
        this.camera.position.add(position.clone().sub(this.controls.target));
        this.controls.target.copy(position);
        this.untouched = false;
    }

    pick(x: number, y: number): number {
        const { width, height } = this;
        const raycaster = new Raycaster();
        raycaster.setFromCamera(new Vector2((x / width) * 2 - 1, 1 - (y / height) * 2), this.camera);
        return this.batches.pick(raycaster)?.body ?? -1;
    }

    fit() {
        this.look(32, 20, 1);
        this.untouched = true;
    }

    setView([azimuth, elevation = 20, near = 1]: number[]) {
        if (azimuth === undefined) return;
        this.look(azimuth, elevation, near);
        this.untouched = false;
    }

    /** Looks at all of the content from a direction in degrees; `near` 2 goes to half the distance. */
    private look(azimuth: number, elevation: number, near: number) {
        const degrees = Math.PI / 180;
        const direction = new Vector3()
            .setFromSpherical(new Spherical(1, (90 - elevation) * degrees, azimuth * degrees))
            .applyQuaternion(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), this.up));
        const { left, right, top, bottom } = this.insets;
        const slope = Math.tan((this.camera.fov / 2) * degrees) * 0.94;
        const slopeX = slope * this.camera.aspect * Math.max(0.3, 1 - (left + right) / this.width);
        const slopeY = slope * Math.max(0.3, 1 - (top + bottom) / this.height);
        const { target, distance } = this.frame(direction, slopeX, slopeY);
        this.controls.target.copy(target);
        this.camera.position.copy(target).addScaledVector(direction, distance / near);
        this.controls.update();
    }

    /** What to look at, and from how far, so that all content lies within the slopes of the view and in its
     *  middle: the distance that a target needs and the target that a distance needs, in turns. */
    private frame(direction: Vector3, slopeX: number, slopeY: number) {
        const right = new Vector3().crossVectors(this.up, direction).normalize();
        const above = new Vector3().crossVectors(direction, right);
        const low = new Vector3(...this.content.low).sub(this.origin);
        const target = new Vector3(...this.content.high).sub(this.origin).add(low).divideScalar(2);
        const balls = this.content.balls.map(({ center, radius }) => {
            const place = new Vector3(...center).sub(this.origin).sub(target);
            return { x: place.dot(right), y: place.dot(above), depth: place.dot(direction), radius };
        });
        const shift = { x: 0, y: 0 };
        let distance = 1.2 * this.size;
        for (let round = 0; round < 8 && balls.length > 0; ++round) {
            distance = 0.05 * this.size;
            for (const { x, y, depth, radius } of balls)
                distance = Math.max(distance,
                    depth + (Math.abs(x - shift.x) + radius) / slopeX, depth + (Math.abs(y - shift.y) + radius) / slopeY);
            for (const axis of ["x", "y"] as const) {
                let [least, most] = [Infinity, -Infinity];
                for (const { depth, radius, [axis]: place } of balls) {
                    least = Math.min(least, (place - shift[axis] - radius) / (distance - depth));
                    most = Math.max(most, (place - shift[axis] + radius) / (distance - depth));
                }
                shift[axis] += ((least + most) / 2) * distance * 0.8;
            }
        }
        return { target: target.addScaledVector(right, shift.x).addScaledVector(above, shift.y), distance };
    }

    cost() {
        return { calls: this.renderer.info.render.calls, triangles: this.renderer.info.render.triangles };
    }
}

const position = new Vector3();
const rotation = new Quaternion();

/** A gradient that ends at the horizon, where distant things fade into it. */
function sky(theme: Theme): Texture {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [2, 256];
    const context = canvas.getContext("2d")!;
    const gradient = context.createLinearGradient(0, 0, 0, 256);
    gradient.addColorStop(0, cssColor(theme.background));
    gradient.addColorStop(0.5, cssColor(theme.horizon));
    context.fillStyle = gradient;
    context.fillRect(0, 0, 2, 256);
    const texture = new CanvasTexture(canvas);
    texture.colorSpace = SRGBColorSpace;
    return texture;
}

/** False where the processor itself has to draw every pixel. */
function hasGraphicsProcessor(): boolean {
    const context = document.createElement("canvas").getContext("webgl2");
    const names = context?.getExtension("WEBGL_debug_renderer_info");
    if (!context || !names) return true;
    const name = String(context.getParameter(names.UNMASKED_RENDERER_WEBGL));
    context.getExtension("WEBGL_lose_context")?.loseContext();
    return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** The axis against which gravity pulls. */
function upwards(gravity: number[]): Vector3 {
    const axis = gravity.reduce((best, value, i) => (Math.abs(value) > Math.abs(gravity[best]) ? i : best), 1);
    return new Vector3().setComponent(axis, gravity[axis] > 0 ? -1 : 1);
}

/** From a shape's frame to its body's, the centre of mass at the origin. */
function placeOf(centerOfMass: number[], shape: { center: number[]; rotation?: number[] }): Matrix4 {
    const center = new Vector3(...shape.center).sub(new Vector3(...centerOfMass));
    return new Matrix4().compose(center, new Quaternion(...(shape.rotation ?? [0, 0, 0, 1])), one);
}

function withSurfaceAttributes(geometry: BufferGeometry) {
    const count = geometry.getAttribute("position").count;
    const filled = (size: number) => new BufferAttribute(new Float32Array(count * size).fill(1), size);
    return geometry.setAttribute("edge", filled(3)).setAttribute("tint", filled(1));
}
