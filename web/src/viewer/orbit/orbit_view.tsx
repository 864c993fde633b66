/** A character from all sides, acting out its clips. */

import type { ComponentChildren } from 'preact';
import { useEffect, useMemo, useState } from 'preact/hooks';
import { Box3, Vector3 } from 'three';
import { Transport } from '../../result/transport';
import { plain } from '../../language/strings';
import { words } from '../words';
import { type Character, IN_PLACE } from '../scene/character';
import { placeOf } from '../posing/inverse_kinematics';
import { Playback } from './playback';
import type { Stage } from '../scene/stage';
import type { StagedCharacter } from '../scene/staging';
import { Tool } from '../../picture_editor/tools';
/** Metres from the joints to the outline of the body. */
const FLESH = 0.16;
/** Metres around a face alone. */
const AROUND_FACE = 0.012;
/** At how many moments of a clip it is seen what room it takes: jumps go up, arms are raised. */
const MOMENTS = 16;

interface Props {
  stage: Stage;
  cast: readonly StagedCharacter[];
  tools: ComponentChildren;
}

export function OrbitView({ stage, cast, tools }: Props) {
  const lead = cast[0]?.character;
  const [clip, setClip] = useState(lead?.calm?.name ?? '');
  const [time, setTime] = useState(0);
  const [playing, setPlaying] = useState(() => !prefersStillness());
  const [speed, setSpeed] = useState(1);
  const playback = useMemo(() => {
    const characters = cast.map(({ character }) => character);
    return new Playback(characters, clip, (now, goesOn) => {
      setTime(now);
      setPlaying(goesOn);
    });
  }, [cast]);

  useEffect(() => {
    Object.assign(playback, { playing, speed });
    const leave = stage.add(playback);
    playback.advance(0);
    resetView(stage, cast, clip);
    return () => {
      leave();
      for (const { character } of cast) {
        character.unbend();
        character.settle();
      }
    };
  }, [stage, playback]);

  const act = (change: () => void): void => {
    change();
    setPlaying(playback.playing);
    setTime(playback.time);
    stage.invalidate();
  };
  const choose = (name: string): void => {
    setClip(name);
    act(() => {
      playback.choose(name);
      playback.advance(0);
      if (!prefersStillness()) playback.play();
    });
    resetView(stage, cast, name);
  };

  return (
    <>
      {lead?.clip(clip) && (
        <Transport
          time={time}
          total={playback.duration}
          playing={playing}
          speed={speed}
          onPlay={() => act(() => (playback.playing ? (playback.playing = false) : playback.play()))}
          onSeek={(to) => act(() => (playback.time = to))}
          onSpeed={(factor) => {
            setSpeed(factor);
            act(() => (playback.speed = factor));
          }}
        >
          <select aria-label={words.clip} value={clip} onChange={({ currentTarget: { value } }) => choose(value)}>
            {lead.clips.map(({ name }) => (
              <option key={name} value={name}>
                {clipName(name)}
              </option>
            ))}
          </select>
        </Transport>
      )}
      <div class="viewer-tools" role="toolbar" aria-label={words.tools}>
        {tools}
        <Tool label={words.reset} onUse={() => resetView(stage, cast, clip)} icon="M4 12 12 5l8 7M7 10v9h10v-9" />
      </div>
      <p class="viewer-help">{words.help}</p>
    </>
  );
}

export const prefersStillness = (): boolean => matchMedia('(prefers-reduced-motion: reduce)').matches;

/** Look from the front, so that everybody is seen whole, and all of the way that they go in a clip. */
export function resetView(stage: Stage, cast: readonly StagedCharacter[], clip?: string): void {
  const all = new Box3();
  for (const { character } of cast) all.union(roomFor(character, clip));
  stage.frame(all);
}

function roomFor(character: Character, clip?: string): Box3 {
  if (!character.stands) return new Box3().setFromObject(character.root).expandByScalar(AROUND_FACE);
  const played = clip === undefined ? undefined : character.clip(clip);
  const body = new Box3();
  const takeIn = (): void => {
    const now = new Box3();
    for (const joint of character.joints.values()) now.expandByPoint(placeOf(joint));
    body.union(now.expandByScalar(FLESH));
    // arms that swing and legs that stride stay within a person's width
    const middle = now.getCenter(new Vector3());
    body.expandByPoint(new Vector3(middle.x - 0.5, 0, middle.z)).expandByPoint(new Vector3(middle.x + 0.5, 0, middle.z));
  };
  if (!played) takeIn();
  else {
    for (let moment = 0; moment <= MOMENTS; moment++) {
      character.show(played, (played.duration * moment) / MOMENTS);
      takeIn();
    }
  }
  return body;
}

/** A clip in plain words: of the project's own the words are known, a motion file's name is its own. */
export function clipName(name: string): string {
  const base = name.endsWith(IN_PLACE) ? name.slice(0, -IN_PLACE.length) : name;
  const known = words.clips[base] ?? plain(base);
  return base === name ? known : words.inPlace(known);
}
