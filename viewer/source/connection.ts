import { type Command, decode, type Frame, type Told } from "./protocol";

export interface Listener {
  told(message: Told): void;
  frame(frame: Frame): void;
  /** There is nobody to talk to, for a reason in words. */
  lost(reason: string): void;
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
    socket.onclose = async () => {
      const { reason, isOver } = await this.ask();
      this.listener.lost(reason);
      if (!isOver) setTimeout(() => this.open(), 2000);
    };
    this.socket = socket;
  }

  /** Why there is no connection, and whether there never will be again: a program that is started anew has another address. */
  private async ask(): Promise<{ reason: string; isOver: boolean }> {
    try {
      const answer = await fetch("live", { cache: "no-store" });
      if (answer.status === 404)
        return { reason: "This address is no longer valid: the program has printed a new one. What is here can still be looked at.", isOver: true };
      return { reason: answer.status === 503 ? await answer.text() : "The connection broke off; it is tried again every two seconds.", isOver: false };
    } catch {
      return { reason: "The program has ended, and this address with it: started again, it prints a new one. What is here can still be looked at.", isOver: false };
    }
  }
}

/** What tube the engine in the page is to compute. */
export interface Wanted {
  preset: string;
  settings: string[];
  /** Periods a second to begin with. */
  speed?: number;
}

/** What the worker is told. */
export type Asked = { open: Omit<Wanted, "speed"> } | { command: Command } | "next";

/** The engine itself, as WebAssembly in a worker of the page. */
export class Engine implements Connection {
  private readonly worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });

  constructor(private readonly listener: Listener, wanted: Wanted) {
    this.worker.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      hear(this.listener, data);
      // Frames come one by one, so that a page which is slow to draw does not hold a heap of them.
      if (typeof data !== "string") requestAnimationFrame(() => this.ask("next"));
    };
    this.worker.onerror = ({ message }) => listener.told({ type: "problem", message: message || "the engine cannot be loaded" });
    this.open(wanted);
  }

  /** Another tube in place of the one before. */
  open({ preset, settings, speed }: Wanted): void {
    this.ask({ open: { preset, settings } });
    if (speed) this.send({ type: "speed", periods_per_second: speed });
  }

  send(command: Command): void {
    this.ask({ command });
  }

  private ask(asked: Asked): void {
    this.worker.postMessage(asked);
  }
}

export function hear(listener: Listener, data: string | ArrayBuffer): void {
  if (typeof data === "string") listener.told(JSON.parse(data) as Told);
  else listener.frame(decode(data));
}
