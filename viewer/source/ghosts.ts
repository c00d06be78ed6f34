import all from "./ghosts.json";
import type { Driven, Welcome } from "./protocol";

/** A published curve: J/Jmax against the width, the force or the friction, means over replicates that ended in one flow. */
export interface Ghost {
  strain_rate: number;
  start: string;
  points: number[][];
}

/** Whether branches of a tube like this one are published. */
export const isPublished = ({ published }: Welcome): boolean => published !== null && Object.hasOwn(all, published);

/** The published branches of a tube like this one, at the strain rate that is nearest to its own. */
export function ghostsOf(tube: Welcome, { strain_rate, friction }: Driven): Ghost[] {
  const known = (all as Record<string, Ghost[]>)[tube.published ?? ""] ?? [];
  return friction === null || Math.abs(friction - 0.4) < 0.02 ? near(known, strain_rate) : [];
}

/** The published flow by friction, where the tube is driven as there. */
export function ghostsOfFriction(tube: Welcome, { strain_rate, force_amplitude, friction }: Driven): Ghost[] {
  const is = tube.published === "frictional" && friction !== null && Math.abs((force_amplitude ?? 0) - 0.002) < 1e-4;
  return is ? near(all.friction, strain_rate) : [];
}

/** Those at one strain rate, where one is as near as a few percent. */
function near(ghosts: Ghost[], rate: number | null): Ghost[] {
  return ghosts.filter((ghost) => rate !== null && Math.abs(ghost.strain_rate / rate - 1) < 0.03);
}
