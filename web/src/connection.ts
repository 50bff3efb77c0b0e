// The WebSocket to the program. It reconnects when the connection is lost, and matches replies with requests.
import {decode, Frame, Interior, Scene, Status, Surface} from './protocol';

const PROTOCOL = 2;
const WAITS = [0.25, 0.5, 1, 2];  // s between attempts to connect; the last one repeats

export interface Listener {
  scene(scene: Scene, mode: string): void;
  surface(surface: Surface): void;
  interior(interior: Interior): void;
  frame(frame: Frame): void;
  status(status: Status): void;
  connected(yes: boolean, why: string): void;
  notice(level: string, text: string): void;
}

export class RequestError extends Error {
  constructor(readonly kind: string, message: string, readonly remedy: string) {
    super(remedy ? `${message}; ${remedy}` : message);
  }
}

export class Connection {
  client = 0;
  instance = '';
  open = false;
  private socket: WebSocket | null = null;
  private tries = 0;
  private lastId = 0;
  generation = -1;  // of the scene that is shown
  private waiting = new Map<number, {resolve: () => void; reject: (e: Error) => void}>();

  constructor(private listener: Listener) { this.connect(); }

  /** Sends a request. Resolves when it has been carried out, and rejects with the error otherwise. */
  request(message: Record<string, unknown>): Promise<void> {
    if (!this.open || !this.socket) return Promise.reject(new Error('not connected'));
    const id = ++this.lastId;
    this.socket.send(JSON.stringify({...message, id}));
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }

  private connect(): void {
    const socket = new WebSocket(`ws://${location.host}/view${location.search}`);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => socket.send(JSON.stringify({type: 'hello', protocol: PROTOCOL}));
    socket.onmessage = (event) => {
      if (typeof event.data === 'string') this.text(JSON.parse(event.data));
      else this.bytes(event.data as ArrayBuffer);
    };
    socket.onclose = (event) => {
      this.open = false;
      for (const {reject} of this.waiting.values()) reject(new Error('the connection was lost'));
      this.waiting.clear();
      this.listener.connected(false, event.reason);
      const wait = WAITS[Math.min(this.tries++, WAITS.length - 1)];
      setTimeout(() => this.connect(), 1000 * wait);
    };
    this.socket = socket;
  }

  private text(message: any): void {
    switch (message.type) {
      case 'welcome':
        this.client = message.client;
        this.instance = message.instance;
        this.open = true;
        this.tries = 0;
        this.listener.connected(true, '');
        break;
      case 'scene':
        this.generation = message.generation;
        this.listener.scene(message.scene, message.mode);
        break;
      case 'status':
        this.listener.status(message);
        break;
      case 'notice':
        this.listener.notice(message.level, message.text);
        break;
      case 'reply': {
        const waiting = this.waiting.get(message.id);
        this.waiting.delete(message.id);
        const e = message.error;
        if (e) waiting?.reject(new RequestError(e.kind, e.message, e.remedy));
        else waiting?.resolve();
      }
    }
  }

  private bytes(buffer: ArrayBuffer): void {
    const message = decode(buffer);
    if (message.generation !== this.generation) return;
    if (message.surface) this.listener.surface(message.surface);
    if (message.interior) this.listener.interior(message.interior);
    if (message.frame) this.listener.frame(message.frame);
  }
}
