import { element } from "./page";
import { unitOfTime, type Welcome } from "./protocol";
import { extent } from "./readings";

/** What tube it is: its title, its facts, and words that a wave that stands has others for. */
export function showHeading(tube: Welcome): void {
  document.title = `${tube.title} – peristalsis`;
  element("title").textContent = tube.title;
  const [ends, stands] = [tube.open ? "open ends" : "periodic", tube.unit_period === null];
  element("facts").textContent =
    `${tube.grains.toLocaleString("en")} ${tube.grains === 1 ? "grain" : "grains"} · ${tube.waves} ${stands ? "standing " : ""}${tube.waves === 1 ? "wave" : "waves"}, ${ends} · ${tube.control} control${extent(tube)}`;
  document.body.dataset.stands = String(stands);
  element("profile-name").textContent = stands ? "Along the tube" : "In the wave frame";
  element("direction-name").textContent = stands ? "outlet" : "wave";
  element("direction").hidden = stands && !tube.open;
  for (const option of element<HTMLSelectElement>("speed").options)
    if (option.value) option.textContent = `${option.value} ${unitOfTime(tube)}/s`;
}
