/** Frames that come by a WebSocket, drawn as they come: the newest alone. */

import type { LiveEvent } from '../api';

/** Bytes before each picture: the number of the camera's frame. */
export const NUMBER_BYTES = 4;

/** Over how many milliseconds frames are counted. */
const COUNTED = 2000;

export interface Shown {
  /** Called with each event. */
  onEvent: (event: LiveEvent) => void;
  /** Called when the line breaks without a word. */
  onLost: () => void;
}

/** The address of a WebSocket of the service that this page came from. */
export const socketUrl = (path: string): string => `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}${path}`;

/** Open the WebSocket at `path`, and draw what it brings on a canvas. */
export function showLive(path: string, canvas: () => HTMLCanvasElement | null, shown: Shown): LiveLine {
  const socket = new WebSocket(socketUrl(path));
  socket.binaryType = 'arraybuffer';
  const line = new LiveLine(socket);
  let ended = false;
  let newest: ArrayBuffer | null = null;
  let drawing = false;

  const draw = async (): Promise<void> => {
    drawing = true;
    while (newest) {
      const jpeg = new Blob([new Uint8Array(newest, NUMBER_BYTES)], { type: 'image/jpeg' });
      newest = null;
      const picture = await createImageBitmap(jpeg).catch(() => null);
      const target = canvas();
      if (!picture || !target) continue;
      if (target.width !== picture.width || target.height !== picture.height) {
        [target.width, target.height] = [picture.width, picture.height];
      }
      target.getContext('2d')?.drawImage(picture, 0, 0);
      picture.close();
      line.count();
    }
    drawing = false;
  };
  socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
    if (typeof data === 'string') {
      const event = JSON.parse(data) as LiveEvent;
      ended ||= event.event === 'ended';
      shown.onEvent(event);
      return;
    }
    newest = data;
    if (!drawing) void draw();
  };
  socket.onclose = () => {
    if (!ended && !line.closed) shown.onLost();
  };
  return line;
}

/** A line to a live portrait. */
export class LiveLine {
  closed = false;
  private drawn: number[] = [];

  constructor(private readonly socket: WebSocket) {}

  /** Whether what was sent last is on its way: another frame would only wait. */
  get free(): boolean {
    return this.socket.readyState === WebSocket.OPEN && this.socket.bufferedAmount === 0;
  }

  send(message: string | Blob): void {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(message);
  }

  count(): void {
    this.drawn.push(performance.now());
  }

  /** Frames a second, as they were drawn in the last two. */
  rate(): number {
    const since = performance.now() - COUNTED;
    this.drawn = this.drawn.filter((at) => at > since);
    return Math.round((this.drawn.length * 1000) / COUNTED);
  }

  close(): void {
    this.closed = true;
    this.socket.close();
  }
}
