/** What the server sends and takes, besides its types: the bytes of a frame, as in crates/viewer/src/frame.rs, and units. */
import type { Head, Notice, Sliders, Welcome } from "./messages";

export type { Command, Row, Steered, Turn, Welcome } from "./messages";
export type Driven = Sliders<number>;
export type Told = Welcome | Notice;
export type Saved = Extract<Notice, { type: "saved" }>;
/** What takes a run like this one to the same bits. */
export type Course = Extract<Notice, { type: "course" }>;

/** The unit of clocks. */
export const unitOfTime = ({ unit_period }: Welcome): "T" | "t" => (unit_period === null ? "t" : "T");

/** The label of an axis of time. */
export const timeAxis = (tube: Welcome): string => (unitOfTime(tube) === "T" ? "time / periods T" : "time / t");

/** The spheres at one time; vectors as x y z x y z ... in the frame of the tube. */
export interface Frame extends Head {
  bytes: number;
  /** NaN of a grain that waits outside an open tube. */
  position: Float32Array;
  velocity: Float32Array;
  diameter: Float32Array;
  /** Angular velocities, or nothing where grains do not turn. */
  spin: Float32Array;
  /** Centres of the spheres of an elastic wall. */
  wall: Float32Array;
  /** Radii of the rings of one wavelength of a prescribed wall. */
  ringRadius: Float32Array;
  /** Contacts: grain, partner or -1 for the wall, x y z of the partner, normal force. */
  touching: Float32Array;
}

/** Takes a frame apart; its arrays look into the bytes, nothing is copied. */
export function decode(bytes: ArrayBuffer): Frame {
  const headBytes = new DataView(bytes).getUint32(0, true);
  const text = new TextDecoder().decode(new Uint8Array(bytes, 4, headBytes));
  const head = JSON.parse(text) as Head;
  let at = 4 + headBytes;
  const take = (count: number) => {
    const numbers = new Float32Array(bytes, at, count);
    at += 4 * count;
    return numbers;
  };
  return {
    ...head,
    bytes: bytes.byteLength,
    position: take(3 * head.grains),
    velocity: take(3 * head.grains),
    diameter: take(head.grains),
    spin: take(head.turning ? 3 * head.grains : 0),
    wall: take(3 * head.wall_spheres),
    ringRadius: take(head.rings),
    touching: take(6 * head.contacts),
  };
}
