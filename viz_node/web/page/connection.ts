// viz_node/web/page/connection.ts -- the WebSocket to viz_node: opens again by itself, and
// acknowledges frames.
import { decodeBinary, type Message } from './protocol.ts';

const FIRST_PAUSE_MS = 250;
const LONGEST_PAUSE_MS = 2000;
// viz_node speaks four times a second, whatever the scene does.
const SILENCE_MS = 4000;
const POLL_MS = 500; // for silence

export interface Listener {
  message(message: Message): void;
  opened(): void;
  closed(): void;
  failed(error: unknown): void;
}

export class Connection {
  /** False: viz_node ignores commands and the hand of this page. */
  mayCommand = true;

  private socket: WebSocket | null = null;
  private pauseMs = FIRST_PAUSE_MS;
  private watchdog = 0;
  private lastMs = 0; // when the newest message came
  private received = 0; // sequence of the newest frame of this connection
  private acknowledged = 0;

  constructor(
    private readonly url: string,
    private readonly listener: Listener,
  ) {
    this.open();
  }

  get isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /**
   * Says that every frame received so far is done with, drawn or not. What is acknowledged never depends on what became of a frame;
   * `drawn` is the sequence of the one that was drawn while it was new, if any.
   */
  acknowledge(drawn = 0): void {
    if (!this.isOpen || this.received === this.acknowledged) return;
    this.acknowledged = this.received;
    const sequence = this.received;
    this.socket!.send(JSON.stringify({ type: 'ack', sequence, drawn: drawn === sequence }));
  }

  /** Asks for something of the simulation. */
  command(verb: string, more: { steps?: number; value?: number; parameter?: string; scene?: number } = {}): void {
    if (this.isOpen && this.mayCommand) this.socket!.send(JSON.stringify({ type: 'command', verb, ...more }));
  }

  /** Where the hand wants a port [m]; null: it lets go of it. */
  drag(port: number, at_m: number[] | null, event: number): void {
    if (this.isOpen) this.socket!.send(JSON.stringify({ type: 'pointer', port, at_m, event }));
  }

  /** Asks for the sound of the scene, or for no more of it. A new connection is silent. */
  listen(on: boolean): void {
    if (this.isOpen) this.socket!.send(JSON.stringify({ type: 'sound', on }));
  }

  private open(): void {
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    this.received = this.acknowledged = 0;
    socket.onopen = () => {
      this.pauseMs = FIRST_PAUSE_MS;
      this.listener.opened();
    };
    socket.onmessage = (event) => this.receive(socket, event.data as string | ArrayBuffer);
    socket.onclose = () => this.reopen(socket);
    this.watch(socket);
  }

  private receive(socket: WebSocket, data: string | ArrayBuffer): void {
    if (socket !== this.socket) return;
    this.lastMs = performance.now();
    try {
      const message = typeof data === 'string' ? (JSON.parse(data) as Message) : decodeBinary(data);
      if (message.type === 'frame') this.received = message.sequence;
      this.listener.message(message);
    } catch (error) {
      this.listener.failed(error);
    }
  }

  /** A connection that falls silent (a laptop that slept, a tunnel that broke) is given up and opened again. */
  private watch(socket: WebSocket): void {
    this.lastMs = performance.now();
    this.watchdog = window.setInterval(() => {
      if (performance.now() - this.lastMs < SILENCE_MS) return;
      socket.close();
      this.reopen(socket);
    }, POLL_MS);
  }

  private reopen(socket: WebSocket): void {
    if (socket !== this.socket) return;
    this.socket = null;
    clearInterval(this.watchdog);
    this.listener.closed();
    window.setTimeout(() => this.open(), this.pauseMs);
    this.pauseMs = Math.min(2 * this.pauseMs, LONGEST_PAUSE_MS);
  }
}
