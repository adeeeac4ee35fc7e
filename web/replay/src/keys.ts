// The keyboard.

import { Player } from "./player";

export interface Actions {
    contacts(): void;
    fit(): void;
    theme(): void;
    panel(): void;
    follow(): void;
    deselect(): void;
}

export function bindKeys(player: Player, actions: Actions) {
    const keys: Record<string, (event: KeyboardEvent) => void> = {
        " ": () => player.toggle(),
        k: () => player.toggle(),
        ArrowLeft: (event) => player.stepFrames(event.shiftKey ? -10 : -1),
        ArrowRight: (event) => player.stepFrames(event.shiftKey ? 10 : 1),
        ArrowUp: () => player.shiftSpeed(1),
        ArrowDown: () => player.shiftSpeed(-1),
        Home: () => player.seek(0),
        End: () => player.seek(player.duration),
        l: () => {
            player.loop = !player.loop;
            player.seek(player.time);
        },
        c: actions.contacts,
        v: actions.fit,
        t: actions.theme,
        b: actions.panel,
        f: actions.follow,
        Escape: actions.deselect,
    };
    addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        if (event.target instanceof HTMLInputElement) return;
        const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (!act) return;
        event.preventDefault();
        act(event);
    });
    // The space bar would press the focused button as well, when it comes up.
    addEventListener("keyup", (event) => {
        if (event.key === " " && event.target instanceof HTMLButtonElement) event.preventDefault();
    });
}
