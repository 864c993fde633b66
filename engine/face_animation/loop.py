"""A performance that repeats without a jump."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.perception.face_track.face_crop import interpolate_crops
from engine.perception.face_track.track import FaceTrack

EASE_SECONDS = 0.6
"""The end eases into the beginning over this long, or half the clip if that is shorter."""


def close_loop(track: FaceTrack) -> FaceTrack:
    """A track whose last frames are led smoothly to where the first begins, the face's looks with them.

    The frame after the last is the first: the weight of the beginning would reach 1 just there.
    """
    count = len(track)
    frames = int(min(round(EASE_SECONDS * track.fps), count // 2))
    t = np.arange(1, frames + 1) / (frames + 1)
    weight = (t * t * (3 - 2 * t)).astype(np.float32)
    meshes, places = track.meshes.copy(), track.crop_places.copy()
    first, crops = track.face_crop(0), []
    for frame, share in zip(range(count - frames, count), weight.tolist(), strict=True):
        look = interpolate_crops(track.face_crop(frame), first, share)
        meshes[frame], places[frame] = look.mesh, look.place
        crops.append(look.crop)
    periphery, trust = track.periphery.copy(), track.trust.copy()
    periphery[count - frames :] += weight[:, None, None] * (periphery[0] - periphery[count - frames :])
    trust[count - frames :] += weight[:, None] * (trust[0] - trust[count - frames :])
    return replace(
        track,
        meshes=meshes,
        periphery=periphery,
        trust=trust,
        crops=replace(track.crops, ending=np.array(crops, np.uint8)),
        crop_places=places,
        closed=True,
    )
