import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Ink } from "./charts";
import { Bands, ForceScale, type Images } from "./bands";
import { colourAt, type Field, partsOf, stops } from "./fields";
import { type Colour, SHRUNK, STONE } from "./messages";
import type { Frame, Welcome } from "./protocol";
import { drawn, Side, Spheres, type Uniforms } from "./spheres";

export const WALLS = ["cut open", "glass", "closed", "hidden"] as const;
export type WallLook = (typeof WALLS)[number];

const FIELD_OF_VIEW = 24;
/** Milliseconds that the browser takes for a picture above which pixels are saved, and below which they come back. */
const SLOW = 55;
const QUICK = 24;
/** Pictures that are quick, one after the other, before pixels come back. */
const PATIENCE = 90;
/** Length of the tube and its images in the picture at most, in radii. */
const LONGEST = 60;
/** Spheres of the wall in one picture, about: where there would be more, fewer and larger ones stand for them. */
const WALL_SPHERES = 9000;
/** Milliseconds after which a picture counts as still. */
const STILL = 700;

/** The tube in space: grains and wall, the camera, and what is under a finger. */
export class Scene {
  readonly renderer: three.WebGLRenderer;
  /** z of what is in the middle of the picture. */
  middle = 0;
  wall: WallLook = "cut open";
  marks = false;
  lightness = false;
  picked = -1;
  /** Whether the forces between grains are drawn. */
  contacts = false;
  readonly forces = new ForceScale();
  /** How many were drawn. */
  pictures = 0;
  private readonly scene = new three.Scene();
  private readonly camera = new three.PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 2000);
  private readonly orbit: OrbitControls;
  private readonly grains = new Spheres();
  private readonly wallSpheres = new Spheres();
  private readonly meshes: { wallBack: three.Mesh; wallFront: three.Mesh; wallAll: three.Mesh };
  private readonly shared: Uniforms;
  private readonly grainUniforms: Uniforms;
  private readonly wallUniforms: Uniforms;
  private readonly bands = new Bands();
  private readonly scaleTexture: three.DataTexture;
  /** The colours that are in it. */
  private scale: Colour[] = [];
  private frame: Frame | null = null;
  private stale = true;
  /** Part of the full resolution that is drawn: less where pictures take too long. */
  private fineness = 1;
  private drawnAt = 0;
  private sharp = false;
  private interval = 0;
  private quick = 0;
  private wait = PATIENCE;
  private hasSign = false;
  /** Where each grain lies on the scale of the colours, from 0 to 1. */
  values = new Float32Array(0);

  constructor(private readonly canvas: HTMLCanvasElement, private tube: Welcome) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: false, alpha: false, preserveDrawingBuffer: true });
    this.scaleTexture = new three.DataTexture(new Uint8Array(4 * 256), 256, 1);
    this.scaleTexture.magFilter = this.scaleTexture.minFilter = three.LinearFilter;
    this.shared = {
      reach: { value: tube.radius },
      eye: { value: new three.Vector3() },
      rim: { value: new three.Color(0, 0, 0) },
      scale: { value: this.scaleTexture },
    };
    this.grainUniforms = this.own(0, Side.All, 0);
    this.wallUniforms = this.own(1, Side.Back, 0);
    const front = this.own(1, Side.Front, 0.12);
    this.meshes = {
      wallBack: drawn(this.wallSpheres, this.shared, this.wallUniforms, false),
      wallFront: drawn(this.wallSpheres, this.shared, front, true),
      wallAll: drawn(this.wallSpheres, this.shared, this.own(1, Side.All, 0), false),
    };
    this.scene.add(drawn(this.grains, this.shared, this.grainUniforms, false), ...Object.values(this.meshes), this.bands.mesh);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enablePan = false;
    this.orbit.enableDamping = true;
    this.orbit.dampingFactor = 0.12;
    this.orbit.addEventListener("change", () => this.touch());
    this.resize();
    this.open(tube);
  }

  /** Another tube, from the first place. */
  open(tube: Welcome): void {
    this.tube = tube;
    this.frame = null;
    this.picked = -1;
    this.forces.largest = 0;
    this.shared.reach.value = tube.radius;
    this.middle = 0.5 * Math.min(tube.length, 3 * tube.wavelength);
    this.home();
  }

  private own(kind: number, side: Side, glass: number): Uniforms {
    const stone = new three.Color().setRGB(STONE[0] / 255, STONE[1] / 255, STONE[2] / 255);
    return {
      kind: { value: kind },
      side: { value: side },
      glass: { value: glass },
      shrink: { value: 1 },
      marks: { value: 0 },
      picked: { value: -1 },
      plain: { value: stone },
    };
  }

  /** From a little above: two waves across, one and a half on a phone, and the tube from top to bottom. */
  home(): void {
    const narrow = this.canvas.clientWidth < 600;
    const most = (narrow ? 1.25 : 2) * this.tube.wavelength;
    const shown = this.tube.open ? Math.min(most, 1.35 * this.tube.length) : most;
    const slope = Math.tan((0.5 * FIELD_OF_VIEW * Math.PI) / 180);
    const distance = (0.5 * shown) / (slope * this.camera.aspect);
    const least = (1.25 * this.tube.radius) / slope;
    this.camera.position.set(-0.42, 0.24, 1).setLength(Math.max(distance, least) + this.tube.radius);
    this.orbit.target.set(0, 0, 0);
    this.orbit.minDistance = 2.2 * this.tube.radius;
    this.orbit.maxDistance = Math.max(4 * this.tube.length, 8 * this.tube.wavelength);
    this.orbit.update();
    this.touch();
  }

  /** Turns round the tube, or nearer. */
  move(around: number, up: number, nearer: number): void {
    const spherical = new three.Spherical().setFromVector3(this.camera.position);
    spherical.theta += around;
    spherical.phi = Math.min(Math.PI - 0.05, Math.max(0.05, spherical.phi + up));
    spherical.radius = Math.min(this.orbit.maxDistance, Math.max(this.orbit.minDistance, spherical.radius * nearer));
    this.camera.position.setFromSpherical(spherical);
    this.orbit.update();
    this.touch();
  }

  /** From where the tube is looked at. */
  get eye(): number[] {
    return this.camera.position.toArray();
  }

  set eye(place: number[]) {
    this.camera.position.set(place[0], place[1], place[2]);
    this.orbit.update();
    this.touch();
  }

  /** Looks as an address says, as far as it does. */
  lookAs({ wall, eye, middle }: { wall?: string; eye?: number[]; middle?: number }): void {
    this.wall = WALLS.find((look) => look === wall) ?? this.wall;
    if (eye) this.eye = eye;
    this.middle = this.folded(middle ?? this.middle);
  }

  /** Part of the full resolution that pictures which follow one another have. */
  get part(): number {
    return this.fineness;
  }

  slide(distance: number): void {
    this.middle = this.folded(this.middle + this.tube.heading * distance);
    this.touch();
  }

  /** A place along the tube, from 0 to its length. */
  private folded(place: number): number {
    const { length } = this.tube;
    return ((place % length) + length) % length;
  }

  touch(): void {
    this.stale = true;
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.renderer.setPixelRatio(this.fineness * Math.min(2, Math.max(1.5, devicePixelRatio)));
    this.renderer.setSize(Math.max(1, width), Math.max(1, height), false);
    this.camera.aspect = Math.max(1, width) / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    this.touch();
  }

  show(frame: Frame, field: Field): void {
    this.frame = frame;
    this.hasSign = field.diverging;
    const number = frame.grains;
    if (this.values.length !== number) this.values = new Float32Array(number);
    partsOf(field, frame, this.tube, this.values);
    const scale = stops(field, this.lightness);
    if (scale !== this.scale) {
      this.scale = scale;
      const texels = this.scaleTexture.image.data as Uint8Array;
      for (let i = 0; i < 256; i++) texels.set([...colourAt(scale, i / 255), 255], 4 * i);
      this.scaleTexture.needsUpdate = true;
    }
    this.touch();
  }

  /** Draws, where there is something new; `since` are the milliseconds that the browser took for the picture before. */
  draw({ text, stageMiddle, stageEdge }: Ink, since: number): void {
    this.orbit.update();
    if (!this.stale) this.sharpen();
    if (!this.stale || !this.frame) return;
    // Another size empties the canvas, so it comes before the picture.
    this.keepUp(performance.now(), since);
    this.stale = false;
    this.backdrop(stageMiddle, stageEdge);
    (this.shared.rim.value as three.Color).setStyle(text, three.LinearSRGBColorSpace);
    (this.shared.eye.value as three.Vector3).copy(this.camera.position).normalize();
    this.grainUniforms.marks.value = this.marks && this.hasSign ? 1 : 0;
    const shows = this.contacts && this.frame.contacts > 0;
    this.grainUniforms.shrink.value = shows ? SHRUNK : 1;
    const images = this.images();
    this.placeGrains(this.frame, images);
    this.bands.mesh.visible = shows;
    if (shows) {
      this.forces.follow(this.frame);
      this.bands.place(this.frame, this.forces.largest, this.tube.heading, images);
    }
    this.meshes.wallBack.visible = this.wall === "cut open";
    this.meshes.wallFront.visible = this.wall === "cut open" || this.wall === "glass";
    this.meshes.wallAll.visible = this.wall === "closed";
    const front = (this.meshes.wallFront.material as three.RawShaderMaterial).uniforms;
    front.side.value = this.wall === "glass" ? Side.All : Side.Front;
    if (this.wall !== "hidden") this.placeWall(this.frame, images);
    this.renderer.render(this.scene, this.camera);
    this.pictures += 1;
  }

  /** Draws a picture that stands still once more with all its pixels. */
  private sharpen(): void {
    const still = performance.now() - this.drawnAt > STILL;
    if (this.fineness === 1 || this.sharp || !still) return;
    const usual = this.fineness;
    this.fineness = 1;
    this.resize();
    this.fineness = usual;
    this.sharp = true;
  }

  /** Draws fewer pixels where the browser is slow with pictures that follow one another, and more again where it is quick. */
  private keepUp(now: number, took: number): void {
    const since = now - this.drawnAt;
    this.drawnAt = now;
    if (since > STILL) return;
    if (this.sharp) {
      this.sharp = false;
      this.resize();
    }
    this.interval += 0.2 * (took - this.interval);
    this.quick = this.interval < QUICK ? this.quick + 1 : 0;
    if (this.interval > SLOW && this.fineness >= 0.5) {
      this.refine(0.8 * this.fineness);
    } else if (this.quick > this.wait && this.fineness < 1) {
      this.refine(Math.min(1, this.fineness / 0.8));
      // The next time it waits longer, so that pictures do not go to and fro.
      this.wait = Math.min(20 * PATIENCE, 2 * this.wait);
    }
  }

  private refine(fineness: number): void {
    this.fineness = fineness;
    [this.interval, this.quick] = [0.5 * (SLOW + QUICK), 0];
    this.resize();
  }

  /** Paints what is behind the tube, where its colours have changed. */
  private backdrop(middle: string, edge: string): void {
    const name = `${middle} ${edge}`;
    if (this.scene.background instanceof three.Texture) {
      if (this.scene.background.name === name) return;
      this.scene.background.dispose();
    }
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 256;
    const context = canvas.getContext("2d");
    if (!context) return;
    const gradient = context.createRadialGradient(128, 60, 0, 128, 60, 230);
    gradient.addColorStop(0, middle);
    gradient.addColorStop(1, edge);
    context.fillStyle = gradient;
    context.fillRect(0, 0, 256, 256);
    const texture = new three.CanvasTexture(canvas);
    texture.colorSpace = three.SRGBColorSpace;
    texture.name = name;
    this.scene.background = texture;
  }

  /** Half of the length that is in the picture. */
  halfShown(): number {
    const away = this.camera.position.length() + this.tube.reach;
    return away * Math.tan((0.5 * FIELD_OF_VIEW * Math.PI) / 180) * this.camera.aspect * 1.1 + this.tube.radius;
  }

  /** Half of the length that can be in the picture, of a tube that goes on and on. */
  private halfSeen(): number {
    const side = this.camera.position;
    // Looking along the tube one sees far.
    const oblique = 1 / Math.max(0.05, 1 - 1.5 * (Math.abs(side.x) / side.length()));
    return Math.min(oblique * this.halfShown(), LONGEST * this.tube.radius);
  }

  /** Where something at z appears along the picture: again and again, or once where the ends of the tube are open. */
  private images(): Images {
    const { heading, length, open } = this.tube;
    const { middle } = this;
    const last = this.halfSeen();
    if (open) return { first: (z) => heading * (z - middle), last, each: Infinity };
    return { first: (z) => along(heading * (z - middle)), last, each: length };

    function along(place: number): number {
      return place + Math.ceil((-last - place) / length) * length;
    }
  }

  /** The grains that are in the picture: of a long tube few, of a short one with their images. */
  private placeGrains(frame: Frame, images: Images): void {
    const { grains, tube } = this;
    const { heading } = tube;
    this.camera.updateMatrixWorld();
    const projection = new three.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    const { planes } = new three.Frustum().setFromProjectionMatrix(projection);
    // The near and the far end of the picture leave nothing out that its sides would not.
    const sides = planes.slice(0, 4);
    grains.reserve(frame.grains * (1 + Math.ceil((2 * this.halfSeen()) / tube.length)));
    const [centre, radius, value] = [grains.centre.array, grains.radius.array, grains.value.array];
    this.grainUniforms.picked.value = -1;
    let number = 0;
    for (let i = 0; i < frame.grains; i++) {
      const [x, y] = [frame.position[3 * i], heading * frame.position[3 * i + 1]];
      // With room for the ring round a grain that was picked.
      const room = -0.7 * frame.diameter[i];
      for (let along = images.first(frame.position[3 * i + 2]); along <= images.last; along += images.each) {
        if (sides.some(({ normal, constant }) => normal.x * along + normal.y * x + normal.z * y + constant < room)) continue;
        centre[3 * number] = along;
        centre[3 * number + 1] = x;
        centre[3 * number + 2] = y;
        radius[number] = 0.5 * frame.diameter[i];
        value[number] = this.values[i];
        if (i === this.picked) this.grainUniforms.picked.value = number;
        number += 1;
      }
    }
    grains.written(number);
  }

  /** The wall's spheres that can be in the picture. */
  private placeWall(frame: Frame, images: Images): void {
    const { tube, wallSpheres } = this;
    const { heading } = tube;
    const spacing = tube.wavelength / tube.rings_per_wave;
    const half = this.halfSeen();
    const seen = ((2 * half) / spacing) * tube.spheres_per_ring;
    const each = Math.max(1, Math.ceil(seen / WALL_SPHERES));
    const size = 0.5 * tube.wall_sphere_diameter * Math.sqrt(each);
    let number = 0;
    const put = (along: number, x: number, y: number) => {
      const { array } = wallSpheres.centre;
      array[3 * number] = along;
      array[3 * number + 1] = x;
      array[3 * number + 2] = heading * y;
      wallSpheres.radius.array[number] = size;
      number += 1;
    };
    if (frame.wall_spheres > 0) {
      wallSpheres.reserve(Math.ceil(frame.wall_spheres / each) * (1 + Math.ceil((2 * half) / tube.length)));
      for (let i = 0; i < frame.wall_spheres; i += each)
        for (let along = images.first(frame.wall[3 * i + 2]); along <= images.last; along += images.each)
          put(along, frame.wall[3 * i], frame.wall[3 * i + 1]);
    } else {
      // Some of each ring and some of the rings, the same ones wherever one looks from.
      const round = Math.min(3, each);
      const on = Math.ceil(each / round);
      const rings = tube.rings_per_wave * tube.waves;
      const [from, to] = tube.open ? [0, rings - 1] : [-Infinity, Infinity];
      const first = on * Math.ceil(Math.max(from, (this.middle - half) / spacing) / on);
      const last = Math.floor(Math.min(to, (this.middle + half) / spacing));
      wallSpheres.reserve((Math.max(0, last - first) / on + 2) * (tube.spheres_per_ring / round + 1));
      for (let unfolded = first; unfolded <= last; unfolded += on) {
        const ring = ((unfolded % rings) + rings) % rings;
        const radius = frame.ringRadius[ring % tube.rings_per_wave];
        for (let place = 0; place < tube.spheres_per_ring; place += round) {
          const angle = ((2 * place + (ring % 2)) * Math.PI) / tube.spheres_per_ring;
          put(heading * (unfolded * spacing - this.middle), radius * Math.cos(angle), radius * Math.sin(angle));
        }
      }
    }
    wallSpheres.written(number);
  }

  /** The grain at a place of the canvas from -1 to 1, or -1. */
  pick(x: number, y: number): number {
    const frame = this.frame;
    if (!frame) return -1;
    const { origin, direction } = this.ray(x, y);
    const { heading } = this.tube;
    const images = this.images();
    let nearest = Infinity;
    let found = -1;
    const centre = new three.Vector3();
    for (let i = 0; i < frame.grains; i++) {
      for (let along = images.first(frame.position[3 * i + 2]); along <= images.last; along += images.each) {
        centre.set(along, frame.position[3 * i], heading * frame.position[3 * i + 1]).sub(origin);
        const ahead = centre.dot(direction);
        const room = (0.5 * frame.diameter[i]) ** 2 - centre.lengthSq() + ahead * ahead;
        if (room < 0 || ahead < 0 || ahead - Math.sqrt(room) >= nearest) continue;
        nearest = ahead - Math.sqrt(room);
        found = i;
      }
    }
    return found;
  }

  /** The grain after the picked one along the wave, or, where none is picked, the nearest to the middle of the picture. */
  next(): number {
    const { frame, picked, tube } = this;
    if (!frame) return -1;
    const place = (i: number) => tube.heading * frame.position[3 * i + 2];
    const isSeen = picked >= 0 && !Number.isNaN(place(picked));
    const from = isSeen ? place(picked) : tube.heading * this.middle;
    let [best, found] = [Infinity, -1];
    for (let i = 0; i < frame.grains; i++) {
      const ahead = place(i) - from;
      const round = ((ahead % tube.length) + tube.length) % tube.length;
      const away = isSeen ? round : Math.min(round, tube.length - round);
      // One that waits outside is nowhere.
      if (i === picked || !(away < best)) continue;
      [best, found] = [away, i];
    }
    return found;
  }

  private ray(x: number, y: number): { origin: three.Vector3; direction: three.Vector3 } {
    const caster = new three.Raycaster();
    caster.setFromCamera(new three.Vector2(x, y), this.camera);
    return caster.ray;
  }
}
