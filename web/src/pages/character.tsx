/** The start page of characters: a picture of somebody, a motion, and off it goes. */

import { useEffect, useState } from 'preact/hooks';
import type { CharacterOptions, MotionJoints } from '../api';
import { CharacterFields, type Choices, KeepField, optionsOf, usual, VideoFields } from '../character/choices';
import { Motions } from '../character/motions';
import { Capture } from '../components/capture';
import { useDropsAnywhere } from '../components/drops';
import { Dropzone } from '../components/dropzone';
import { Launch } from '../components/launch';
import { Making } from '../components/making';
import { Recent } from '../components/recent';
import { isMotion, isPicture, pictureTypes } from '../media';
import { USUAL_MOTION } from '../names';
import { characterOrder, type Motion } from '../order';
import { useSending } from '../sending';
import { strings } from '../strings';

const words = strings.character;

/** What is said of the motion, where there is something to say. */
const said = (joints: MotionJoints, clip: string | null): CharacterOptions => ({
  ...(Object.keys(joints).length && { motion_joints: joints }),
  ...(clip !== null && { motion_clip: clip }),
});

export default function CharacterStudio() {
  const [photo, setPhoto] = useState<File | null>(null);
  const [motion, setMotion] = useState<Motion>({ by: 'name', name: USUAL_MOTION });
  const [joints, setJoints] = useState<MotionJoints>({});
  const [clip, setClip] = useState<string | null>(null);
  const [choices, setChoices] = useState<Choices>(usual);
  const sending = useSending();
  const move = (next: Motion): void => {
    setMotion(next);
    setJoints({}); // another motion has other joints, and other animations
    setClip(null);
  };
  useDropsAnywhere((file) => {
    if (isPicture(file)) setPhoto(file);
    else if (isMotion(file)) move({ by: 'file', file });
  });
  useEffect(() => {
    document.title = `${strings.make.character} · ${strings.name}`;
  }, []);

  const start = (event: Event): void => {
    event.preventDefault();
    if (photo) sending.begin(characterOrder(photo, motion, { ...optionsOf(choices), ...said(joints, clip) }));
  };
  const change = (part: Partial<Choices>): void => setChoices((known) => ({ ...known, ...part }));
  return (
    <>
      <form class="studio" onSubmit={start}>
        <header>
          <Making kind="character" />
          <h1>{words.title}</h1>
          <p>{words.lead}</p>
        </header>
        <div class="beside">
          <section class="panel" aria-labelledby="photo-title">
            <h2 id="photo-title">{words.photo}</h2>
            <p class="hint">{words.photoHint}</p>
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
            joints={joints}
            onJoints={setJoints}
            clip={clip}
            onClip={setClip}
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
        <Launch sending={sending} missing={photo ? '' : words.needPhoto} label={words.start} />
      </form>
      <Recent />
    </>
  );
}
