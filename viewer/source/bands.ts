import * as three from "three";
import { type Colour, colourAt } from "./fields";
import type { Frame } from "./protocol";
import { BAND_FRAGMENT, BAND_VERTEX } from "./shaders";

/** Normal forces from weak to strong, to be seen on a dark stage. */
export const FORCE: Colour[] = [[70, 60, 110], [150, 50, 120], [225, 80, 60], [255, 170, 50], [255, 250, 190]];
/** Part of the contacts whose force lies within the colours. */
const COVERED = 0.97;

/** The force that the colours and widths of contacts reach to; it follows slowly, so that nothing flickers. */
export class ForceScale {
  largest = 0;

  follow({ touching, contacts }: Frame): void {
    if (contacts === 0) return;
    const forces = Float32Array.from({ length: contacts }, (_, k) => touching[6 * k + 5]).sort();
    const now = forces[Math.floor(COVERED * (contacts - 1))];
    this.largest = this.largest > 0 ? this.largest + 0.05 * (now - this.largest) : now;
  }
}

/** The contacts of the grains as bands. */
export class Bands {
  readonly mesh: three.Mesh;
  private readonly geometry = new three.InstancedBufferGeometry();
  private capacity = 0;
  private readonly attributes = new Map<string, three.InstancedBufferAttribute>();

  constructor() {
    this.geometry.setAttribute("position", new three.BufferAttribute(new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3));
    this.geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const texels = new Uint8Array(4 * 64);
    for (let k = 0; k < 64; k++) texels.set([...colourAt(FORCE, k / 63), 255], 4 * k);
    const scale = new three.DataTexture(texels, 64, 1);
    scale.magFilter = three.LinearFilter;
    scale.needsUpdate = true;
    const material = new three.RawShaderMaterial({
      glslVersion: three.GLSL3, vertexShader: BAND_VERTEX, fragmentShader: BAND_FRAGMENT, side: three.DoubleSide,
      uniforms: { scale: { value: scale } },
    });
    this.mesh = new three.Mesh(this.geometry, material);
    this.mesh.frustumCulled = false;
  }

  /** Places the contacts of a frame; `images` says at which places along the picture a grain appears, and where z lies. */
  place(frame: Frame, largest: number, heading: number, images: (z: number) => number[]): void {
    const { touching, position, contacts } = frame;
    const [from, to, force]: number[][] = [[], [], []];
    for (let k = 0; k < contacts; k++) {
      const [grain, x, y, z, size] = [touching[6 * k], touching[6 * k + 2], touching[6 * k + 3], touching[6 * k + 4], touching[6 * k + 5]];
      if (size <= 0) continue;
      const place = position[3 * grain + 2];
      for (const along of images(place)) {
        from.push(along, position[3 * grain], heading * position[3 * grain + 1]);
        to.push(along + heading * (z - place), x, heading * y);
        force.push(size / (largest || 1));
      }
    }
    if (force.length > this.capacity) {
      this.capacity = Math.ceil(1.25 * force.length);
      this.geometry.dispose();
      for (const [name, each] of [["from", 3], ["to", 3], ["force", 1]] as const) {
        const made = new three.InstancedBufferAttribute(new Float32Array(each * this.capacity), each);
        made.setUsage(three.DynamicDrawUsage);
        this.geometry.setAttribute(name, made);
        this.attributes.set(name, made);
      }
    }
    for (const [name, values] of Object.entries({ from, to, force })) {
      const attribute = this.attributes.get(name);
      if (!attribute) continue;
      (attribute.array as Float32Array).set(values);
      attribute.needsUpdate = true;
    }
    this.geometry.instanceCount = force.length;
  }
}
