/** Which files may be a picture, a performance, a motion, an archive: told by their first bytes, as the service does, never by their names. */

export const pictureTypes = 'image/jpeg,image/png,image/webp,image/heic,image/heif,image/avif,.heic,.heif,.avif';
/** Of masks, which every browser reads and which lose nothing: PNG before all. */
export const maskTypes = 'image/png,image/webp,image/bmp,image/jpeg';
export const videoTypes = 'video/*,image/gif,.mkv,.mov';
export const motionTypes = '.bvh,.glb,.gltf,model/gltf-binary,model/gltf+json';

export const archiveTypes = '.zip,.tar,.tgz,.gz,.bz2,.xz,application/zip,application/x-tar,application/gzip';

export type Media = 'picture' | 'video' | 'motion' | 'archive';

/** As many first bytes tell what a file is. */
const HEAD = 512;
/** Brands of ISO base media files (the four letters after `ftyp`) that are pictures; others are movies. */
const STILLS = /^(hei[cmsx]|hev[cx]|mif[12]|msf1|avi[fs])$/;
/** How archives begin, compressed ones included; a plain TAR says so further on. */
const ARCHIVE = /^(PK\x03\x04|\x1f\x8b|BZh|\xfd7zXZ\0)/;
const TAR_AT = 257;
const SOUND = /^M4[ABP] $/;

/** What a file that begins with these bytes is; null where it is nothing that can be read. */
export function mediaOf(head: Uint8Array): Media | null {
  const text = Array.from(head, (byte) => String.fromCharCode(byte)).join('');
  const starts = (what: string): boolean => text.startsWith(what);
  if (starts('\xff\xd8\xff') || starts('\x89PNG\r\n\x1a\n')) return 'picture';
  if (/^GIF8[79]a/.test(text) || starts('\x1a\x45\xdf\xa3')) return 'video';
  if (starts('RIFF')) return { 'WEBP': 'picture', 'AVI ': 'video' }[text.slice(8, 12)] as Media | undefined ?? null;
  if (ARCHIVE.test(text) || text.startsWith('ustar', TAR_AT)) return 'archive';
  const box = text.slice(4, 8);
  if (box === 'ftyp') {
    const brand = text.slice(8, 12);
    return STILLS.test(brand) ? 'picture' : SOUND.test(brand) ? null : 'video';
  }
  if (/^(moov|mdat|wide|free|skip|pnot)$/.test(box)) return 'video';
  if (starts('glTF') || /^(\xef\xbb\xbf)?\s*(HIERARCHY|\{\s*")/i.test(text)) return 'motion';
  return null;
}

/** What a file is; null where it is nothing that can be read. */
export const mediaIn = async (file: File): Promise<Media | null> => {
  try {
    return mediaOf(new Uint8Array(await file.slice(0, HEAD).arrayBuffer()));
  } catch {
    return null; // it was moved or deleted since it was chosen
  }
};

export const isPicture = async (file: File): Promise<boolean> => (await mediaIn(file)) === 'picture';
export const isVideo = async (file: File): Promise<boolean> => (await mediaIn(file)) === 'video';
export const isMotion = async (file: File): Promise<boolean> => (await mediaIn(file)) === 'motion';
