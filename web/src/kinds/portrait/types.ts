/** What a portrait takes, and what it leaves that is read here. */

import type { components } from '../../openapi';

type Schemas = components['schemas'];

export type PortraitOptions = Partial<Schemas['PortraitOptions']>;
export type Part = NonNullable<PortraitOptions['follow']>[number];

/** A portrait's options where null takes one back to its default. */
export type PortraitChanges = { [Name in keyof PortraitOptions]: PortraitOptions[Name] | null };

/** The 68 landmarks that a job found in its picture, in pixels of the picture (landmarks.json). */
export interface Landmarks {
  size: [number, number];
  landmarks: [number, number][];
}
