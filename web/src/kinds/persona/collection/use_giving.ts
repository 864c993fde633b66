/** Files that are given to a collection: looked into, and then told. */

import { useState } from 'preact/hooks';
import type { Collected } from '../../../studio/given_files/collection';
import { type Given, photosAmong } from './photo_files';

export interface Giving {
  /** They are being looked into. */
  reading: boolean;
  give: (files: Promise<readonly Collected[]>) => void;
}

/** `onRefused` is called where there is no photo among them. */
export function useGiving(onGiven: (given: Given) => void, onRefused: () => void): Giving {
  const [reading, setReading] = useState(0);
  const look = async (files: Promise<readonly Collected[]>): Promise<void> => {
    setReading((turns) => turns + 1);
    try {
      const given = await files;
      const among = await photosAmong(given);
      if (among.photos.length) onGiven(among);
      else if (given.length) onRefused();
    } finally {
      setReading((turns) => turns - 1);
    }
  };
  return { reading: reading > 0, give: (files) => void look(files) };
}
