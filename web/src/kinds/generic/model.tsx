/** A 3D model, to be turned. */

import '@google/model-viewer';
import { useEffect, useRef } from 'preact/hooks';
import '../../viewer/viewer.css';

export default function Model({ url, alt }: { url: string; alt: string }) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = document.createElement('model-viewer');
    const attributes = { 'camera-controls': '', 'interaction-prompt': 'none', 'touch-action': 'pan-y', autoplay: '', alt, src: url };
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    place.current?.append(element);
    return () => element.remove();
  }, [url]);
  return <div ref={place} class="viewer-room" />;
}
