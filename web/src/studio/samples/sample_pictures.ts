/** Pictures to begin with, for who has none at hand: the service hands them out, under addresses that programs may use too. */

export interface SamplePicture {
  /** In its addresses. */
  readonly name: string;
  /** As its file is called, and what is made of it. */
  readonly title: string;
  /** What is seen in it. */
  readonly alt: string;
  /** Of the small one, which is 88 pixels wide: a square of a portrait, all of a figure. */
  readonly smallHeight: number;
}

type Named = Pick<SamplePicture, 'name'>;

export const sampleUrl = ({ name }: Named): string => `/samples/${name}.jpg`;
/** For choosing. */
export const smallUrl = ({ name }: Named): string => `/samples/${name}-small.jpg`;

export const fileName = ({ title }: SamplePicture): string => `${title}.jpg`;

/** A sample as a file of the visitor's own would be. */
export async function sampleFile(sample: SamplePicture): Promise<File> {
  const answer = await fetch(sampleUrl(sample));
  if (!answer.ok) throw new Error(`${answer.status}`);
  return new File([await answer.blob()], fileName(sample), { type: 'image/jpeg' });
}

export const isSample = (file: File | null, sample: SamplePicture): boolean => file?.name === fileName(sample);
