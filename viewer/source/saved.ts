import { element } from "./page";
import type { Saved } from "./protocol";

/** Offers a saved state. */
export function showSaved(saved: Saved): void {
  element("saved-command").textContent = saved.command;
  element("saved-folder").textContent = saved.folder
    ? `${saved.folder} holds the checkpoint and its configuration.`
    : "Put both files into a folder, under these names.";
  if (!saved.repeats) element("saved-folder").textContent += " The configuration tells the last friction only: from the start it makes another run.";
  const name = saved.folder?.split("/").at(-1);
  offer("saved-toml", new Blob([saved.toml], { type: "application/toml" }), name ? `${name}.toml` : "config.toml");
  const { state } = saved;
  element("saved-state").hidden = state === null;
  if (state !== null) offer("saved-state", new Blob([Uint8Array.from(atob(state), (it) => it.charCodeAt(0))]), "state.checkpoint");
  element<HTMLDialogElement>("saved").showModal();
}

/** A file to be downloaded by a link. */
function offer(id: string, file: Blob, name: string): void {
  const link = element<HTMLAnchorElement>(id);
  URL.revokeObjectURL(link.href);
  link.href = URL.createObjectURL(file);
  link.download = name;
}
