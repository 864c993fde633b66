/** The avatar in `@google/model-viewer`. */

import '@google/model-viewer';

const viewer = document.createElement('model-viewer');
viewer.src = '/avatar.glb';
viewer.autoplay = true;
viewer.animationName = 'wave';
document.getElementById('avatar')!.append(viewer);
await new Promise((loaded, failed) => {
  viewer.addEventListener('load', loaded, { once: true });
  viewer.addEventListener('error', failed, { once: true });
});
Object.assign(window, { page: viewer });
