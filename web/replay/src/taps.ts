// A tap is a press and release in one place; anything else is a drag, which moves the camera.

const slack = 5; // CSS pixels

export function watchTaps(element: HTMLElement, tapped: (x: number, y: number) => void) {
    let start: { id: number; x: number; y: number } | null = null;
    element.addEventListener("pointerdown", (event) => {
        start = event.isPrimary && event.button === 0 ? { id: event.pointerId, x: event.clientX, y: event.clientY } : null;
    });
    element.addEventListener("pointerup", (event) => {
        if (!start || start.id !== event.pointerId) return;
        if (Math.hypot(event.clientX - start.x, event.clientY - start.y) <= slack) {
            const box = element.getBoundingClientRect();
            tapped(event.clientX - box.left, event.clientY - box.top);
        }
        start = null;
    });
}
