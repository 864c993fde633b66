/** A live portrait on black and nothing else: a source for OBS, or a full screen. It looks on; the camera is another page's. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { viewPath } from '../api';
import { showLive } from '../live/picture';
import { words } from '../live/words';
import '../live/styles/alone.css';

export default function LivePage({ id, token }: { id: string; token: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [told, setTold] = useState(words.waiting);
  useEffect(() => {
    document.title = words.title;
    const line = showLive(viewPath(id, token), () => canvas.current, {
      onEvent: (event) => setTold(event.event === 'ended' ? words.states.ended : ''),
      onLost: () => setTold(words.states.ended),
    });
    return () => line.close();
  }, [id, token]);
  return (
    <div class="live-alone">
      <canvas ref={canvas} role="img" aria-label={words.alt} width="4" height="4" />
      <p role="status">{told}</p>
    </div>
  );
}
