/** The start page: choose a portrait and a performance, set it going, find what was made before. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { listDrivers, type Problem } from '../api';
import { ChoiceFields, optionsOf, usual } from '../components/choices';
import { Dropzone } from '../components/dropzone';
import { type Performance, Performances } from '../components/performances';
import { Recent } from '../components/recent';
import { Trouble } from '../components/trouble';
import { percent } from '../format';
import { asProblem, useLoaded } from '../loading';
import { isPicture, isVideo, pictureTypes } from '../media';
import { newOrder, type Order, send, type Sending } from '../order';
import { jobLink } from '../route';
import { strings } from '../strings';

const words = strings.studio;

export function StudioPage() {
  const [portrait, setPortrait] = useState<File | null>(null);
  const [performance, setPerformance] = useState<Performance | null>(null);
  const [choices, setChoices] = useState(usual);
  const drivers = useLoaded(listDrivers, 'drivers');
  const sending = useSending();
  useDropsAnywhere(setPortrait, (file) => setPerformance({ by: 'file', file }));
  useEffect(() => {
    document.title = strings.name;
  }, []);

  const hasSound = performance?.by === 'file';
  const missing = !portrait ? words.needPortrait : !performance ? words.needPerformance : '';
  const start = (event: Event): void => {
    event.preventDefault();
    if (portrait && performance) sending.begin(newOrder(portrait, performance, optionsOf(choices, hasSound)));
  };

  return (
    <>
      <form class="studio" onSubmit={start}>
        <header>
          <h1>{words.title}</h1>
          <p>{words.lead}</p>
        </header>
        <section class="panel portrait" aria-labelledby="portrait-title">
          <h2 id="portrait-title">{words.portrait}</h2>
          <p class="hint">{words.portraitHint}</p>
          <Dropzone
            media="image"
            file={portrait}
            accept={pictureTypes}
            accepts={isPicture}
            words={{
              drop: words.portraitDrop,
              browse: words.portraitBrowse,
              chosen: words.portraitChosen,
              wrong: words.wrongPicture,
            }}
            onFile={setPortrait}
          />
        </section>
        <section class="panel" aria-labelledby="performance-title">
          <h2 id="performance-title">{words.performance}</h2>
          <p class="hint">{words.performanceHint}</p>
          {drivers.problem && (
            <Trouble code={drivers.problem.code} detail={drivers.problem.detail}>
              <button type="button" class="button" onClick={drivers.reload}>
                {strings.retry}
              </button>
            </Trouble>
          )}
          <Performances drivers={drivers.value ?? []} chosen={performance} onChoose={setPerformance} />
          <ChoiceFields value={choices} mayHaveSound={hasSound} onChange={setChoices} />
        </section>
        <div class="launch">
          {sending.problem && (
            <Trouble code={sending.problem.code} detail={sending.problem.detail}>
              <button type="button" class="button" onClick={sending.retry}>
                {strings.retry}
              </button>
            </Trouble>
          )}
          {sending.step ? (
            <SendingBar step={sending.step} onStop={sending.stop} />
          ) : (
            <button type="submit" class="button primary large" disabled={missing !== ''} aria-describedby="missing">
              {words.start}
            </button>
          )}
          <p id="missing" class="hint" aria-live="polite">
            {missing}
          </p>
        </div>
      </form>
      <Recent />
    </>
  );
}

function SendingBar({ step, onStop }: { step: Sending; onStop: () => void }) {
  const label =
    step.step === 'ordering'
      ? words.ordering
      : words.uploading(step.step === 'portrait' ? words.uploadingPortrait : words.uploadingVideo, percent(step.fraction));
  return (
    <div class="sending">
      <label>
        <span>{label}</span>
        <progress max="1" value={step.step === 'ordering' ? undefined : step.fraction} />
      </label>
      <button type="button" class="button" onClick={onStop}>
        {words.stop}
      </button>
    </div>
  );
}

/** An order on its way. When it has arrived, the page turns to its job. */
function useSending() {
  const [step, setStep] = useState<Sending | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const order = useRef<Order | null>(null);
  const stopper = useRef<AbortController | null>(null);

  const begin = (next: Order): void => {
    order.current = next;
    stopper.current = new AbortController();
    const { signal } = stopper.current;
    setProblem(null);
    setStep({ step: 'ordering' });
    send(next, setStep, signal).then(
      (job) => {
        setStep(null);
        if (!signal.aborted) location.hash = jobLink(job.id);
      },
      (error: unknown) => {
        setStep(null);
        if (!(error instanceof DOMException && error.name === 'AbortError')) setProblem(asProblem(error));
      },
    );
  };
  useEffect(() => () => stopper.current?.abort(), []);

  return {
    step,
    problem,
    begin,
    retry: () => order.current && begin(order.current),
    stop: () => stopper.current?.abort(),
  };
}

/** A file that is dropped beside its place, or pasted, still finds it. */
function useDropsAnywhere(onPicture: (file: File) => void, onVideo: (file: File) => void): void {
  useEffect(() => {
    const take = (files: Iterable<File>): void => {
      for (const file of files) {
        if (isPicture(file)) onPicture(file);
        else if (isVideo(file)) onVideo(file);
      }
    };
    const allow = (event: DragEvent): void => event.preventDefault();
    const drop = (event: DragEvent): void => {
      if (event.defaultPrevented) return; // a dropzone took it
      event.preventDefault(); // otherwise the browser would leave the page to show the file
      take(event.dataTransfer?.files ?? []);
    };
    const paste = (event: ClipboardEvent): void => take(event.clipboardData?.files ?? []);
    addEventListener('dragover', allow);
    addEventListener('drop', drop);
    addEventListener('paste', paste);
    return () => {
      removeEventListener('dragover', allow);
      removeEventListener('drop', drop);
      removeEventListener('paste', paste);
    };
  }, []);
}
