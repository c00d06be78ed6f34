/** The worker that computes the tube: crates/viewer/browser as WebAssembly, and messages as over the server's WebSocket. */
import type { Asked } from "./connection";

/** The functions that crates/viewer/browser/exports.rs exports. */
interface Exports {
  memory: WebAssembly.Memory;
  input(length: number): number;
  open(): void;
  command(): void;
  advance(): number;
  frame(): number;
  notice(): number;
  output(): number;
}

class TubeWorker {
  /** Whether the page waits for a frame. */
  private awaited = true;
  /** Whether there is a frame that the page has not got. */
  private fresh = false;
  private going = false;

  constructor(private readonly engine: Exports) {}

  take(asked: Asked): void {
    if (asked === "next") {
      this.awaited = true;
    } else {
      if ("open" in asked) this.say(asked.open, () => this.engine.open());
      else this.say(asked.command, () => this.engine.command());
      this.fresh = true;
    }
    this.answer();
    if (!this.going) this.go();
  }

  /** Advances frame by frame while there is anything to compute, and hears the page in between. */
  private go(): void {
    const begin = performance.now();
    this.going = this.engine.advance() !== 0;
    if (!this.going) return;
    this.fresh = true;
    this.answer();
    // A frame that was computed in less than its time waits for the rest of it.
    setTimeout(() => this.go(), Math.max(0, 33 - (performance.now() - begin)));
  }

  private say(what: unknown, act: () => void): void {
    const bytes = new TextEncoder().encode(JSON.stringify(what));
    const at = this.engine.input(bytes.length);
    new Uint8Array(this.engine.memory.buffer, at, bytes.length).set(bytes);
    act();
  }

  /** Hands over the notices, and the newest frame if the page waits for one. */
  private answer(): void {
    for (let length = this.engine.notice(); length > 0; length = this.engine.notice())
      postMessage(new TextDecoder().decode(this.copy(length)));
    if (!this.awaited || !this.fresh) return;
    const length = this.engine.frame();
    if (length === 0) return;
    const { buffer } = this.copy(length);
    postMessage(buffer, { transfer: [buffer] });
    this.awaited = false;
    this.fresh = false;
  }

  private copy(length: number): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.engine.memory.buffer, this.engine.output(), length).slice();
  }
}

const page = { seconds: () => performance.now() / 1000 };
const loaded = fetch(new URL("engine.wasm", import.meta.url))
  .then(async (answer) => {
    if (!answer.ok) throw new Error(`engine.wasm: ${answer.status}`);
    return WebAssembly.instantiate(await answer.arrayBuffer(), { page });
  })
  .then(({ instance }) => new TubeWorker(instance.exports as unknown as Exports));

addEventListener("message", ({ data }: MessageEvent<Asked>) => {
  loaded.then(
    (worker) => worker.take(data),
    (error: unknown) => postMessage(JSON.stringify({ type: "problem", message: `the engine cannot be loaded: ${error}` })),
  );
});
