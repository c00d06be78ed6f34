import { type Connection, hear, type Listener } from "./connection";
import type { Command } from "./protocol";

/** Whether something around the page computes for it. */
export const isHosted = (): boolean => document.body.dataset.engine === "host";

/** What is around the page and computes for it, such as a notebook (widget.ts): texts and frames through a port that it gives. */
export class Host implements Connection {
  private port: MessagePort | null = null;

  constructor(private readonly listener: Listener) {
    addEventListener("message", ({ source, ports }) => {
      if (source !== parent || ports.length === 0) return;
      [this.port] = ports;
      this.port.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
        hear(this.listener, data);
        // The next frame is computed when this one has been drawn.
        if (typeof data !== "string") requestAnimationFrame(() => this.port?.postMessage("next"));
      };
      this.port.postMessage("ready");
    });
  }

  send(command: Command): void {
    this.port?.postMessage(command);
  }
}
