// How surfaces look: lit materials that draw the edges of solids, and a grid in metres on what is fixed.

import { MeshStandardMaterial, Texture, Vector3 } from "three";
import { Finish } from "./materials";

export const surfaceUniforms = {
    edgeStrength: { value: 0.5 },
    gridStrength: { value: 0.1 },
    gridSpacing: { value: 1 },
    gridOrigin: { value: new Vector3() },
};

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

const finishes: Record<Finish, { roughness: number; metalness: number }> = {
    matte: { roughness: 0.92, metalness: 0 },
    satin: { roughness: 0.62, metalness: 0 },
    gloss: { roughness: 0.28, metalness: 0 },
    metal: { roughness: 0.38, metalness: 0.4 },
};

export function surfaceMaterial(finish: Finish, gridded: boolean, environment: Texture | null): MeshStandardMaterial {
    const material = new MeshStandardMaterial({ ...finishes[finish], envMap: environment });
    material.defines = { ...material.defines, ...(gridded ? { GRIDDED: "" } : {}) };
    material.onBeforeCompile = (shader) => {
        Object.assign(shader.uniforms, surfaceUniforms);
        shader.vertexShader = shader.vertexShader
            .replace("#include <common>", `#include <common>\n${vertexDeclarations}`)
            .replace("#include <project_vertex>", `#include <project_vertex>\n${vertexBody}`);
        shader.fragmentShader = shader.fragmentShader
            .replace("#include <common>", `#include <common>\n${fragmentDeclarations}`)
            .replace("#include <color_fragment>", /* glsl */ `#include <color_fragment>
                diffuseColor.rgb *= surfaceTint;
                float lines = edgeStrength * edgeLine();
                #ifdef GRIDDED
                lines = max(0.5 * lines, 0.55 * gridStrength * gridLine());
                #endif
                diffuseColor.rgb *= 1.0 - lines;`);
    };
    return material;
}

