/** What a persona takes, and what it leaves that is read here. */

import type { Job, Schemas } from '../../api';
import type { PictureSheet } from '../../widgets/sheet_cell';

export type PersonaOptions = Partial<Schemas['PersonaOptions']>;

export const personaOptions = (of: Job): PersonaOptions => of.options as PersonaOptions;

/** As many photos that can be used are needed, at least. */
export const MIN_PHOTOS = 15;
/** As many photos of who performs are needed, at least, where any are given. */
export const MIN_PERFORMER_PHOTOS = 8;

/** Why a face is of no use, in the order in which they are told: first what somebody has to say of. */
export const reasons = ['uncertain', 'left_out', 'covered', 'turned', 'blurred', 'tiny', 'duplicate', 'other_years', 'other_look', 'somebody_else'] as const;
export type Reason = (typeof reasons)[number];

/** A face of the collection, and what became of it. Faces are known by their places in the list. */
export interface Face {
  /** The name of the photo's file. */
  photo: string;
  kept: boolean;
  /** A later version of the service may have others. */
  reason: string | null;
}

/** The faces of all photos (faces.json), whose pictures are on a sheet (faces.jpg). */
export interface FaceSheet {
  /** Pixels of a face's picture. */
  tile: number;
  columns: number;
  faces: readonly Face[];
  /** Files that are no photos. */
  skipped: readonly { file: string; code: string }[];
}

export const picturesOf = ({ tile, columns, faces }: FaceSheet): PictureSheet => ({ columns, count: faces.length, cell: [tile, tile] });

/** Two faces, each of another person, where photos show two about as often. */
export const examplesIn = (job: Job): readonly number[] => (job.error?.found as { examples?: number[] } | undefined)?.examples ?? [];

/** Files of one order: as many as the service takes of photos. */
export const MAX_FILES = 800;

/** Expressions of the collection's own (gallery.json), side by side in gallery.jpg. */
export interface Gallery {
  /** Width and height of each, in pixels. */
  tile: readonly [number, number];
  columns: number;
  /** In their order; the face at rest has no photos of its own. */
  shown: readonly { name: string; photos?: number }[];
  /** What too few photos come near. */
  left_out: readonly { name: string; photos: number }[];
  photos_needed: number;
}

/** What is of the picture, and so goes along to another performance; the rest is of the photos, or of the performance. */
const CARRIED = ['size', 'composite', 'background', 'light'] as const;

export const carriedOver = (options: PersonaOptions): PersonaOptions =>
  Object.fromEntries(CARRIED.filter((name) => name in options).map((name) => [name, options[name]]));
