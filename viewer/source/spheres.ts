import * as three from "three";
import { FRAGMENT, VERTEX } from "./shaders";

/** Which spheres of a set are drawn. */
export enum Side {
  All = 0,
  Back = 1,
  Front = 2,
}

/** Arrays of spheres in the graphics memory; grows as needed. */
export class Spheres {
  readonly geometry = new three.InstancedBufferGeometry();
  private capacity = 0;
  centre = new three.InstancedBufferAttribute(new Float32Array(0), 3);
  radius = new three.InstancedBufferAttribute(new Float32Array(0), 1);
  value = new three.InstancedBufferAttribute(new Float32Array(0), 1);

  constructor() {
    const corners = new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]);
    this.geometry.setAttribute("position", new three.BufferAttribute(corners, 3));
    this.geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.geometry.instanceCount = 0;
    this.reserve(1);
  }

  /** Makes room for so many; what was there is lost where there was less. */
  reserve(number: number): void {
    if (number <= this.capacity) return;
    this.capacity = Math.ceil(1.25 * number);
    const attribute = (name: string, size: number) => {
      const made = new three.InstancedBufferAttribute(new Float32Array(size * this.capacity), size);
      made.setUsage(three.DynamicDrawUsage);
      this.geometry.setAttribute(name, made);
      return made;
    };
    this.geometry.dispose();
    this.centre = attribute("centre", 3);
    this.radius = attribute("radius", 1);
    this.value = attribute("value", 1);
  }

  /** Says that so many were written. */
  written(number: number): void {
    this.geometry.instanceCount = number;
    for (const attribute of [this.centre, this.radius, this.value]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, number * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }
}

export type Uniforms = Record<string, three.IUniform>;

/** A way to draw spheres. */
export function drawn(spheres: Spheres, shared: Uniforms, own: Uniforms, glass: boolean): three.Mesh {
  const material = new three.RawShaderMaterial({
    glslVersion: three.GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: { ...shared, ...own },
    transparent: glass,
    depthWrite: !glass,
  });
  const mesh = new three.Mesh(spheres.geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}
