/** Pictures to begin with, for who has none at hand: the service hands them out, under addresses that programs may use too. */

export const portraitSamples = ['grace-hopper', 'eileen-collins', 'painted-man', 'rendered-man'] as const;
export const figureSamples = ['woman-in-red', 'man-in-green'] as const;

export type SampleName = (typeof portraitSamples)[number] | (typeof figureSamples)[number];

export const sampleUrl = (name: SampleName): string => `/samples/${name}.jpg`;
/** For choosing: a square of a portrait, all of a figure. */
export const smallUrl = (name: SampleName): string => `/samples/${name}-small.jpg`;

/** As its file is called, and what is made of it. */
const titles: Record<SampleName, string> = {
  'grace-hopper': 'Grace Hopper',
  'eileen-collins': 'Eileen Collins',
  'painted-man': 'Painted man',
  'rendered-man': 'Rendered man',
  'woman-in-red': 'Woman in red',
  'man-in-green': 'Man in green',
};
export const fileName = (name: SampleName): string => `${titles[name]}.jpg`;

/** A sample as a file of the visitor's own would be. */
export async function sampleFile(name: SampleName): Promise<File> {
  const answer = await fetch(sampleUrl(name));
  if (!answer.ok) throw new Error(`${answer.status}`);
  return new File([await answer.blob()], fileName(name), { type: 'image/jpeg' });
}

export const isSample = (file: File | null, name: SampleName): boolean => file?.name === fileName(name);
