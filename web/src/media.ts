/** Which files may be a picture, a performance, a motion. The service looks closer; this is for a quick word. */

const pictures = /\.(jpe?g|png|webp|hei[cf]|avif)$/i;
const videos = /\.(mp4|m4v|mov|webm|mkv|gif)$/i;
const motions = /\.(bvh|glb|gltf)$/i;

export const pictureTypes = 'image/jpeg,image/png,image/webp,image/heic,image/heif,image/avif,.heic,.heif,.avif';
/** Of masks, which every browser reads and which lose nothing: PNG before all. */
export const maskTypes = 'image/png,image/webp,image/bmp,image/jpeg';
export const videoTypes = 'video/*,image/gif,.mkv,.mov';
export const motionTypes = '.bvh,.glb,.gltf,model/gltf-binary,model/gltf+json';

export const isPicture = (file: File): boolean =>
  pictures.test(file.name) || (file.type.startsWith('image/') && file.type !== 'image/gif');

export const isVideo = (file: File): boolean =>
  videos.test(file.name) || file.type.startsWith('video/') || file.type === 'image/gif';

export const isMotion = (file: File): boolean => motions.test(file.name) || file.type.startsWith('model/gltf');
