/** The start page of avatars: two clips of somebody, how they are filmed, who agreed, and off it goes. */

import { Consent } from '../../studio/consent';
import { useDraft } from '../../studio/draft';
import { useDropsAnywhere } from '../../studio/given_files/drops';
import { StudioForm, useStudioTitle } from '../../studio/form';
import { isMotion, isVideo } from '../../studio/given_files/media_types';
import { useRefusals } from '../../studio/refusals';
import type { StudioProps } from '../../kind/kind';
import { strings } from '../../language/strings';
import { MotionPicker } from '../../motion/motion_picker';
import type { Motion, MotionJoints } from '../../motion/types';
import { words as motionWords } from '../../motion/words';
import { useSending } from '../../sending/use_sending';
import { RecentWorks } from '../../works/recent_works';
import type { Options } from '../generic/fields';
import { DriverField } from './driver_field';
import { FurtherClips } from './further_clips';
import { Advice } from './guide/advice';
import { ClipPanel } from './guide/clip_panel';
import { heightIn } from './height';
import { HeightField } from './height_field';
import { AvatarOptionFields } from './option_fields';
import { avatarOrder } from './order';
import { USUAL_MOTION } from './types';
import { words as avatarWords } from './words';
import './styles/studio.css';

const words = avatarWords.studio;

/** What is a video here, in the order in which those find their place that are dropped beside it. */
const videos = ['body', 'head', 'driver'] as const;
type Video = (typeof videos)[number];

interface Draft extends Record<Video, File | null> {
  /** Further clips of the person. */
  more: File[];
  motion: Motion;
  joints: MotionJoints;
  /** Which of the motion's animations. */
  clip: string | null;
  /** As it was written. */
  height: string;
  agreed: boolean;
  options: Options;
}

const EMPTY_DRAFT: Draft = {
  ...{ body: null, head: null, driver: null, motion: { by: 'name', name: USUAL_MOTION }, joints: {}, clip: null },
  ...{ more: [], height: '', agreed: false, options: {} },
};

export default function AvatarStudio({ kind }: StudioProps) {
  const [draft, change] = useDraft(kind.name, EMPTY_DRAFT);
  const { refused, refuse, accept } = useRefusals<Video | 'more' | 'motion'>(kind.name);
  const sending = useSending();
  useStudioTitle(kind);
  const give = (video: Video, file: File | null): void => {
    accept(video);
    // other clips may show somebody else: that has to be said anew
    change((before) => ({ [video]: file, ...(video !== 'driver' && before[video] && { agreed: false }) }));
  };
  const refuseVideo = (video: Video): void => {
    refuse(video);
    change({ [video]: null });
  };
  const addClip = (file: File): void => {
    accept('more');
    change(({ more }) => ({ more: [...more, file], agreed: false }));
  };
  const removeClip = (file: File): void => {
    accept('more');
    change(({ more }) => ({ more: more.filter((one) => one !== file) }));
  };
  // another motion has other joints, and other animations
  const move = (motion: Motion): void => {
    accept('motion');
    change({ motion, joints: {}, clip: null });
  };
  const refuseMotion = (): void => {
    refuse('motion');
    change({ motion: EMPTY_DRAFT.motion, joints: {}, clip: null });
  };
  useDropsAnywhere(async (file) => {
    if (await isVideo(file)) give(videos.find((video) => !draft[video]) ?? 'body', file);
    else if (await isMotion(file)) move({ by: 'file', file });
    else return false;
    return true;
  }, () => refuseVideo('body'));

  const place = (video: Video) => ({
    file: draft[video],
    refused: refused[video] === true,
    onFile: (file: File | null) => give(video, file),
    onRefused: () => refuseVideo(video),
  });
  return (
    <>
      <StudioForm
        kind={kind}
        title={words.title}
        lead={words.lead}
        sending={sending}
        missing={missingIn(draft, refused)}
        order={draft.body ? () => orderOf(draft, draft.body!) : null}
        label={words.start}
      >
        <ClipPanel clip="body" {...place('body')} />
        <ClipPanel clip="head" optional={words.clips.head.without} {...place('head')} />
        <section class="panel wide" aria-label={words.further.title}>
          <FurtherClips
            files={draft.more}
            refused={refused.more === true}
            onAdded={addClip}
            onRemoved={removeClip}
            onRefused={() => refuse('more')}
          />
        </section>
        <Advice />
        <section class="panel" aria-labelledby="person-title">
          <h2 id="person-title">{words.person}</h2>
          <HeightField value={draft.height} onChange={(height) => change({ height })} />
          <Consent words={words} given={draft.agreed} onChange={(agreed) => change({ agreed })} />
        </section>
        <section class="panel wide" aria-labelledby="animation-title">
          <h2 id="animation-title">{words.animation}</h2>
          <p class="hint">{words.animationHint}</p>
          <MotionPicker
            chosen={draft.motion}
            onChoose={move}
            refused={refused.motion === true}
            onRefused={refuseMotion}
            joints={draft.joints}
            onJoints={(joints) => change({ joints })}
            clip={draft.clip}
            onClip={(clip) => change({ clip })}
          />
          <h3>{words.driver}</h3>
          <p class="hint">{words.driverHint}</p>
          <DriverField {...place('driver')} />
          <details class="choices">
            <summary>{strings.studio.options}</summary>
            <AvatarOptionFields value={draft.options} onChange={(options) => change({ options })} />
          </details>
        </section>
      </StudioForm>
      <RecentWorks />
    </>
  );
}

/** What stands in the way of an order; empty where nothing does. */
function missingIn({ body, height, agreed }: Draft, refused: Partial<Record<Video | 'more' | 'motion', boolean>>): string {
  if (refused.body || refused.head || refused.more) return words.wrongClip;
  if (refused.driver) return words.wrongDriver;
  if (refused.motion) return motionWords.wrong;
  if (!body) return words.needBody;
  if (Number.isNaN(heightIn(height))) return words.wrongHeight;
  return agreed ? '' : words.needConsent;
}

function orderOf({ head, more, driver, motion, joints, clip, height, options }: Draft, body: File) {
  const metres = heightIn(height);
  const said = {
    ...options,
    ...(metres !== null && { height_m: metres }),
    ...(Object.keys(joints).length && { motion_joints: joints }),
    ...(clip !== null && { motion_clip: clip }),
  };
  return avatarOrder({ body, head, more, motion, driver, options: said });
}
