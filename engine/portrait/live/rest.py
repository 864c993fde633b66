"""The face before the camera at rest, found in its first second: what every later frame is held against (section 4).

A clip's neutral frame is chosen when all of it is known. Here whoever sits before the camera looks into it calmly for a
second; the median of the frames that show this is the rest.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarities
from engine.perception.expression.measures import LID_MEASURES, MEASURES, measure
from engine.perception.face.landmarks import RIGID_VERTICES, eye_distance
from engine.perception.face_track.face_crop import FaceCrop

REST_SECONDS = 1.0
"""Seconds of calm frames that make a rest."""
MIN_REST_FRAMES = 6
"""Calm frames that make a rest, at least: a slow camera takes longer."""
REMEMBERED_SECONDS = 4.0
"""Seconds after which a frame counts no more."""
MAX_WAIT_SECONDS = 5.0
"""Seconds of a face that never is calm after which its calmest frames have to do: some mouths are never shut."""
MAX_YAW_RADIANS, MAX_PITCH_RADIANS = np.deg2rad((18.0, 20.0))
"""Radians by which the head may be turned aside, or up and down. Cameras stand above screens, or below them."""
MIN_LID_OPENING = 0.13
"""Gap between an eye's lids, over its width, below which it is shut, as of a target."""
MAX_MOUTH_OPENING_EYE_DISTANCES = 0.12
"""Eye distances between the lips from which on the mouth is open."""
MAX_EYE_DISTANCES_PER_SECOND = 1.5
"""Eye distances a second from which on the head moves too fast: its picture is blurred."""
BLINK_SHARE = 0.8
"""Share of how far the lids usually are open in the calm frames below which a frame blinks, and tells nothing of the rest."""

Obstacle = Literal["turned", "eyes_shut", "mouth_open", "moving"]
"""Why a frame is not calm: what whoever sits before the camera should mend."""


@dataclass(frozen=True)
class Calibration:
    """How far the rest is found.

    fraction : of the calm frames that it takes, in [0, 1].
    obstacle : why the last frame was not calm.
    rest : once it is there.
    """

    fraction: float
    obstacle: Obstacle | None = None
    rest: FaceCrop | None = None


@dataclass(frozen=True)
class _Observation:
    """A look at its `time`, seconds, on show for a `span`; calm where its `unrest` is less than 1."""

    time: float
    span: float
    unrest: float
    look: FaceCrop


class RestCalibration:
    """Takes in the camera's looks until the calm ones among the last few seconds make a rest, or patience ends. The head need not
    be where it was: faces are laid on each other."""

    def __init__(self) -> None:
        self._seen: deque[_Observation] = deque()
        self._waited = 0.0

    def __call__(self, look: FaceCrop, time: float) -> Calibration:
        """Take in how the face looks at a `time`, seconds."""
        span, moved = 0.0, 0.0
        if self._seen:
            last = self._seen[-1]
            span = min(max(time - last.time, 0.0), REST_SECONDS / MIN_REST_FRAMES)
            moved = _way(last.look, look) / span if span else 0.0
        unrest = _unrest(look, moved)
        worst = max(unrest, key=lambda obstacle: unrest[obstacle])
        self._seen.append(_Observation(time, span, unrest[worst], look))
        self._waited += span
        while self._seen[0].time < time - REMEMBERED_SECONDS:
            self._seen.popleft()
        calm = [one for one in self._seen if one.unrest < 1]
        lasted = min(sum(one.span for one in calm) / REST_SECONDS, len(calm) / MIN_REST_FRAMES)
        fraction = float(min(max(lasted, self._waited / MAX_WAIT_SECONDS), 1.0))
        rest = None
        if lasted >= 1:
            rest = median_look([one.look for one in calm])
        elif fraction == 1 and len(self._seen) >= MIN_REST_FRAMES:
            calmest = sorted(self._seen, key=lambda one: one.unrest)[:MIN_REST_FRAMES]
            rest = median_look([one.look for one in calmest])
        return Calibration(fraction, None if unrest[worst] < 1 else worst, rest)


def median_look(looks: list[FaceCrop]) -> FaceCrop:
    """The look of a face at rest from calm ones: the median of their faces where they do not blink, in the place and with the
    appearance of the one that is nearest to it."""
    meshes = np.stack([look.mesh for look in looks]).astype(float)
    lids = measure(meshes)[:, LID_MEASURES].min(axis=1)
    open_ones = np.flatnonzero(lids >= BLINK_SHARE * np.median(lids))
    meshes = meshes[open_ones]
    middle = _in_place_of(meshes, meshes[len(meshes) // 2])
    apart = np.abs(middle - np.median(middle, axis=0)).mean(axis=(1, 2))
    nearest = int(apart.argmin())
    mesh = np.median(_in_place_of(meshes, meshes[nearest]), axis=0).astype(np.float32)
    return replace(looks[int(open_ones[nearest])], mesh=mesh)


def _way(one: FaceCrop, other: FaceCrop) -> float:
    """How far the head's middle is from one look to another, in its eye distances."""
    before, after = (look.mesh[list(RIGID_VERTICES), :2].mean(axis=0) for look in (one, other))
    return float(np.linalg.norm(after - before) / eye_distance(other.mesh[:, :2]))


def _unrest(look: FaceCrop, speed: float) -> dict[Obstacle, float]:
    """How far a look is from a calm one, by what may be in the way, as shares of what is borne. `speed` in eye distances a
    second."""
    values = measure(look.mesh[None].astype(float))[0]
    yaw, pitch, mouth = (float(values[MEASURES.index(name)]) for name in ("yaw", "pitch", "mouth_open"))
    return {
        "turned": max(abs(yaw) / MAX_YAW_RADIANS, abs(pitch) / MAX_PITCH_RADIANS),
        "eyes_shut": MIN_LID_OPENING / max(float(values[LID_MEASURES].min()), 1e-3),
        "mouth_open": mouth / MAX_MOUTH_OPENING_EYE_DISTANCES,
        "moving": speed / MAX_EYE_DISTANCES_PER_SECOND,
    }


def _in_place_of(meshes: NDArray[np.float64], one: NDArray[np.float64]) -> NDArray[np.float64]:
    """Meshes (N, 478, 3) brought by similarities to where `one` (478, 3) is, by the vertices that no expression moves."""
    rigid = list(RIGID_VERTICES)
    scale, rotation, shift = fit_similarities(one[rigid], meshes[:, rigid], np.ones(len(rigid)))
    return np.asarray(np.einsum("nji,nvj->nvi", rotation, meshes - shift[:, None]) / scale[:, None, None], float)
