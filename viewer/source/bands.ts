import * as three from "three";
import { colourAt } from "./fields";
import { FORCE, FORCES_COVERED } from "./messages";
import type { Frame } from "./protocol";
import { BAND_FRAGMENT, BAND_VERTEX } from "./shaders";

/** The force that the colours and widths of contacts reach to; it follows slowly, so that nothing flickers. */
export class ForceScale {
  largest = 0;

  follow({ touching, contacts }: Frame): void {
    if (contacts === 0) return;
    // Some of very many tell as much.
    const each = Math.ceil(contacts / 2000);
    const forces = new Float32Array(Math.floor((contacts - 1) / each) + 1);
    for (let k = 0; k < forces.length; k++) forces[k] = touching[6 * each * k + 5];
    forces.sort();
    const now = forces[Math.floor(FORCES_COVERED * (forces.length - 1))];
    this.largest = this.largest > 0 ? this.largest + 0.05 * (now - this.largest) : now;
  }
}

/** Where something at z appears along the picture: at `first(z)`, and every `each` up to `last`. */
export interface Images {
  first: (z: number) => number;
  last: number;
  each: number;
}

/** What a band has, and of how many numbers. */
const NAMES: [string, number][] = [["from", 3], ["to", 3], ["force", 1]];

/** The contacts of the grains as bands. */
export class Bands {
  readonly mesh: three.Mesh;
  private readonly geometry = new three.InstancedBufferGeometry();
  private attributes: three.InstancedBufferAttribute[] = [];

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

  /** Places the contacts of a frame at all places of the picture where their grains appear. */
  place(frame: Frame, largest: number, heading: number, images: Images): void {
    const { touching, position, contacts } = frame;
    let [from, to, force] = this.arrays(contacts);
    let number = 0;
    for (let k = 0; k < contacts; k++) {
      const size = touching[6 * k + 5];
      if (size <= 0) continue;
      const grain = 3 * touching[6 * k];
      const [x, y, z] = [position[grain], heading * position[grain + 1], position[grain + 2]];
      const length = heading * (touching[6 * k + 4] - z);
      for (let along = images.first(z); along <= images.last; along += images.each) {
        if (number === force.length) [from, to, force] = this.arrays(2 * number);
        from[3 * number] = along;
        from[3 * number + 1] = x;
        from[3 * number + 2] = y;
        to[3 * number] = along + length;
        to[3 * number + 1] = touching[6 * k + 2];
        to[3 * number + 2] = heading * touching[6 * k + 3];
        force[number] = size / (largest || 1);
        number += 1;
      }
    }
    for (const attribute of this.attributes) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, number * attribute.itemSize);
      attribute.needsUpdate = true;
    }
    this.geometry.instanceCount = number;
  }

  /** Arrays with room for so many contacts at least; what was in them stays. */
  private arrays(number: number): Float32Array[] {
    const [known] = this.attributes;
    if (!known || known.count < number) {
      const count = Math.ceil(1.25 * number);
      this.geometry.dispose();
      this.attributes = NAMES.map(([name, each], k) => {
        const made = new three.InstancedBufferAttribute(new Float32Array(each * count), each);
        if (known) (made.array as Float32Array).set(this.attributes[k].array);
        made.setUsage(three.DynamicDrawUsage);
        this.geometry.setAttribute(name, made);
        return made;
      });
    }
    return this.attributes.map(({ array }) => array as Float32Array);
  }
}
