// Light from a sky, and a sun whose shadows follow what moves.

import { DirectionalLight, Group, HemisphereLight, PMREMGenerator, Texture, Vector3, WebGLRenderer } from "three";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";
import { Theme } from "./theme";

export class Lights extends Group {
    private readonly sky = new HemisphereLight();
    private readonly sun = new DirectionalLight();
    private readonly direction: Vector3; // towards the sun

    /** Without `high` quality shadows are coarser, and more light from the sky stands in for reflections. */
    constructor(up: Vector3, private readonly high: boolean) {
        super();
        // Slantwise, so that both sides of a box that one sees are lit differently.
        this.direction = new Vector3(0.42, 0.25, 0.5).projectOnPlane(up).normalize().multiplyScalar(0.62).add(up).normalize();
        this.sky.position.copy(up);
        this.sun.castShadow = true;
        this.sun.shadow.mapSize.setScalar(high ? 2048 : 1024);
        this.sun.shadow.radius = 3;
        this.add(this.sky, this.sun, this.sun.target);
    }

    setTheme(theme: Theme) {
        const dark = theme.name === "dark";
        this.sky.color.set(dark ? "#b9c8e6" : "#ffffff");
        this.sky.groundColor.set(dark ? "#2b2a33" : "#b3a899");
        this.sky.intensity = (dark ? 0.95 : 0.85) + (this.high ? 0 : 0.5);
        this.sun.color.set(dark ? "#fff1dc" : "#fff7ea");
        this.sun.intensity = dark ? 2.3 : 1.75;
    }

    /** Spans the shadow over a sphere. It grows and moves in steps, else the shadows' edges would crawl. */
    cover(center: Vector3, radius: number) {
        const grown = 1.3 ** Math.ceil(Math.log(Math.max(radius, 1e-3)) / Math.log(1.3));
        const grain = grown / 4;
        const target = center.clone().divideScalar(grain).round().multiplyScalar(grain);
        const reach = grown * 1.3;
        if (target.equals(this.sun.target.position) && this.sun.shadow.camera.right === reach) return;
        this.sun.target.position.copy(target);
        this.sun.position.copy(target).addScaledVector(this.direction, 4 * reach);
        const { camera } = this.sun.shadow;
        camera.left = camera.bottom = -reach;
        camera.right = camera.top = reach;
        camera.near = 0.5 * reach;
        camera.far = 8 * reach;
        camera.updateProjectionMatrix();
        const texel = (2 * reach) / this.sun.shadow.mapSize.x;
        this.sun.shadow.normalBias = 1.5 * texel;
        this.sun.shadow.bias = -0.0004;
    }
}

/** What shiny things reflect. */
export function environment(renderer: WebGLRenderer): Texture {
    const generator = new PMREMGenerator(renderer);
    const { texture } = generator.fromScene(new RoomEnvironment(), 0.04);
    generator.dispose();
    return texture;
}
