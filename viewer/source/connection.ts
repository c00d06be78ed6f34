import { type Command, decode, type Frame, type Told } from "./protocol";

export interface Listener {
  told(message: Told): void;
  frame(frame: Frame): void;
  lost(): void;
}

/** The way to what computes the run or reads its recording. */
export interface Connection {
  send(command: Command): void;
}

/** The server beside the page, by a WebSocket; tries again when it is lost. */
export class Server implements Connection {
  private socket: WebSocket | null = null;

  constructor(private readonly listener: Listener) {
    this.open();
  }

  send(command: Command): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }

  private open(): void {
    const address = new URL("live", location.href);
    address.protocol = "ws:";
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => hear(this.listener, data);
    socket.onclose = () => {
      this.listener.lost();
      setTimeout(() => this.open(), 2000);
    };
    this.socket = socket;
  }
}

/** What tube the engine in the page is to compute. */
export interface Wanted {
  preset: string;
  settings: string[];
}

/** What the worker is told. */
export type Asked = { open: Wanted } | { command: Command } | "next";

/** The engine itself, as WebAssembly in a worker of the page. */
export class Engine implements Connection {
  private readonly worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });

  constructor(listener: Listener, wanted: Wanted) {
    this.worker.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      hear(listener, data);
      // Frames come one by one, so that a page which is slow to draw does not hold a heap of them.
      if (typeof data !== "string") requestAnimationFrame(() => this.ask("next"));
    };
    this.worker.onerror = ({ message }) => listener.told({ type: "problem", message: message || "the engine cannot be loaded" });
    this.ask({ open: wanted });
  }

  send(command: Command): void {
    this.ask({ command });
  }

  private ask(asked: Asked): void {
    this.worker.postMessage(asked);
  }
}

function hear(listener: Listener, data: string | ArrayBuffer): void {
  if (typeof data === "string") listener.told(JSON.parse(data) as Told);
  else listener.frame(decode(data));
}
