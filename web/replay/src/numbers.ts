// Numbers as people read them.

const minus = "\u2212";

/** Three or four figures, with a prefix of the unit where that helps: 12.3 kJ, 450 mJ. */
export function withPrefix(value: number, unit: string): string {
    const size = Math.abs(value);
    const prefixes: [number, string][] = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"]];
    const [factor, prefix] = size < 1e-6 ? [1, ""] : (prefixes.find(([limit]) => size >= limit * 0.9995) ?? [1e-3, "m"]);
    return `${figures(value / factor)} ${prefix}${unit}`;
}

export function figures(value: number): string {
    const size = Math.abs(value);
    const digits = size >= 100 ? 0 : size >= 10 ? 1 : 2;
    return fixed(value, size >= 1e6 || (size > 0 && size < 0.005) ? -1 : digits);
}

/** `digits` after the point; −1: as few as three figures need. */
export function fixed(value: number, digits: number): string {
    if (digits < 0) return value.toPrecision(3).replace("-", minus).replace("e+", "e");
    const text = value.toFixed(digits);
    return Number(text) === 0 ? text.replace("-", "") : text.replace("-", minus);
}

export function vectorText(values: number[], digits = 2): string {
    return values.map((value) => fixed(value, digits)).join("  ");
}
