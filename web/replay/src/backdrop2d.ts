// What lies behind and beside the bodies of the plane: the background, a grid in metres, the scale.

import { Camera2 } from "./camera2d";
import { cssColor } from "./materials";
import { Theme } from "./theme";

/** The length of 1, 2 or 5 times a power of ten that is at least `least`. */
function roundLength(least: number): number {
    const power = 10 ** Math.floor(Math.log10(least));
    return power * ([1, 2, 5, 10].find((factor) => factor * power >= least) ?? 10);
}

export function drawBackdrop(context: CanvasRenderingContext2D, camera: Camera2, theme: Theme, pixelRatio: number) {
    const { width, height } = camera;
    const sky = context.createLinearGradient(0, 0, 0, height);
    sky.addColorStop(0, cssColor(theme.background));
    sky.addColorStop(1, cssColor(theme.horizon));
    context.fillStyle = sky;
    context.fillRect(0, 0, width, height);
    const coarse = roundLength(90 / camera.scale);
    drawGrid(context, camera, coarse / 5, cssColor(theme.line, 0.045), pixelRatio);
    drawGrid(context, camera, coarse, cssColor(theme.line, 0.075), pixelRatio);
}

function drawGrid(
    context: CanvasRenderingContext2D,
    camera: Camera2,
    spacing: number,
    color: string,
    pixelRatio: number,
) {
    const [left, top] = camera.toWorld(0, 0);
    const [right, bottom] = camera.toWorld(camera.width, camera.height);
    // Lines of one device pixel stand on the middle of one.
    const sharp = (value: number) => (Math.floor(value * pixelRatio) + 0.5) / pixelRatio;
    context.beginPath();
    for (let i = Math.ceil(left / spacing); i * spacing <= right; ++i) {
        const x = sharp(camera.toScreen(i * spacing, 0)[0]);
        context.moveTo(x, 0);
        context.lineTo(x, camera.height);
    }
    for (let i = Math.ceil(bottom / spacing); i * spacing <= top; ++i) {
        const y = sharp(camera.toScreen(0, i * spacing)[1]);
        context.moveTo(0, y);
        context.lineTo(camera.width, y);
    }
    context.strokeStyle = color;
    context.lineWidth = 1 / pixelRatio;
    context.stroke();
}

export function drawScaleBar(context: CanvasRenderingContext2D, camera: Camera2, theme: Theme) {
    const length = roundLength(60 / camera.scale);
    const pixels = length * camera.scale;
    const x = camera.insets.left + 16;
    const y = camera.height - camera.insets.bottom - 16;
    context.strokeStyle = cssColor(theme.text, 0.55);
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, y - 4);
    context.lineTo(x, y);
    context.lineTo(x + pixels, y);
    context.lineTo(x + pixels, y - 4);
    context.stroke();
    context.fillStyle = cssColor(theme.text, 0.7);
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "bottom";
    const text = length >= 1000 ? `${length / 1000} km` : length >= 1 ? `${length} m` : `${+(length * 100).toPrecision(2)} cm`;
    context.fillText(text, x + 5, y - 3);
}
