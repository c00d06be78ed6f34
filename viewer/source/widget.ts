/** The page in a notebook: an anywidget, whose other half is crates/python/python/peristalsis/_view.py. */
import type { Command } from "./protocol";

/** The model of a widget, as far as it is used. */
interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  send(content: unknown): void;
  on(event: "msg:custom", hear: (content: { text?: string }, buffers: DataView<ArrayBuffer>[]) => void): void;
  off(event: "msg:custom", hear: unknown): void;
}

/** What the page asks for is a trait where there is one, so that Python sees it change, and a message where not. */
function ask(model: Model, asked: Command | "ready" | "next"): void {
  if (typeof asked === "object" && asked.type === "steer") model.set(asked.parameter, asked.value);
  else if (typeof asked === "object" && asked.type === "play") model.set("playing", asked.playing);
  else if (typeof asked === "object" && asked.type === "speed") model.set("speed", asked.periods_per_second);
  else return model.send(asked);
  model.save_changes();
}

/** The document with its style and its script in it: nothing is asked of any server. */
function whole([html, style, script]: string[]): string {
  return html
    .replace(/<link rel="icon"[^>]*>/, "")
    .replace('<link rel="stylesheet" href="viewer.css">', () => `<style>${style}</style>`)
    .replace(/<script [^>]*><\/script>/, () => `<script type="module">${script}</script>`)
    .replace("<body>", '<body data-engine="host">');
}

export default {
  render({ model, el }: { model: Model; el: HTMLElement }): () => void {
    const frame = document.createElement("iframe");
    frame.title = "The tube of this simulation";
    frame.style.cssText = `width: 100%; height: ${model.get("height")}px; border: 0`;
    frame.allow = "clipboard-write";
    const { port1: port, port2: given } = new MessageChannel();
    const hear = ({ text }: { text?: string }, buffers: DataView<ArrayBuffer>[]) => {
      if (text !== undefined) port.postMessage(text);
      for (const { buffer, byteOffset, byteLength } of buffers ?? []) {
        const bytes = buffer.slice(byteOffset, byteOffset + byteLength);
        port.postMessage(bytes, [bytes]);
      }
    };
    port.onmessage = ({ data }: MessageEvent<Command | "ready" | "next">) => ask(model, data);
    frame.onload = () => frame.contentWindow?.postMessage("", "*", [given]);
    model.on("msg:custom", hear);
    frame.srcdoc = whole(model.get("_page") as string[]);
    el.append(frame);
    return () => {
      model.off("msg:custom", hear);
      port.close();
    };
  },
};
