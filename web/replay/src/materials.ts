// Colours with meaning: a material's name tells its colour, and the same name always gets the same one.

import { Recording } from "./recording";

export type Finish = "matte" | "satin" | "gloss" | "metal";

export interface Look {
    /** sRGB, 0 … 1 */
    color: [number, number, number];
    finish: Finish;
}

const known: [RegExp, string, Finish][] = [
    [/plank|oak|wood|timber|crate/, "#b9814c", "satin"],
    [/gravel|stone|rock|granite|boulder/, "#8d949e", "matte"],
    [/concrete|cement/, "#a8a59d", "matte"],
    [/gold|brass/, "#d9a93a", "metal"],
    [/copper|bronze/, "#c0764b", "metal"],
    [/rust/, "#a85b38", "matte"],
    [/iron|lead/, "#6f7783", "metal"],
    [/metal|steel|alumini|silver|chrome/, "#9fb0c3", "metal"],
    [/ice|snow|frost/, "#a9d8ee", "gloss"],
    [/glass|crystal/, "#86bfbb", "gloss"],
    [/rubber|tyre|tire/, "#d8604f", "matte"],
    [/sand|dust/, "#d9b872", "matte"],
    [/soil|earth|mud|dirt|clay/, "#93704f", "matte"],
    [/brick|terracotta/, "#bf6044", "matte"],
    [/grass|leaf|moss|plant/, "#7aa65a", "matte"],
    [/plastic/, "#5b93e0", "gloss"],
    [/foam|wool|cloth|paper/, "#e3d9c6", "matte"],
    [/bone|ivory|porcelain|marble/, "#e8dfca", "gloss"],
    [/water/, "#4f9bd8", "gloss"],
    [/lava|fire/, "#e8683a", "matte"],
    [/bird|flesh|meat/, "#dd5a5a", "satin"],
    [/pig/, "#86b957", "satin"],
];

/** A colour that the name itself tells. */
const colorWords: [RegExp, string][] = [
    [/\bred\b/, "#d9534f"],
    [/\borange\b/, "#e58a3c"],
    [/\byellow\b/, "#e5bf3f"],
    [/\bgreen\b/, "#6fa85a"],
    [/\bblue\b/, "#5088dd"],
    [/\b(purple|violet)\b/, "#8f74d6"],
    [/\bpink\b/, "#df82ab"],
    [/\bbrown\b/, "#94694a"],
    [/\bblack\b/, "#565b66"],
    [/\bwhite\b/, "#e6e6e3"],
    [/\bgr[ae]y\b/, "#9298a1"],
];

/** For names that mean nothing to us: hues that stay apart from each other and from the greys. */
const others = [
    "#5b8fe3", "#e0875a", "#62b08a", "#c06fb5", "#d6b04c", "#5fb3c6",
    "#8f7de0", "#d96c7c", "#8fae52", "#b58a6a",
];

export function parseColor(hex: string): [number, number, number] {
    const value = Number.parseInt(hex.slice(1), 16);
    return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

export function cssColor([r, g, b]: [number, number, number], alpha = 1): string {
    const byte = (v: number) => Math.round(Math.min(1, Math.max(0, v)) * 255);
    return `rgba(${byte(r)},${byte(g)},${byte(b)},${alpha})`;
}

export function mix(
    a: [number, number, number],
    b: [number, number, number],
    share: number,
): [number, number, number] {
    return [0, 1, 2].map((i) => a[i] + (b[i] - a[i]) * share) as [number, number, number];
}

function hash(text: string): number {
    let value = 2166136261;
    for (let i = 0; i < text.length; ++i) value = Math.imul(value ^ text.charCodeAt(i), 16777619);
    return value >>> 0;
}

export function lookOf(name: string): Look {
    const lower = name.toLowerCase();
    const material = known.find(([pattern]) => pattern.test(lower));
    const finish = material?.[2] ?? "satin";
    const word = colorWords.find(([pattern]) => pattern.test(lower));
    if (word) return { color: parseColor(word[1]), finish };
    if (!material) return { color: parseColor(others[hash(lower) % others.length]), finish };
    // Granite and slate are stones both, but not the same: sorts of one material differ a little.
    const plain = material[0].exec(lower)![0] === lower;
    const shift = plain ? [0, 0, 0] : [0, 8, 16].map((bits) => (((hash(lower) >> bits) & 255) / 255 - 0.5) * 0.16);
    const color = parseColor(material[1]).map((v, i) => Math.min(1, Math.max(0, v + shift[0] + shift[i] * 0.3)));
    return { color: color as Look["color"], finish };
}

/** What a shape is coloured by: its material, or else the first words of its body's name. */
export function materialOf(recording: Recording, body: number, shape: number): string {
    const { material } = recording.bodies[body].shapes[shape];
    return material || recording.bodies[body].name.replace(/[\s_-]*#?\d+$/, "") || "body";
}

/** How colours change with what a body does: one place for both the plane and space. */
export function stateColor(
    base: [number, number, number],
    type: string,
    asleep: boolean,
    neutral: [number, number, number],
    body: number,
): [number, number, number] {
    if (type === "fixed") return mix(neutral, base, 0.2);
    // Neighbours of one material differ by a little, so that a heap does not run together.
    const shade = 0.94 + 0.12 * ((hash(String(body)) & 255) / 255);
    const own = base.map((v) => Math.min(1, v * shade)) as [number, number, number];
    return asleep ? mix(own, neutral, 0.58) : own;
}
