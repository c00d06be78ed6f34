import { type Command, decode, type Frame, type Told } from "./protocol";

export interface Listener {
  told(message: Told): void;
  frame(frame: Frame): void;
  lost(): void;
}

/** The WebSocket beside the page; tries again when it is lost. */
export class Connection {
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
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data === "string") this.listener.told(JSON.parse(data) as Told);
      else this.listener.frame(decode(data));
    };
    socket.onclose = () => {
      this.listener.lost();
      setTimeout(() => this.open(), 2000);
    };
    this.socket = socket;
  }
}
