// What a link asks of the page: replay.html#t=2.5&play&theme=dark&select=crate …

export interface Options {
    time: number;
    play: boolean;
    speed: number;
    theme: "dark" | "light" | null;
    contacts: boolean;
    select: string | null;
    follow: boolean;
    panel: boolean | null;
    /** False for a picture without any controls. */
    controls: boolean;
    /** Of the picture in 3D; null: high where a graphics processor draws it. */
    quality: "high" | "low" | null;
    /** 3D: azimuth and elevation in degrees, and how near; 2D: how near alone. */
    view: number[];
}

export function readOptions(hash: string): Options {
    const given = new URLSearchParams(hash.replace(/^#/, ""));
    const number = (name: string, otherwise: number) => {
        const value = Number.parseFloat(given.get(name) ?? "");
        return Number.isFinite(value) ? value : otherwise;
    };
    const on = (name: string, otherwise: boolean) =>
        given.has(name) ? !["0", "off", "false"].includes(given.get(name)!) : otherwise;
    const theme = given.get("theme");
    const quality = given.get("quality");
    return {
        time: number("t", 0),
        play: on("play", false),
        speed: number("speed", 1),
        theme: theme === "dark" || theme === "light" ? theme : null,
        contacts: on("contacts", false),
        select: given.get("select"),
        follow: on("follow", false),
        panel: given.has("panel") ? on("panel", true) : null,
        controls: on("controls", true),
        quality: quality === "high" || quality === "low" ? quality : null,
        view: (given.get("view") ?? "")
            .split(",")
            .map(Number)
            .filter((value, _, all) => all.every(Number.isFinite) && value !== 0),
    };
}
