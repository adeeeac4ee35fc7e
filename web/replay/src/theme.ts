// Dark and light: follows the system until the user chooses.

import { parseColor } from "./materials";

type Color = [number, number, number];

export interface Theme {
    name: "dark" | "light";
    background: Color;
    horizon: Color;
    neutral: Color;
    line: Color;
    text: Color;
    accent: Color;
    kinetic: Color;
    potential: Color;
    contact: Color;
}

const themes: Record<"dark" | "light", Theme> = {
    dark: {
        name: "dark",
        background: parseColor("#12151b"),
        horizon: parseColor("#1d222c"),
        neutral: parseColor("#4a515d"),
        line: parseColor("#c8d2e2"),
        text: parseColor("#e6eaf1"),
        accent: parseColor("#ffc14d"),
        kinetic: parseColor("#ff9d5c"),
        potential: parseColor("#6aa8ff"),
        contact: parseColor("#ff5f6d"),
    },
    light: {
        name: "light",
        background: parseColor("#f3f4f6"),
        horizon: parseColor("#ffffff"),
        neutral: parseColor("#b9bec7"),
        line: parseColor("#2a3140"),
        text: parseColor("#1c2230"),
        accent: parseColor("#e07b00"),
        kinetic: parseColor("#e2701f"),
        potential: parseColor("#2f74d8"),
        contact: parseColor("#d92545"),
    },
};

export class ThemeSwitch {
    private chosen: "dark" | "light" | null;
    private readonly system = matchMedia("(prefers-color-scheme: dark)");

    constructor(
        chosen: "dark" | "light" | null,
        private readonly changed: (theme: Theme) => void,
    ) {
        this.chosen = chosen;
        this.system.addEventListener("change", () => this.apply());
    }

    get current(): Theme {
        return themes[this.chosen ?? (this.system.matches ? "dark" : "light")];
    }

    toggle() {
        this.chosen = this.current.name === "dark" ? "light" : "dark";
        this.apply();
    }

    apply() {
        document.documentElement.dataset.theme = this.current.name;
        this.changed(this.current);
    }
}
