// The name of the recording and, beneath it, what the colours mean.

import { element } from "./elements";
import { cssColor, lookOf, materialOf } from "./materials";
import { Recording } from "./recording";

const mostMaterials = 9;

export function fillHeading(heading: HTMLElement, recording: Recording) {
    const { header, bodies, duration, dimension } = recording;
    const count = bodies.length === 1 ? "1 body" : `${bodies.length} bodies`;
    heading.append(
        element("h1", {}, header.name || "Carom replay"),
        element("p", {}, `${dimension}D · ${count} · ${+duration.toFixed(2)} s`),
        legend(recording),
    );
}

function legend(recording: Recording): HTMLElement {
    const counts = new Map<string, number>();
    const types = new Set<string>();
    recording.bodies.forEach((body, index) => {
        types.add(body.type);
        if (body.type === "fixed") return;
        body.shapes.forEach((_, i) => {
            const material = materialOf(recording, index, i);
            counts.set(material, (counts.get(material) ?? 0) + 1);
        });
    });
    const entry = (name: string, color: string, className = "") => {
        const swatch = element("i", { className });
        swatch.style.setProperty("--swatch", color);
        return element("span", {}, swatch, name);
    };
    const common = [...counts].sort((a, b) => b[1] - a[1]).slice(0, mostMaterials);
    const entries = common.map(([name]) => entry(name, cssColor(lookOf(name).color)));
    if (counts.size > common.length) entries.push(element("span", {}, `+${counts.size - common.length}`));
    if (types.has("fixed")) entries.push(entry("fixed", "var(--neutral)"));
    if (counts.size > 0) entries.push(entry("asleep", cssColor(lookOf(common[0][0]).color), "asleep"));
    return element("div", { className: "legend" }, ...entries);
}
