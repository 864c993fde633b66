/** The motion of a job that is made again: what it was made with, what is wished for, and what of it is asked for. */

import type { Job } from '../api';
import { fileTitle } from '../language/format';
import { plain } from '../language/strings';
import { motionName } from './motion_names';
import type { GivenInput, Motion, MotionJoints, MotionName } from './types';

export interface MotionDraft {
  motion: Motion | GivenInput;
  motionJoints: MotionJoints;
  /** Which of the motion's animations; null for the first in which something moves. */
  motionClip: string | null;
}

/** What a job was made with; `usual` moves it where nothing was said. */
export function motionDraftOf({ inputs, options }: Job, usual: MotionName): MotionDraft {
  const made = options as { motion?: MotionName; motion_joints?: MotionJoints; motion_clip?: string | null };
  const { motion } = inputs;
  return {
    motion: typeof motion === 'string' ? { by: 'held', input: motion } : { by: 'name', name: made.motion ?? usual },
    motionJoints: made.motion_joints ?? {},
    motionClip: made.motion_clip ?? null,
  };
}

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** What a revision asks for of its motion, but for a file, which has to be sent. */
export function motionChanges(before: MotionDraft, now: MotionDraft): { corrections: object; options: object } {
  const { motion, motionJoints: joints } = now;
  const renamed = motion.by === 'name' && !same(before.motion, motion);
  return {
    corrections: {
      ...(renamed && before.motion.by === 'held' && { motion: null }),
      ...(motion.by === 'kept' && { motion: motion.name }),
      ...(!same(before.motionClip, now.motionClip) && { motion_clip: now.motionClip }),
      ...(!same(before.motionJoints, joints) && { motion_joints: Object.keys(joints).length ? joints : null }),
    },
    options: renamed ? { motion: motion.name } : {},
  };
}

/** What a motion is called in an order. */
export function motionTitle(motion: Motion): string {
  switch (motion.by) {
    case 'name':
      return motionName(motion.name);
    case 'kept':
      return plain(motion.name);
    case 'file':
      return fileTitle(motion.file);
  }
}
