/** Points that were measured, in 3D, and the cameras that saw them. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { Box3, type BufferGeometry, Points, PointsMaterial, Vector3 } from 'three';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { count } from '../../language/format';
import { Checkbox } from '../../widgets/checkbox';
import { ProblemAlert } from '../../widgets/problem_alert';
import { strings } from '../../language/strings';
import { NoWebGL, Stage } from '../scene/stage';
import { words as viewerWords } from '../words';
import { useShape, useStandingShape } from './fitted_shape';
import { frusta, type PinholeCamera } from './frusta';
import '../viewer.css';

const words = viewerWords.cloud;
/** Metres: of a point, and from the eye of a camera to the picture in its pyramid. */
const [POINT, DEPTH] = [0.008, 0.12];
const PYRAMIDS = 0xc4553c;
/** Where it is looked from at first, in heights of the cloud from its middle. */
const FROM = new Vector3(1.3, 1.1, 2.3);
const backgrounds = { light: '#efeae1', dark: '#191714' };

interface Props {
  /** Where the PLY is. */
  points: string;
  cameras: readonly PinholeCamera[];
  /** Where the PLY of the shape is that was fitted to them, if there is one. */
  shape?: string | undefined;
  /** Whether the shape is shown first. */
  shapeFirst?: boolean;
}

interface Shown {
  stage: Stage;
  geometry: BufferGeometry;
}

export default function CloudView({ points, cameras, shape, shapeFirst = false }: Props) {
  const place = useRef<HTMLDivElement>(null);
  const [shown, setShown] = useState<Shown | null>(null);
  const [trouble, setTrouble] = useState<'no_webgl' | 'cloud_unreadable' | null>(null);
  const [turn, setTurn] = useState(0);
  const [withCameras, setWithCameras] = useState(true);
  const [withShape, setWithShape] = useState(shapeFirst);
  const fitted = useShape(shape, () => setTrouble('cloud_unreadable'));
  const shapeShown = withShape && fitted !== null;
  // links are signed anew: the file is the same until its path is another
  const path = points.split('?')[0];
  useEffect(() => {
    const stop = new AbortController();
    let stage: Stage | null = null;
    let geometry: BufferGeometry | null = null;
    setTrouble(null);
    const show = async (): Promise<void> => {
      try {
        stage = new Stage(place.current as HTMLElement);
        const response = await fetch(points, { signal: stop.signal });
        if (!response.ok) throw new Error(`${response.status}`);
        geometry = new PLYLoader().parse(await response.arrayBuffer());
        if (!stop.signal.aborted) setShown({ stage, geometry });
      } catch (error) {
        if (!stop.signal.aborted) setTrouble(error instanceof NoWebGL ? 'no_webgl' : 'cloud_unreadable');
      }
    };
    void show();
    return () => {
      stop.abort();
      setShown(null);
      geometry?.dispose();
      stage?.dispose();
    };
  }, [path, turn]);
  useCloud(shown, !shapeShown);
  useStandingShape(shown?.stage ?? null, shapeShown ? fitted : null);
  useFrusta(shown, withCameras ? cameras : []);

  return (
    <section class="viewer" aria-label={words.label}>
      <div class="viewer-stage" ref={place} tabIndex={trouble ? -1 : 0} role="application" aria-label={words.stage} aria-busy={!shown && !trouble}>
        {trouble && (
          <ProblemAlert code={trouble} detail={trouble === 'no_webgl' ? viewerWords.noWebGL : viewerWords.failed}>
            {trouble !== 'no_webgl' && (
              <button type="button" class="button" onClick={() => setTurn(turn + 1)}>
                {strings.retry}
              </button>
            )}
          </ProblemAlert>
        )}
        {!shown && !trouble && <p class="viewer-loading">{words.loading}</p>}
      </div>
      <p class="viewer-help">
        {shown && words.points(count(shown.geometry.attributes.position?.count ?? 0))} {viewerWords.help}
      </p>
      {fitted && <Checkbox label={words.shape} checked={withShape} onChange={setWithShape} />}
      {cameras.length > 0 && <Checkbox label={words.cameras} checked={withCameras} onChange={setWithCameras} />}
    </section>
  );
}

function useCloud(shown: Shown | null, visible: boolean): void {
  const points = useRef<Points | null>(null);
  useEffect(() => {
    if (!points.current) return;
    points.current.visible = visible;
    shown?.stage.invalidate();
  }, [visible]);
  useEffect(() => {
    if (!shown) return;
    const { stage, geometry } = shown;
    const coloured = geometry.hasAttribute('color');
    const material = new PointsMaterial({ size: POINT, vertexColors: coloured, color: coloured ? 0xffffff : 0x8d8475 });
    const cloud = new Points(geometry, material);
    cloud.visible = visible;
    points.current = cloud;
    stage.scene.add(cloud);
    const wish = matchMedia('(prefers-color-scheme: dark)');
    const paint = (): void => stage.paint(wish.matches ? backgrounds.dark : backgrounds.light);
    wish.addEventListener('change', paint);
    paint();
    lookFromAbove(stage, new Box3().setFromObject(cloud));
    return () => {
      wish.removeEventListener('change', paint);
      points.current = null;
      stage.scene.remove(cloud);
      material.dispose();
    };
  }, [shown]);
}

/** From before, above and aside, so that it is seen how the cameras stand around. */
function lookFromAbove(stage: Stage, box: Box3): void {
  const middle = box.getCenter(new Vector3());
  const height = box.getSize(new Vector3()).y;
  stage.look(FROM.clone().multiplyScalar(height).add(middle), middle);
}

function useFrusta(shown: Shown | null, cameras: readonly PinholeCamera[]): void {
  useEffect(() => {
    if (!shown || cameras.length === 0) return;
    const pyramids = frusta(cameras, DEPTH, PYRAMIDS);
    const { stage } = shown;
    stage.scene.add(pyramids);
    stage.invalidate();
    return () => {
      stage.scene.remove(pyramids);
      pyramids.geometry.dispose();
      pyramids.material.dispose();
      stage.invalidate();
    };
  }, [shown, cameras.length]);
}
