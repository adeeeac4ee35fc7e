// What the page asks of a picture of the world, in the plane or in space.

import { Contacts } from "./decode";
import { Theme } from "./theme";

export interface Scene {
    /** The element that shows it. */
    readonly element: HTMLElement;
    /** Moves everything to a time; cheap enough for every frame. */
    update(time: number): void;
    /** Lets a camera that is still swinging out move on; tells whether it did. */
    tick(): boolean;
    /** Puts it on the screen. */
    draw(): void;
    resize(width: number, height: number, pixelRatio: number): void;
    /** The part of the element that controls leave free, for framing: insets in CSS pixels. */
    setInsets(insets: Insets): void;
    setTheme(theme: Theme): void;
    setContacts(contacts: Contacts | null): void;
    /** Highlights a body; −1 for none. */
    select(body: number): void;
    follow(on: boolean): void;
    /** The body at a place in CSS pixels, or −1. */
    pick(x: number, y: number): number;
    /** Shows all of the motion again. */
    fit(): void;
    /** See `Options.view`. */
    setView(view: number[]): void;
    /** Called by the scene when it wants to be drawn again (the user moved the camera). */
    onChange: () => void;
    /** Draw calls and triangles of the last picture, where there are such. */
    cost(): { calls: number; triangles: number };
}

export interface Insets {
    left: number;
    right: number;
    top: number;
    bottom: number;
}
