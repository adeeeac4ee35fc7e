// How surfaces look: lit materials that draw the edges of solids, and a grid in metres on what is fixed.

import { MeshStandardMaterial, Texture, Vector3 } from "three";
import { Finish } from "./materials";

export const surfaceUniforms = {
    edgeStrength: { value: 0.5 },
    gridStrength: { value: 0.1 },
    gridSpacing: { value: 1 },
    gridOrigin: { value: new Vector3() },
};

/** Where the chevrons of one surface are: along `direction`, a unit vector of the scene, `spacing` apart. */
export interface Chevrons {
    direction: { value: Vector3 };
    middle: { value: Vector3 };
    spacing: { value: number };
    /** How far they have run, m. */
    way: { value: number };
}

const vertexDeclarations = /* glsl */ `
attribute vec3 edge;
attribute float tint;
varying vec3 edgeDistance;
varying float surfaceTint;
varying vec3 worldPlace;
`;

const vertexBody = /* glsl */ `
edgeDistance = edge;
surfaceTint = tint;
vec4 placed = vec4(transformed, 1.0);
#ifdef USE_BATCHING
placed = batchingMatrix * placed;
#endif
#ifdef USE_INSTANCING
placed = instanceMatrix * placed;
#endif
worldPlace = (modelMatrix * placed).xyz;
`;

const fragmentDeclarations = /* glsl */ `
varying vec3 edgeDistance;
varying float surfaceTint;
varying vec3 worldPlace;
uniform float edgeStrength;
uniform float gridStrength;
uniform float gridSpacing;
uniform vec3 gridOrigin;

vec3 changeAPixel(vec3 value) {
    vec3 x = dFdx(value), y = dFdy(value);
    return sqrt(x * x + y * y) + 1e-6;
}

// Lines vanish where a pixel spans much of what they divide.
float edgeLine() {
    vec3 change = changeAPixel(edgeDistance);
    vec3 line = clamp(1.6 - edgeDistance / change, 0.0, 1.0) * (1.0 - smoothstep(0.02, 0.12, change));
    return max(line.x, max(line.y, line.z));
}

float gridLine() {
    vec3 place = (worldPlace + gridOrigin) / gridSpacing;
    vec3 change = changeAPixel(place);
    vec3 normal = abs(normalize(cross(dFdx(worldPlace), dFdy(worldPlace))));
    vec3 distance = abs(fract(place - 0.5) - 0.5);
    vec3 line = clamp(1.2 - distance / change, 0.0, 1.0) * (1.0 - smoothstep(0.05, 0.35, change));
    line *= 1.0 - smoothstep(0.8, 0.95, normal);
    // Only on level ground and upright walls: on rugged terrain lines would tell nothing.
    return max(line.x, max(line.y, line.z)) * smoothstep(0.995, 0.999, max(normal.x, max(normal.y, normal.z)));
}
`;

const chevronDeclarations = /* glsl */ `
uniform vec3 chevronDirection;
uniform vec3 chevronMiddle;
uniform float chevronSpacing;
uniform float chevronWay;

// On the faces that the direction lies in.
float chevron() {
    vec3 normal = normalize(cross(dFdx(worldPlace), dFdy(worldPlace)));
    vec3 aside = cross(normal, chevronDirection);
    vec3 place = worldPlace - chevronMiddle;
    float across = abs(fract(dot(place, normalize(aside)) / chevronSpacing + 0.5) - 0.5); // from the middle
    float along = fract((dot(place, chevronDirection) - chevronWay) / chevronSpacing + across);
    float change = fwidth(dot(place, chevronDirection) / chevronSpacing) * 1.5 + 1e-4;
    float stripe = smoothstep(0.0, change, along) - smoothstep(0.3, 0.3 + change, along);
    return stripe * smoothstep(0.7, 0.9, length(aside)) * (1.0 - smoothstep(0.15, 0.5, change));
}
`;

const finishes: Record<Finish, { roughness: number; metalness: number }> = {
    matte: { roughness: 0.92, metalness: 0 },
    satin: { roughness: 0.62, metalness: 0 },
    gloss: { roughness: 0.28, metalness: 0 },
    metal: { roughness: 0.38, metalness: 0.4 },
};

export function surfaceMaterial(
    finish: Finish,
    gridded: boolean,
    environment: Texture | null,
    chevrons: Chevrons | null = null,
): MeshStandardMaterial {
    const material = new MeshStandardMaterial({ ...finishes[finish], envMap: environment });
    material.defines = { ...material.defines, ...(gridded ? { GRIDDED: "" } : {}), ...(chevrons ? { CHEVRONS: "" } : {}) };
    material.onBeforeCompile = (shader) => {
        Object.assign(shader.uniforms, surfaceUniforms);
        for (const [name, uniform] of Object.entries(chevrons ?? {}))
            shader.uniforms[`chevron${name[0].toUpperCase()}${name.slice(1)}`] = uniform;
        shader.vertexShader = shader.vertexShader
            .replace("#include <common>", `#include <common>\n${vertexDeclarations}`)
            .replace("#include <project_vertex>", `#include <project_vertex>\n${vertexBody}`);
        shader.fragmentShader = shader.fragmentShader
            .replace("#include <common>", `#include <common>\n${fragmentDeclarations}${chevrons ? chevronDeclarations : ""}`)
            .replace("#include <color_fragment>", /* glsl */ `#include <color_fragment>
                diffuseColor.rgb *= surfaceTint;
                float lines = edgeStrength * edgeLine();
                #ifdef GRIDDED
                lines = max(0.5 * lines, 0.55 * gridStrength * gridLine());
                #endif
                #ifdef CHEVRONS
                lines = max(lines, 0.35 * chevron());
                #endif
                diffuseColor.rgb *= 1.0 - lines;`);
    };
    return material;
}


/** Of what is a sensor: all shines through. */
export function sensorMaterial(): MeshStandardMaterial {
    const material = surfaceMaterial("matte", false, null);
    Object.assign(material, { transparent: true, opacity: 0.3, depthWrite: false });
    return material;
}
