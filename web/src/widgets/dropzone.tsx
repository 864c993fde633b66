/** A place to drop, browse for, or be given one file; shows what it holds. */

import { useEffect, useId, useMemo, useRef, useState } from 'preact/hooks';
import { size } from '../language/format';
import { strings } from '../language/strings';
import { DropTarget, Invitation } from './drop_target';

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
  const [tries, setTries] = useState(0);
  const error = useId();
  const held = refused ? null : file;

  const take = async (candidate: File | undefined): Promise<void> => {
    if (!candidate) return;
    setTries((before) => before + 1);
    if (await accepts(candidate)) onFile(candidate);
    else onRefused();
  };
  return (
    <DropTarget
      class={`${media} ${held ? 'filled' : ''}`}
      accept={accept}
      label={held ? words.chosen(held.name) : `${words.drop} ${words.browse}`}
      error={refused ? error : undefined}
      onDrop={({ files }) => void take(files[0])}
      onBrowse={([first]) => void take(first)}
    >
      {held ? (
        <Preview file={held} media={media} />
      ) : refused ? (
        <Refusal key={tries} id={error} wrong={words.wrong} browse={words.browse} />
      ) : (
        <Invitation drop={words.drop} browse={words.browse} />
      )}
    </DropTarget>
  );
}

/** Comes into sight, wherever the page was: the file may have been dropped far from its place. */
export function Refusal({ id, wrong, browse }: { id: string; wrong: string; browse: string }) {
  const place = useRef<HTMLSpanElement>(null);
  useEffect(() => place.current?.scrollIntoView({ block: 'nearest' }), []);
  return (
    <span class="prompt wrong-file" ref={place}>
      <strong class="error" role="alert" id={id}>
        {wrong}
      </strong>
      <span aria-hidden="true">{browse}</span>
    </span>
  );
}

function Preview({ file, media }: { file: File; media: Media }) {
  const url = useObjectUrl(file);
  const [unshowable, setUnshowable] = useState<File | null>(null);
  const giveUp = (): void => setUnshowable(file);
  const moving = media === 'video' && !file.type.startsWith('image/');
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
