// Small helpers to make elements of the page.

type Child = Node | string;

export function element<K extends keyof HTMLElementTagNameMap>(
    tag: K,
    properties: Partial<HTMLElementTagNameMap[K]> = {},
    ...children: Child[]
): HTMLElementTagNameMap[K] {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
}

const paths = {
    play: "M7 4.5v15l12.5-7.5z",
    pause: "M6.5 4.5h4v15h-4zM13.5 4.5h4v15h-4z",
    forward: "M6 5l9 7-9 7zM16 5h2.5v14H16z",
    back: "M18 5l-9 7 9 7zM5.5 5H8v14H5.5z",
};

const strokes = {
    loop: "M17 3l3 3-3 3M20 6H8a4 4 0 0 0-4 4v1M7 21l-3-3 3-3M4 18h12a4 4 0 0 0 4-4v-1",
    contacts: "M7.5 7.5a4.5 4.5 0 1 0 0 9 4.5 4.5 0 0 0 0-9zM16.5 7.5a4.5 4.5 0 1 0 0 9 4.5 4.5 0 0 0 0-9zM12 4v3M12 17v3",
    fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
    sun: "M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM12 2v2M12 20v2M4.9 4.9l1.4 1.4M17.7 17.7l1.4 1.4M2 12h2M20 12h2M4.9 19.1l1.4-1.4M17.7 6.3l1.4-1.4",
    moon: "M20 14.5A8.5 8.5 0 0 1 9.5 4 8.5 8.5 0 1 0 20 14.5z",
    list: "M9 6h11M9 12h11M9 18h11M4.5 6h.01M4.5 12h.01M4.5 18h.01",
    close: "M6 6l12 12M18 6L6 18",
    target: "M12 5a7 7 0 1 0 0 14 7 7 0 0 0 0-14zM12 2v5M12 17v5M2 12h5M17 12h5",
    help: "M9 9a3 3 0 1 1 4.5 2.6c-1 .6-1.5 1.1-1.5 2.4M12 17.5h.01",
};

export type Icon = keyof typeof paths | keyof typeof strokes;

export function icon(name: Icon): SVGSVGElement {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("viewBox", "0 0 24 24");
    svg.setAttribute("aria-hidden", "true");
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", name in paths ? paths[name as keyof typeof paths] : strokes[name as keyof typeof strokes]);
    svg.classList.add(name in paths ? "filled" : "stroked");
    svg.append(path);
    return svg;
}

export function button(name: Icon, title: string, clicked: () => void): HTMLButtonElement {
    const made = element("button", { type: "button", title, className: "icon", onclick: clicked }, icon(name));
    made.setAttribute("aria-label", title);
    return made;
}

export function setIcon(target: HTMLButtonElement, name: Icon, title: string) {
    if (target.title === title) return;
    target.replaceChildren(icon(name));
    target.title = title;
    target.setAttribute("aria-label", title);
}

export function setPressed(target: HTMLButtonElement, on: boolean) {
    target.setAttribute("aria-pressed", String(on));
}
