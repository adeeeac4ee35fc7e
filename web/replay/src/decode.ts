// From the text in the page to numbers. See docs/replay-format.md.

import { Channel, ColumnHeader, Header, Recording } from "./recording";

function textOf(id: string): string {
    const element = document.getElementById(id);
    if (!element) throw new Error(`the page has no element ${id}`);
    return element.textContent!.trim();
}

async function inflate(base64: string): Promise<Uint8Array> {
    const binary = atob(base64);
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Takes columns off the inflated bytes, in the order in which they were written. */
class ColumnReader {
    private at = 0;
    constructor(private readonly bytes: Uint8Array) {}

    next(header: ColumnHeader, length: number): Int32Array {
        const values = new Int32Array(length);
        for (let plane = 0; plane < header.planes; ++plane) {
            const start = this.at + plane * length;
            const shift = 8 * plane;
            for (let i = 0; i < length; ++i) values[i] |= this.bytes[start + i] << shift;
        }
        for (let i = 0; i < length; ++i) values[i] = (values[i] >>> 1) ^ -(values[i] & 1);
        this.at += header.planes * length;
        if (this.at > this.bytes.length) throw new Error(`the recording ends within ${header.name}`);
        return values;
    }
}

/** Undoes the differences in time: each series of `frames` values is summed up `order` times. */
function sum(values: Int32Array, frames: number, order: number) {
    for (let k = 0; k < order; ++k)
        for (let start = 0; start < values.length; start += frames)
            for (let i = start + 1; i < start + frames; ++i) values[i] += values[i - 1];
}

export function readHeader(): Header {
    const header = JSON.parse(textOf("carom-header")) as Header;
    if (header.carom_replay !== 1) throw new Error(`this page plays replays of version 1, not ${header.carom_replay}`);
    return header;
}

export async function readRecording(header: Header): Promise<Recording> {
    const columns = new ColumnReader(await inflate(textOf("carom-motion")));
    const channels = new Map<string, Channel>();
    for (const channel of header.motion.channels) {
        const values = columns.next(channel, header.bodies.length * header.frames);
        sum(values, header.frames, channel.order);
        channels.set(channel.name, { values, scale: channel.scale });
    }
    return new Recording(header, channels);
}

/** The contacts of the recorded frames, one after another; `first[i]` is where the i-th such frame begins. */
export interface Contacts {
    every: number;
    first: Uint32Array;
    a: Int32Array;
    b: Int32Array;
    /** Dimension numbers a contact. */
    positions: Float64Array;
    normals: Float32Array;
    impulses: Float32Array;
    /** An impulse that only one contact in twenty exceeds, to draw the others by. */
    greatImpulse: number;
}

export async function readContacts(recording: Recording): Promise<Contacts> {
    const { header, dimension } = recording;
    const { every, total, columns } = header.contacts;
    const reader = new ColumnReader(await inflate(textOf("carom-contacts")));
    const recorded = Math.ceil(header.frames / every);
    const counts = reader.next(columns[0], recorded);
    const [a, b, ...values] = columns.slice(1).map((column) => reader.next(column, total));

    const first = new Uint32Array(recorded + 1);
    for (let frame = 0; frame < recorded; ++frame) {
        first[frame + 1] = first[frame] + counts[frame];
        sumPairs(a, b, first[frame], first[frame + 1]);
        if (frame > 0) addMatches(a, b, values, first, frame);
    }

    const contacts: Contacts = {
        every,
        first,
        a,
        b,
        positions: new Float64Array(total * dimension),
        normals: new Float32Array(total * dimension),
        impulses: new Float32Array(total),
        greatImpulse: 0,
    };
    for (let frame = 0; frame < recorded; ++frame)
        for (let i = first[frame]; i < first[frame + 1]; ++i) {
            const reference = recording.bodies[a[i]].type === "fixed" ? b[i] : a[i];
            for (let axis = 0; axis < dimension; ++axis) {
                contacts.positions[i * dimension + axis] =
                    recording.coordinate(reference, frame * every, axis) +
                    values[axis][i] * header.contacts.position_scale;
                contacts.normals[i * dimension + axis] =
                    values[dimension + axis][i] * header.contacts.normal_scale;
            }
            contacts.impulses[i] =
                header.contacts.impulse_unit *
                (2 ** (values[2 * dimension][i] / header.contacts.impulse_steps) - 1);
        }
    const sorted = contacts.impulses.filter((impulse) => impulse > 0).sort();
    contacts.greatImpulse = sorted[Math.floor(sorted.length * 0.95)] ?? 1;
    return contacts;
}

/** Pairs are written as differences along the list of a frame. */
function sumPairs(a: Int32Array, b: Int32Array, begin: number, end: number) {
    let lastA = 0;
    let lastB = 0;
    for (let i = begin; i < end; ++i) {
        a[i] += lastA;
        b[i] += a[i] === lastA ? lastB : a[i];
        lastA = a[i];
        lastB = b[i];
    }
}

/** Values are written as differences from the same contact in the frame before, if it was there. */
function addMatches(a: Int32Array, b: Int32Array, values: Int32Array[], first: Uint32Array, frame: number) {
    let match = first[frame - 1];
    for (let i = first[frame]; i < first[frame + 1]; ++i) {
        while (match < first[frame] && (a[match] < a[i] || (a[match] === a[i] && b[match] < b[i]))) ++match;
        if (match === first[frame]) return;
        if (a[match] !== a[i] || b[match] !== b[i]) continue;
        for (const column of values) column[i] += column[match];
        ++match;
    }
}

/** The range of the contacts that belong to a frame: of the nearest recorded frame before it. */
export function contactsOf(contacts: Contacts, frame: number): [number, number] {
    const recorded = Math.min(contacts.first.length - 2, Math.floor(frame / contacts.every));
    return recorded < 0 ? [0, 0] : [contacts.first[recorded], contacts.first[recorded + 1]];
}
