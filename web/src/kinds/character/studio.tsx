/** The start page of characters: a picture of somebody, a motion, and off it goes. */

import type { CharacterOptions } from './types';
import { CharacterFields, type Choices, KeepField, optionsOf, defaults, VideoFields } from './choices';
import { MotionPicker } from '../../motion/motion_picker';
import { useDropsAnywhere } from '../../studio/given_files/drops';
import { Demo } from '../../studio/samples/demo';
import { StudioForm, useStudioTitle } from '../../studio/form';
import { PicturePanel } from '../../studio/given_files/picture_panel';
import { RecentWorks } from '../../works/recent_works';
import { useDraft } from '../../studio/draft';
import { useRefusals } from '../../studio/refusals';
import { isMotion, isPicture } from '../../studio/given_files/media_types';
import type { StudioProps } from '../../kind/kind';
import { DEFAULT_MOTION } from '../../motion/motion_names';
import type { Motion, MotionJoints } from '../../motion/types';
import { words as motionWords } from '../../motion/words';
import { characterOrder } from './order';
import { samples } from './samples';
import { useSending } from '../../sending/use_sending';
import { strings } from '../../language/strings';
import { words as characterWords } from './words';

const words = characterWords.character;

/** What is said of the motion, where there is something to say. */
const said = (joints: MotionJoints, clip: string | null): CharacterOptions => ({
  ...(Object.keys(joints).length && { motion_joints: joints }),
  ...(clip !== null && { motion_clip: clip }),
});

interface Draft {
  photo: File | null;
  motion: Motion;
  joints: MotionJoints;
  /** Which of the motion's animations. */
  clip: string | null;
  choices: Choices;
}

const EMPTY_DRAFT: Draft = {
  ...{ photo: null, motion: { by: 'name', name: DEFAULT_MOTION }, joints: {}, clip: null, choices: defaults },
};

export default function CharacterStudio({ kind }: StudioProps) {
  const [{ photo, motion, joints, clip, choices }, alter] = useDraft(kind.name, EMPTY_DRAFT);
  const { refused, refuse, accept } = useRefusals<'photo' | 'motion'>(kind.name);
  const setPhoto = (photo: File): void => {
    accept('photo');
    alter({ photo });
  };
  const refusePhoto = (): void => {
    refuse('photo');
    alter({ photo: null });
  };
  const sending = useSending();
  useStudioTitle(kind);
  // another motion has other joints, and other animations
  const move = (motion: Motion): void => {
    accept('motion');
    alter({ motion, joints: {}, clip: null });
  };
  const refuseMotion = (): void => {
    refuse('motion');
    alter({ motion: EMPTY_DRAFT.motion, joints: {}, clip: null });
  };
  useDropsAnywhere(async (file) => {
    if (await isPicture(file)) setPhoto(file);
    else if (await isMotion(file)) move({ by: 'file', file });
    else return false;
    return true;
  }, refusePhoto);

  const wrong = refused.photo ? strings.studio.wrongPicture : refused.motion ? motionWords.wrong : null;
  const missing = wrong ?? (photo ? '' : words.needPhoto);
  const order = photo ? () => characterOrder(photo, motion, { ...optionsOf(choices), ...said(joints, clip) }) : null;
  const change = (part: Partial<Choices>): void => alter({ choices: { ...choices, ...part } });
  return (
    <>
      <StudioForm
        kind={kind}
        title={words.title}
        lead={words.lead}
        demo={
          <Demo
            still="/samples/woman-in-red-still.jpg"
            moving="/samples/woman-in-red-walk.mp4"
            alt={characterWords.demo}
            width={400}
            height={532}
          />
        }
        sending={sending}
        missing={missing}
        order={order}
        label={words.start}
      >
        <PicturePanel
          title={words.photo}
          hint={words.photoHint}
          samples={samples}
          of="body"
          file={photo}
          chosenLabel={words.photoChosen}
          refused={refused.photo === true}
          onFile={setPhoto}
          onRefused={refusePhoto}
        />
        <section class="panel" aria-labelledby="motion-title">
          <h2 id="motion-title">{words.motion}</h2>
          <p class="hint">{words.motionHint}</p>
          <MotionPicker
            chosen={motion}
            onChoose={move}
            refused={refused.motion === true}
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
      </StudioForm>
      <RecentWorks />
    </>
  );
}
