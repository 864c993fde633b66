/** A place to drop, browse for, or be given one file; shows what it holds. */

import { useEffect, useId, useMemo, useRef, useState } from 'preact/hooks';
import { size } from '../language/format';
import { strings } from '../language/strings';

type Media = 'image' | 'video' | 'motion';

interface Words {
  drop: string;
  browse: string;
  chosen: (name: string) => string;
  wrong: string;
}

interface Props {
  file: File | null;
  accept: string;
  accepts: (file: File) => Promise<boolean>;
  words: Words;
  media: Media;
  onFile: (file: File) => void;
  /** What was chosen last cannot be taken: the place says so, and shows no file that it had before. */
  refused: boolean;
  onRefused: () => void;
}

export function Dropzone({ file, accept, accepts, words, media, onFile, refused, onRefused }: Props) {
  const [over, setOver] = useState(false);
  const [tries, setTries] = useState(0);
  const error = useId();
  const held = refused ? null : file;

  const take = async (candidate: File | undefined): Promise<void> => {
    if (!candidate) return;
    setTries((before) => before + 1);
    if (await accepts(candidate)) onFile(candidate);
    else onRefused();
  };
  const drop = (event: DragEvent): void => {
    event.preventDefault();
    setOver(false);
    void take(event.dataTransfer?.files[0]);
  };

  return (
    <div class={`dropzone ${media} ${over ? 'over' : ''} ${held ? 'filled' : ''}`}>
      <label
        onDragOver={(event) => {
          event.preventDefault();
          setOver(true);
        }}
        onDragLeave={() => setOver(false)}
        onDrop={drop}
      >
        <input
          type="file"
          accept={accept}
          aria-label={held ? words.chosen(held.name) : `${words.drop} ${words.browse}`}
          aria-invalid={refused}
          aria-describedby={refused ? error : undefined}
          onChange={(event) => {
            void take(event.currentTarget.files?.[0]);
            event.currentTarget.value = ''; // so that choosing the same file again counts as a choice
          }}
        />
        {held ? (
          <Preview file={held} media={media} />
        ) : refused ? (
          <Refusal key={tries} id={error} words={words} />
        ) : (
          <Invitation words={words} />
        )}
      </label>
    </div>
  );
}

function Invitation({ words }: { words: Words }) {
  return (
    <span class="prompt" aria-hidden="true">
      <svg viewBox="0 0 24 24" width="28" height="28">
        <path d="M12 16V4m0 0L7 9m5-5 5 5M4 16v3a1 1 0 0 0 1 1h14a1 1 0 0 0 1-1v-3" />
      </svg>
      <strong>{words.drop}</strong>
      <span>{words.browse}</span>
    </span>
  );
}

/** Comes into sight, wherever the page was: the file may have been dropped far from its place. */
function Refusal({ id, words }: { id: string; words: Words }) {
  const place = useRef<HTMLSpanElement>(null);
  useEffect(() => place.current?.scrollIntoView({ block: 'nearest' }), []);
  return (
    <span class="prompt wrong-file" ref={place}>
      <strong class="error" role="alert" id={id}>
        {words.wrong}
      </strong>
      <span aria-hidden="true">{words.browse}</span>
    </span>
  );
}

function Preview({ file, media }: { file: File; media: Media }) {
  const url = useObjectUrl(file);
  const [unshowable, setUnshowable] = useState<File | null>(null);
  const giveUp = (): void => setUnshowable(file);
  const moving = media === 'video' && file.type !== 'image/gif';
  return (
    <span class="held">
      {media === 'motion' ? null : unshowable === file ? (
        <span class="unshowable">{strings.studio.noPreview}</span>
      ) : moving ? (
        <video src={url} muted playsInline preload="metadata" onError={giveUp} aria-hidden="true" />
      ) : (
        <img src={url} alt="" onError={giveUp} />
      )}
      <span class="caption" aria-hidden="true">
        <span class="name">{file.name}</span> <span class="size">{size(file.size)}</span>
      </span>
    </span>
  );
}

function useObjectUrl(file: File): string {
  const url = useMemo(() => URL.createObjectURL(file), [file]);
  useEffect(() => () => URL.revokeObjectURL(url), [url]);
  return url;
}
