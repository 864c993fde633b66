/** The start page of characters: a picture of somebody, a motion, and off it goes. */

import { useEffect, useState } from 'preact/hooks';
import type { CharacterOptions, MotionJoints } from '../api';
import { CharacterFields, type Choices, KeepField, optionsOf, VideoFields } from '../character/choices';
import { Motions } from '../character/motions';
import { Capture } from '../components/capture';
import { useDropsAnywhere } from '../components/drops';
import { Demo } from '../components/demo';
import { Dropzone } from '../components/dropzone';
import { Launch } from '../components/launch';
import { Making } from '../components/making';
import { Recent } from '../components/recent';
import { Samples } from '../components/samples';
import { type CharacterDraft, type Draft, noCharacter } from '../drafts';
import { isMotion, isPicture, pictureTypes } from '../media';
import { characterOrder, type Motion, namesOf } from '../order';
import { figureSamples } from '../samples';
import { useSending } from '../sending';
import { strings } from '../strings';

const words = strings.character;

/** What is said of the motion, where there is something to say. */
const said = (joints: MotionJoints, clip: string | null): CharacterOptions => ({
  ...(Object.keys(joints).length && { motion_joints: joints }),
  ...(clip !== null && { motion_clip: clip }),
});

export default function CharacterStudio({ draft }: { draft: Draft<CharacterDraft> }) {
  const [{ photo, motion, joints, clip, choices }, alter] = draft;
  const [refused, setRefused] = useState<'photo' | 'motion' | null>(null);
  const setPhoto = (photo: File): void => {
    setRefused((part) => (part === 'photo' ? null : part));
    alter({ photo });
  };
  const refusePhoto = (): void => {
    setRefused('photo');
    alter({ photo: null });
  };
  const sending = useSending();
  // another motion has other joints, and other animations
  const move = (motion: Motion): void => {
    setRefused((part) => (part === 'motion' ? null : part));
    alter({ motion, joints: {}, clip: null });
  };
  const refuseMotion = (): void => {
    setRefused('motion');
    alter({ motion: noCharacter.motion, joints: {}, clip: null });
  };
  useDropsAnywhere(async (file) => {
    if (await isPicture(file)) setPhoto(file);
    else if (await isMotion(file)) move({ by: 'file', file });
    else return false;
    return true;
  }, refusePhoto);
  useEffect(() => {
    document.title = `${strings.make.character} · ${strings.name}`;
  }, []);

  const wrong = refused && (refused === 'motion' ? words.wrongMotion : strings.studio.wrongPicture);
  const missing = wrong ?? (photo ? '' : words.needPhoto);
  const order = photo ? () => characterOrder(photo, motion, { ...optionsOf(choices), ...said(joints, clip) }) : null;
  const start = (event: Event): void => {
    event.preventDefault();
    if (order && !missing) sending.begin(order());
  };
  const change = (part: Partial<Choices>): void => alter({ choices: { ...choices, ...part } });
  return (
    <>
      <form class="studio" onSubmit={start}>
        <header>
          <div>
            <Making kind="character" />
            <h1>{words.title}</h1>
            <p>{words.lead}</p>
          </div>
          <Demo
            still="/samples/woman-in-red-still.jpg"
            moving="/samples/woman-in-red-walk.mp4"
            alt={strings.demo.character}
            width={400}
            height={532}
          />
        </header>
        <div class="beside">
          <section class="panel" aria-labelledby="photo-title">
            <h2 id="photo-title">{words.photo}</h2>
            <p class="hint">{words.photoHint}</p>
            <Samples names={figureSamples} chosen={photo} onChoose={setPhoto} />
            <Dropzone
              media="image"
              file={photo}
              accept={pictureTypes}
              accepts={isPicture}
              words={{
                drop: strings.studio.portraitDrop,
                browse: strings.studio.portraitBrowse,
                chosen: words.photoChosen,
                wrong: strings.studio.wrongPicture,
              }}
              onFile={setPhoto}
              refused={refused === 'photo'}
              onRefused={refusePhoto}
            />
            <Capture media="image" of="body" onFile={setPhoto} />
          </section>
        </div>
        <section class="panel" aria-labelledby="motion-title">
          <h2 id="motion-title">{words.motion}</h2>
          <p class="hint">{words.motionHint}</p>
          <Motions
            chosen={motion}
            onChoose={move}
            refused={refused === 'motion'}
            onRefused={refuseMotion}
            joints={joints}
            onJoints={(joints) => alter({ joints })}
            clip={clip}
            onClip={(clip) => alter({ clip })}
          />
          <details class="choices">
            <summary>{strings.studio.options}</summary>
            <div class="fields paired">
              <KeepField value={choices} onChange={change} />
              <VideoFields value={choices} onChange={change} />
              <CharacterFields value={choices} onChange={change} />
            </div>
          </details>
        </section>
        <Launch sending={sending} missing={missing} chosen={order && namesOf(order())} label={words.start} />
      </form>
      <Recent />
    </>
  );
}
