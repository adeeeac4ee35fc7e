// The panel at the side: the list of bodies, and what there is to know of the one that is selected.

import { button, element, setPressed } from "./elements";
import { cssColor, lookOf, materialOf } from "./materials";
import { figures, fixed, vectorText, withPrefix } from "./numbers";
import { Recording, Vector } from "./recording";

const mostListed = 400;

export class Inspector {
    private readonly list = element("div", { className: "bodies", role: "listbox" });
    private readonly search = element("input", { type: "search", placeholder: "Find a body" });
    private readonly facts = element("div", { className: "facts", hidden: true });
    private readonly values = new Map<string, HTMLElement>();
    private readonly followButton: HTMLButtonElement;
    private selected = -1;

    constructor(
        panel: HTMLElement,
        private readonly recording: Recording,
        private readonly onSelect: (body: number) => void,
        onFollow: () => void,
        onClose: () => void,
    ) {
        this.followButton = button("target", "Follow (F)", onFollow);
        this.search.setAttribute("aria-label", "Find a body");
        this.search.addEventListener("input", () => this.fillList());
        this.list.setAttribute("aria-label", "Bodies");
        panel.append(
            element("div", { className: "search" }, this.search, button("close", "Close (B)", onClose)),
            this.facts,
            this.list,
        );
        this.fillList();
    }

    private fillList() {
        const { recording } = this;
        const wanted = this.search.value.trim().toLowerCase();
        const found = recording.bodies
            .map((_, index) => index)
            .filter((index) => recording.label(index).toLowerCase().includes(wanted));
        const rows = found.slice(0, mostListed).map((index) => this.row(index));
        if (found.length > rows.length)
            rows.push(element("p", {}, `and ${found.length - rows.length} more: type a part of a name`));
        if (found.length === 0) rows.push(element("p", {}, "No body has such a name."));
        this.list.replaceChildren(...rows);
        this.markSelected();
    }

    private row(index: number): HTMLElement {
        const body = this.recording.bodies[index];
        const swatch = element("i");
        swatch.style.background = body.type === "fixed" || body.shapes.length === 0
            ? "var(--neutral)"
            : cssColor(lookOf(materialOf(this.recording, index, 0)).color);
        const made = element("button", { type: "button", onclick: () => this.onSelect(index) },
            swatch, element("span", {}, this.recording.label(index)));
        if (body.type !== "dynamic") made.append(element("small", {}, body.type));
        made.dataset.body = String(index);
        made.setAttribute("role", "option");
        return made;
    }

    private markSelected() {
        for (const row of this.list.children) {
            const chosen = (row as HTMLElement).dataset.body === String(this.selected);
            row.setAttribute("aria-selected", String(chosen));
            if (chosen) row.scrollIntoView({ block: "nearest" });
        }
    }

    select(body: number) {
        this.selected = body;
        this.markSelected();
        this.facts.hidden = body < 0;
        this.values.clear();
        if (body < 0) return;
        const { name, type, mass, shapes } = this.recording.bodies[body];
        const flat = this.recording.dimension === 2;
        const materials = [...new Set(shapes.map((shape) => shape.material).filter(Boolean))];
        const made = [...new Set(shapes.map((shape) => shape.type))].join(", ");
        this.facts.replaceChildren(
            element("div", { className: "title" },
                element("h2", {}, name || `#${body}`),
                this.followButton,
                button("close", "Deselect (Esc)", () => this.onSelect(-1))),
            element("p", { className: "kind" },
                element("span", { className: "badge" }, type), this.value("awake", "badge state"),
                [made, ...materials].filter(Boolean).join(" · ")),
            this.row2("Mass", type === "dynamic" ? withPrefix(mass * 1000, "g") : "\u221e"),
            this.row2("Position", "", "position", "m"),
            this.row2(flat ? "Angle" : "Turned by", "", "angle", "°"),
            this.row2("Speed", "", "speed", "m/s"),
            this.row2("Velocity", "", "velocity", "m/s"),
            this.row2("Angular velocity", "", "turning", "rad/s"),
            this.row2("Kinetic energy", "", "kinetic"),
            this.row2("Potential energy", "", "potential"),
        );
    }

    private value(key: string, className = ""): HTMLElement {
        const made = element("span", { className });
        this.values.set(key, made);
        return made;
    }

    private row2(label: string, text: string, key = "", unit = ""): HTMLElement {
        const shown = key ? this.value(key) : element("span", {}, text);
        return element("dl", {}, element("dt", {}, label), element("dd", {}, shown, element("small", {}, unit)));
    }

    setFollowing(on: boolean) {
        setPressed(this.followButton, on);
    }

    update(time: number) {
        if (this.selected < 0) return;
        const { recording, selected } = this;
        const state = recording.state(selected, time);
        const { kinetic, potential } = recording.energy(selected, state);
        const { type } = recording.bodies[selected];
        const energies = type === "dynamic" ? [withPrefix(kinetic, "J"), withPrefix(potential, "J")] : ["\u2013", "\u2013"];
        const status = !state.present ? "absent" : type !== "dynamic" ? "" : state.awake ? "awake" : "asleep";
        const texts: Record<string, string> = {
            awake: status,
            position: vectorText(state.position),
            angle: fixed(degreesOf(state.rotation), 1),
            speed: figures(Math.hypot(...state.velocity)),
            velocity: vectorText(state.velocity),
            turning: vectorText(state.angularVelocity),
            kinetic: energies[0],
            potential: energies[1],
        };
        for (const [key, shown] of this.values) if (shown.textContent !== texts[key]) shown.textContent = texts[key];
        this.values.get("awake")!.dataset.state = status;
    }
}

/** The angle in 2D, in 3D the angle of the turn that the quaternion is. */
function degreesOf(rotation: Vector): number {
    const degrees = 180 / Math.PI;
    if (rotation.length === 1) return rotation[0] * degrees;
    const [x, y, z, w] = rotation;
    return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w)) * degrees;
}
