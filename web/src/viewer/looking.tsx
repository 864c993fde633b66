/** A character from all sides, acting out its clips. */

import type { ComponentChildren } from 'preact';
import { useEffect, useMemo, useState } from 'preact/hooks';
import { type AnimationClip, Box3, Vector3 } from 'three';
import { Transport } from '../components/transport';
import { plain, strings } from '../strings';
import { type Character, IN_PLACE, rootOf } from './character';
import { placeOf } from './reach';
import { Playback } from './playback';
import type { Stage } from './stage';
import { Tool } from '../stage/tools';

const words = strings.viewer;
/** Metres from the joints to the outline of the body. */
const FLESH = 0.16;

interface Props {
  stage: Stage;
  character: Character;
  tools: ComponentChildren;
}

export function Looking({ stage, character, tools }: Props) {
  const [clip, setClip] = useState(character.calm);
  const [time, setTime] = useState(0);
  const [playing, setPlaying] = useState(() => !prefersStillness());
  const [speed, setSpeed] = useState(1);
  const playback = useMemo(() => {
    if (!clip) return null;
    return new Playback(character, clip, (now, goesOn) => {
      setTime(now);
      setPlaying(goesOn);
    });
  }, [character]);

  useEffect(() => {
    if (!playback) return;
    playback.playing = playing;
    const leave = stage.add(playback);
    playback.advance(0);
    resetView(stage, character, playback.clip);
    return () => {
      leave();
      character.unbend();
    };
  }, [stage, playback]);

  const act = (change: (playback: Playback) => void): void => {
    if (!playback) return;
    change(playback);
    setPlaying(playback.playing);
    setTime(playback.time);
    stage.invalidate();
  };
  const choose = (name: string): void => {
    const chosen = character.clip(name);
    if (!chosen) return;
    setClip(chosen);
    act((one) => {
      one.choose(chosen);
      if (!prefersStillness()) one.play();
    });
    character.show(chosen, 0);
    resetView(stage, character, chosen);
  };

  return (
    <>
      <div class="viewer-tools" role="toolbar" aria-label={words.tools}>
        {tools}
        <Tool label={words.reset} onUse={() => resetView(stage, character, clip)} icon="M4 12 12 5l8 7M7 10v9h10v-9" />
      </div>
      {clip && (
        <Transport
          time={time}
          total={clip.duration}
          playing={playing}
          speed={speed}
          onPlay={() => act((one) => (one.playing ? (one.playing = false) : one.play()))}
          onSeek={(to) => act((one) => (one.time = to))}
          onSpeed={(factor) => {
            setSpeed(factor);
            act((one) => (one.speed = factor));
          }}
        >
          <select aria-label={words.clip} value={clip.name} onChange={({ currentTarget: { value } }) => choose(value)}>
            {character.clips.map(({ name }) => (
              <option key={name} value={name}>
                {clipName(name)}
              </option>
            ))}
          </select>
        </Transport>
      )}
      <p class="viewer-help">{words.help}</p>
    </>
  );
}

export const prefersStillness = (): boolean => matchMedia('(prefers-reduced-motion: reduce)').matches;

/** Look from the front, so that the whole person is seen, and all of the way that they go in a clip. */
export function resetView(stage: Stage, character: Character, clip?: AnimationClip): void {
  const body = new Box3();
  for (const joint of character.joints.values()) body.expandByPoint(placeOf(joint));
  body.expandByScalar(FLESH);
  // arms that swing and legs that stride stay within a person's width
  const middle = body.getCenter(new Vector3());
  body.expandByPoint(new Vector3(middle.x - 0.5, 0, middle.z)).expandByPoint(new Vector3(middle.x + 0.5, 0, middle.z));
  const way = clip && rootOf(clip)?.values;
  const hips = character.joints.get('Hips')?.position;
  if (way && hips) {
    const now = body.clone();
    for (let key = 0; key < way.length; key += 3) {
      body.union(now.clone().translate(new Vector3(way[key]! - hips.x, 0, way[key + 2]! - hips.z)));
    }
  }
  stage.frame(body);
}

/** A clip in plain words: of the project's own the words are known, a motion file's name is its own. */
export function clipName(name: string): string {
  const base = name.endsWith(IN_PLACE) ? name.slice(0, -IN_PLACE.length) : name;
  const known = words.clips[base] ?? plain(base);
  return base === name ? known : words.inPlace(known);
}
