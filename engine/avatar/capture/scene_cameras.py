"""Where a film's cameras stood, from all that its frames show: the room as well as the person."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.geometry.multiview.structure_from_motion.mapping import Lens, Reconstruction, reconstruct
from engine.geometry.multiview.structure_from_motion.tracks import PairMatches
from engine.imaging.feature_matching import overlaps, verified_matches
from engine.imaging.features import Features, find_features

MAX_FEATURES_PER_FRAME = 4096
"""Features that are found in a frame, at most."""
NEXT_FRAMES = 4
"""Frames after each that it is matched with."""
FAR_FRAMES = 4
"""Frames elsewhere in the film that each is matched with: of the other orbit, and where an orbit closes."""
MIN_COMMON_FEATURES = 12
"""Large features in common with a frame elsewhere."""
USUAL_FOCAL_LENGTH_SIDES = 1.2
"""Focal length in longer sides of the picture, where nothing is known: adjusted as soon as there are cameras."""
MIN_REGISTERED_SHARE = 0.5
"""Share of the frames whose cameras must be found."""
STILL_SHIFT_SIDES = 0.02
"""Longer sides by which what is seen of the room moves between frames far apart: below, the camera stood still."""

Tick = Callable[[float], None]


@dataclass(frozen=True)
class ClipScene:
    """A film's `reconstruction` in a frame and scale of its own, the `features` of its frames, and the frames' `size`
    (height, width)."""

    reconstruction: Reconstruction
    features: tuple[Features, ...]
    size: tuple[int, int]

    @property
    def length(self) -> int:
        """The frames' longer side, pixels."""
        return max(self.size)

    def descriptors(self) -> NDArray[np.float32]:
        """(O, 128) what each observation looks like."""
        tracks = self.reconstruction.tracks
        begins = np.concatenate([[0], np.cumsum([len(one) for one in self.features])])
        together = np.concatenate([one.descriptors for one in self.features])
        return np.asarray(together[begins[tracks.image] + tracks.feature])


def solve_scene(
    frames: Sequence[NDArray[np.uint8]],
    favoured: Sequence[NDArray[np.bool_]] | None = None,
    lens: Lens | None = None,
    tick: Tick = lambda fraction: None,
) -> ClipScene:
    """The cameras of a film's frames.

    Parameters
    ----------
    frames : (H, W, 3) uint8 sRGB each, all of one size, in the film's order.
    favoured : (H, W) bool each, where half of the features are to be found: the person.
    lens : of these frames, if it is known.

    Raises `InputError`: `camera_stands_still`, `cameras_not_found`.
    """
    height, width = frames[0].shape[:2]
    length = max(height, width)
    masks: Sequence[NDArray[np.bool_] | None] = favoured or [None] * len(frames)
    with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="features") as pool:
        features = list(pool.map(lambda frame, mask: find_features(frame, MAX_FEATURES_PER_FRAME, mask), frames, masks))
        tick(0.3)
        chosen = film_pairs(features)
        found = pool.map(lambda pair: verified_matches(features[pair[0]], features[pair[1]], length), chosen)
        pairs = [PairMatches(i, j, matches) for (i, j), matches in zip(chosen, found, strict=True) if len(matches)]
    tick(0.7)
    if stands_still(features, length):
        raise InputError(
            "camera_stands_still",
            "The camera does not go around the person in this clip: film while you walk a full circle around them.",
        )
    middle = np.array([(width - 1) / 2, (height - 1) / 2])
    lens = lens or Lens(np.array([USUAL_FOCAL_LENGTH_SIDES * length, 0.0, 0.0]), middle)
    reconstruction = reconstruct(
        [one.pixels for one in features], pairs, lens, lambda fraction: tick(0.7 + 0.3 * fraction)
    )
    if reconstruction is None or reconstruction.registered.sum() < max(3, MIN_REGISTERED_SHARE * len(frames)):
        count = 0 if reconstruction is None else int(reconstruction.registered.sum())
        raise InputError(
            "cameras_not_found",
            f"Only {count} of {len(frames)} frames of this clip could be placed: walk slowly around the person, in good "
            "light, where floor and walls have some pattern.",
        )
    return ClipScene(reconstruction, tuple(features), (height, width))


def film_pairs(features: Sequence[Features]) -> list[tuple[int, int]]:
    """Pairs of frames to match, nearest in the film first: each with the next, and with those elsewhere that show the same."""
    count = len(features)
    shared = overlaps(features)
    pairs = {(i, i + step) for step in range(1, NEXT_FRAMES + 1) for i in range(count - step)}
    for i in range(count):
        elsewhere = [j for j in range(count) if abs(i - j) > NEXT_FRAMES and shared[i, j] >= MIN_COMMON_FEATURES]
        best = sorted(elsewhere, key=lambda j: -shared[i, j])[:FAR_FRAMES]
        pairs |= {(min(i, j), max(i, j)) for j in best}
    return sorted(pairs, key=lambda pair: (pair[1] - pair[0], pair))


def stands_still(features: Sequence[Features], length: int) -> bool:
    """Whether what frames show a quarter of the film apart, is where it was."""
    step = max(1, len(features) // 4)
    votes = []
    for i in range(0, len(features) - step, step):
        matches = verified_matches(features[i], features[i + step], length)
        shifts = features[i].pixels[matches[:, 0]] - features[i + step].pixels[matches[:, 1]]
        votes.append(len(matches) > 0 and float(np.median(np.linalg.norm(shifts, axis=1))) < STILL_SHIFT_SIDES * length)
    return bool(votes) and all(votes)


def with_reconstruction(scene: ClipScene, reconstruction: Reconstruction) -> ClipScene:
    """The scene of a film with another reconstruction of its cameras."""
    return replace(scene, reconstruction=reconstruction)
