"""Where the person is in the frames of a film: small masks, from what networks believe, from colours, and from what is known
to be the room or the person by its place in space."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.scene_cameras import ClipScene
from engine.imaging.masks.colour_segmentation import grab_cut
from engine.imaging.masks.mask_pieces import without_small_pieces
from engine.imaging.resample import resized, size_within
from engine.perception.masks.segmentation import people_confidence
from engine.perception.solutions import kept_networks

MASK_SIDE_PIXELS = 480
"""Pixels of the longer side."""
MIN_SURE_PROBABILITY = 0.9
"""Belief of the networks in a person from which they are trusted; they are, too, below one less that."""
MASK_SPECK_SHARE = 0.002
"""Of a mask's pixels: smaller pieces are nobody's, and smaller holes are nothing between arm and body."""
SIDES_PER_MARK_RADIUS = 100
"""A point marks what is around it: a spot with a radius of this part of the longer side."""


@kept_networks()
def believed_masks(frames: Sequence[NDArray[np.uint8]], whole: bool) -> list[NDArray[np.float32]]:
    """What networks believe to be the person, (h, w) in [0, 1] of each frame (H, W, 3); `whole`: they are seen from head to
    foot, or nearly."""
    return [people_confidence(resized(frame, size_within(frame.shape, MASK_SIDE_PIXELS)), whole) for frame in frames]


def settled_masks(
    frames: Sequence[NDArray[np.uint8]],
    beliefs: Sequence[NDArray[np.float32]],
    scene: ClipScene | None = None,
    person: NDArray[np.bool_] | None = None,
) -> list[NDArray[np.bool_]]:
    """Masks (h, w) bool as large as the beliefs: colours decide where networks are not sure, and points that were found
    overrule them.

    Parameters
    ----------
    scene, person : a reconstruction of the same frames, and which (T,) of its tracks are the person's; the other points are
        the room's.
    """
    masks = []
    for index, (frame, belief) in enumerate(zip(frames, beliefs, strict=True)):
        small = resized(frame, (belief.shape[1], belief.shape[0]))
        ours, others = belief > MIN_SURE_PROBABILITY, belief < 1 - MIN_SURE_PROBABILITY
        rather = belief > 0.5
        if scene is not None and person is not None:
            mine, theirs = _marks(scene, person, index, belief.shape)
            ours, others = (ours & ~theirs) | (mine & ~theirs), (others & ~mine) | (theirs & ~mine)
            rather = (rather | mine) & ~others
        if ours.any() and others.any():
            rather = grab_cut(small, ours, others, rather, rounds=2)
        masks.append(_without_specks(rather))
    return masks


def _without_specks(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """A mask (h, w) without pieces and holes as small as the spots that points mark."""
    least = MASK_SPECK_SHARE * mask.size
    filled = ~without_small_pieces(~mask, least)
    return without_small_pieces(filled, least)


def _marks(
    scene: ClipScene, person: NDArray[np.bool_], index: int, shape: tuple[int, ...]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Where (h, w) points of the person, and of the room, are seen in a frame."""
    found = scene.reconstruction
    marks = []
    for chosen in (person, ~person):
        here = found.agreed & (found.seen.camera == index) & chosen[found.seen.point]
        drawn = np.zeros(shape, np.uint8)
        scale = shape[0] / scene.size[0]
        for x, y in np.rint((found.seen.pixels[here] + 0.5) * scale - 0.5).astype(int).tolist():
            cv2.circle(drawn, (x, y), max(1, max(shape) // SIDES_PER_MARK_RADIUS), (1,), -1)
        marks.append(drawn > 0)
    return marks[0], marks[1]
