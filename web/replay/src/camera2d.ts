// A view of the plane: which point is in the middle, and how many pixels a metre takes.

import { Bounds } from "./framing";
import { Insets } from "./scene";

export class Camera2 {
    x = 0;
    y = 0;
    scale = 50; // CSS pixels a metre
    width = 1;
    height = 1;
    insets: Insets = { left: 0, right: 0, top: 0, bottom: 0 };
    /** True until the user moves the view: then it may be framed anew when the window changes. */
    untouched = true;

    constructor(element: HTMLElement, private readonly changed: () => void) {
        element.style.touchAction = "none";
        const pointers = new Map<number, { x: number; y: number }>();
        element.addEventListener("pointerdown", (event) => {
            element.setPointerCapture(event.pointerId);
            pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        });
        const release = (event: PointerEvent) => pointers.delete(event.pointerId);
        element.addEventListener("pointerup", release);
        element.addEventListener("pointercancel", release);
        element.addEventListener("pointermove", (event) => {
            const last = pointers.get(event.pointerId);
            if (!last) return;
            const now = { x: event.clientX, y: event.clientY };
            const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
            const share = 1 / pointers.size; // two fingers move the view together
            this.pan((now.x - last.x) * share, (now.y - last.y) * share);
            if (other) {
                const spread = (p: { x: number; y: number }) => Math.hypot(p.x - other.x, p.y - other.y);
                const box = element.getBoundingClientRect();
                const middle = { x: (now.x + other.x) / 2 - box.left, y: (now.y + other.y) / 2 - box.top };
                if (spread(last) > 0) this.zoom(spread(now) / spread(last), middle.x, middle.y);
            }
            pointers.set(event.pointerId, now);
        });
        element.addEventListener("wheel", (event) => {
            event.preventDefault();
            const box = element.getBoundingClientRect();
            const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 20 : 1;
            const delta = Math.max(-200, Math.min(200, event.deltaY * lines));
            this.zoom(Math.exp(-delta / 400), event.clientX - box.left, event.clientY - box.top);
        }, { passive: false });
    }

    private pan(dx: number, dy: number) {
        if (dx === 0 && dy === 0) return;
        this.x -= dx / this.scale;
        this.y += dy / this.scale;
        this.untouched = false;
        this.changed();
    }

    /** Zooms about a place on the screen, which stays over the same point of the world. */
    zoom(factor: number, x: number, y: number) {
        const [worldX, worldY] = this.toWorld(x, y);
        this.scale = Math.min(1e6, Math.max(1e-4, this.scale * factor));
        const [movedX, movedY] = this.toWorld(x, y);
        this.x += worldX - movedX;
        this.y += worldY - movedY;
        this.untouched = false;
        this.changed();
    }

    fit({ low, high }: Bounds) {
        const { left, right, top, bottom } = this.insets;
        const freeWidth = Math.max(50, this.width - left - right);
        const freeHeight = Math.max(50, this.height - top - bottom);
        const margin = 1.12;
        const wide = Math.max(1e-3, high[0] - low[0]) * margin;
        const tall = Math.max(1e-3, high[1] - low[1]) * margin;
        this.scale = Math.min(freeWidth / wide, freeHeight / tall);
        // The middle of the content goes to the middle of what the controls leave free.
        this.x = (low[0] + high[0]) / 2 - (left - right) / 2 / this.scale;
        this.y = (low[1] + high[1]) / 2 + (top - bottom) / 2 / this.scale;
        this.untouched = true;
    }

    toScreen(x: number, y: number): [number, number] {
        return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale];
    }

    toWorld(x: number, y: number): [number, number] {
        return [this.x + (x - this.width / 2) / this.scale, this.y - (y - this.height / 2) / this.scale];
    }
}
