import type { Ink } from "./charts";
import { colourAt, css, type Field, inWave, stops } from "./fields";
import { outline } from "./plots";
import type { Frame, Welcome } from "./protocol";

/** The tube from the side as circles in a plane, where a browser draws nothing in space: two waves, cut open. */
export function drawFlat(canvas: HTMLCanvasElement, frame: Frame, parts: Float32Array, field: Field, tube: Welcome, lightness: boolean, colours: Ink): void {
  const context = canvas.getContext("2d");
  if (!context || canvas.clientWidth === 0) return;
  const density = Math.min(2, devicePixelRatio);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  [canvas.width, canvas.height] = [Math.round(width * density), Math.round(height * density)];
  const { heading, wavelength, length } = tube;
  const radii = outline(frame, tube);
  const highest = Math.max(tube.radius, ...radii) + tube.wall_sphere_diameter;
  const scale = Math.min(width / (2 * wavelength), (0.46 * height) / highest);
  const half = (0.5 * width) / scale;
  const middle = Math.min(0.5 * length, wavelength);
  context.setTransform(density * scale, 0, 0, -density * scale, 0.5 * canvas.width, 0.5 * canvas.height);
  context.fillStyle = colours.stageEdge;
  context.fillRect(-half, -height, 2 * half, 2 * height);
  // The wall behind the grains, as wide as its spheres.
  const [first, last] = [-heading * middle, heading * (length - middle)].sort((a, b) => a - b);
  const edge = (side: number, outside: number) =>
    Array.from({ length: 241 }, (_, k): [number, number] => {
      const here = -half + (k / 120) * half;
      const along = tube.open ? Math.min(last, Math.max(first, here)) : here;
      const place = inWave(frame, tube, middle + heading * along) * (radii.length - 1);
      const below = Math.min(radii.length - 2, Math.floor(place));
      const radius = radii[below] + (place - below) * (radii[below + 1] - radii[below]);
      return [along, side * (radius + outside * tube.wall_sphere_diameter)];
    });
  for (const [outside, colour] of [[0.5, colours.wall], [-0.5, colours.stageMiddle]] as const) {
    context.beginPath();
    for (const [x, y] of [...edge(1, outside), ...edge(-1, outside).reverse()]) context.lineTo(x, y);
    context.fillStyle = colour;
    context.fill();
  }
  const tones = stops(field, lightness);
  // Far ones first.
  const order = Array.from({ length: frame.grains }, (_, i) => i).filter((i) => !Number.isNaN(frame.position[3 * i]));
  order.sort((one, other) => heading * (frame.position[3 * one + 1] - frame.position[3 * other + 1]));
  context.lineWidth = 1.2 / scale;
  context.strokeStyle = colours.stageEdge;
  for (const i of order) {
    const [x, z, radius] = [frame.position[3 * i], frame.position[3 * i + 2], 0.5 * frame.diameter[i]];
    const along = heading * (z - middle);
    context.fillStyle = css(colourAt(tones, parts[i]));
    const images = tube.open ? [0, 0] : [Math.ceil((-half - radius - along) / length), (half + radius - along) / length];
    for (let k = images[0]; k <= images[1]; k++) {
      context.beginPath();
      context.arc(along + k * length, x, radius, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
  }
}
