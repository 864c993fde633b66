/** The performances on offer, to choose one from: ours, the user's own, or a video at hand. */

import type { ComponentChildren } from 'preact';
import { useState } from 'preact/hooks';
import { deleteDriver, type Driver, renameDriver } from '../api';
import { isPicture, isVideo, pictureTypes, videoTypes } from '../studio/given_files/media_types';
import { ofDriver } from './drivers';
import { isStill, type Performance } from './performance';
import { words } from './words';
import { plain } from '../language/strings';
import { Capture } from '../studio/given_files/capture';
import { Card, shownOf } from './performance_card';
import { Dropzone } from '../widgets/dropzone';
import { KeepDriver } from './keep_driver';
import { KeptList } from '../studio/kept_list';

export interface PickerProps {
  drivers: readonly Driver[];
  chosen: Performance | null;
  onChoose: (performance: Performance) => void;
  /** Whether a picture will do, too: its expression is taken on. */
  pictures?: boolean;
  /** The file that was chosen last is none of these. */
  refused: boolean;
  onRefused: () => void;
  /** Something is being sent. */
  sending: boolean;
  /** A video is being kept, or no longer. */
  onKeeping: (on: boolean) => void;
  /** There is a driver more, or less, or one has another name. */
  onKept: () => void;
  /** The one that was chosen is no more. */
  onGone: () => void;
  /** Cards of what else may be chosen, before the built-in ones. */
  children?: ComponentChildren;
}

const STRENGTHS = ['normal', 'strong'] as const;
type Strength = (typeof STRENGTHS)[number];

export function PerformancePicker({ drivers, chosen, onChoose, refused, onRefused, sending, onKeeping, ...then }: PickerProps) {
  const { onKept, onGone, children, pictures = false } = then;
  const file = pictures ? words.ownEither : words.ownVideo;
  const [strength, setStrength] = useState<Strength>('normal');
  const name = chosen?.by === 'name' ? chosen.name : null;
  const choose = (name: string): void => onChoose({ by: 'name', name });
  const ours = drivers.filter((driver) => driver.source === 'built-in');
  const own = drivers.filter((driver) => driver.source === 'own');
  const cards = (members: readonly Driver[]) =>
    members.flatMap(shownOf).map((shown) => (
      <Card key={shown.value} {...shown} checked={shown.value === name} onChoose={() => choose(shown.value)} />
    ));
  const change = (strength: Strength): void => {
    setStrength(strength);
    const before = ours.find((driver) => driver.name === name);
    const now = ours.find((driver) => driver.state === before?.state && driver.strength === strength);
    if (now) choose(now.name); // the same, played the other way
  };

  return (
    <>
      {ours.length > 0 && (
        <fieldset class="performances">
          <legend>{words.performances}</legend>
          <div class="strengths" role="radiogroup" aria-label={words.strengths}>
            {STRENGTHS.map((one) => (
              <label key={one}>
                <input type="radio" name="strength" checked={one === strength} onChange={() => change(one)} />
                <span>{words.strengthNames[one]}</span>
              </label>
            ))}
          </div>
          <div class="cards">
            {children}
            {cards(ours.filter((driver) => driver.strength === strength))}
          </div>
        </fieldset>
      )}
      {own.length > 0 && (
        <fieldset class="performances">
          <legend>{words.yours}</legend>
          <div class="cards">{cards(own)}</div>
          {own.map((driver) => (
            <Search key={driver.name} driver={driver} />
          ))}
        </fieldset>
      )}
      <KeptList
        items={own.map(({ name, created_at }) => ({ id: created_at ?? name, name, label: plain(name) }))}
        rename={renameDriver}
        remove={deleteDriver}
        onRenamed={(before, now) => {
          if (name !== null && ofDriver(name, before)) choose(now + name.slice(before.length));
          onKept();
        }}
        onRemoved={(gone) => {
          if (name !== null && ofDriver(name, gone)) onGone();
          onKept();
        }}
      />
      <h3>{file.title}</h3>
      <Dropzone
        media="video"
        file={chosen?.by === 'file' ? chosen.file : null}
        accept={pictures ? `${videoTypes},${pictureTypes}` : videoTypes}
        accepts={pictures ? isEither : isVideo}
        words={{
          drop: file.drop,
          browse: words.videoBrowse,
          chosen: file.chosen,
          wrong: file.wrong,
        }}
        onFile={(file) => onChoose({ by: 'file', file })}
        refused={refused}
        onRefused={onRefused}
      />
      {chosen?.by === 'file' && !isStill(chosen.file) && (
        <KeepDriver
          file={chosen.file}
          disabled={sending}
          onKeeping={onKeeping}
          onKept={(kept) => {
            if (kept !== null) onChoose({ by: 'name', name: kept });
            onKept();
          }}
        />
      )}
      <Capture media="video" onFile={(file) => onChoose({ by: 'file', file })} />
    </>
  );
}

const isEither = async (file: File): Promise<boolean> => (await isVideo(file)) || isPicture(file);

/** How far the search for emotions in one's own driver is, where there is something to say. */
function Search({ driver }: { driver: Driver }) {
  const name = plain(driver.name);
  if (driver.moments_status === 'pending') {
    return (
      <p class="hint" role="status" aria-busy="true">
        {words.searching(name)}
      </p>
    );
  }
  if (driver.moments_status === 'failed') return <p class="hint">{words.notSearched(name)}</p>;
  if (driver.moments_status === 'ready' && !driver.moments?.length) {
    return <p class="hint">{words.nothingFound(name)}</p>;
  }
  return null;
}
