"""How clearly each frame shows each emotion: prototypes that can be read, in units of a clear movement.

A prototype says in which movements an emotion shows (Ekman and Friesen, Facial Action Coding System, 1978; AU are the
numbers of its action units), and reaches 1 where all that it needs is clearly there. The smallest of its parts counts,
so that nothing is claimed on one sign alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from engine.perception.expression.measures import MEASURES

CLEAR_MOVEMENTS: Mapping[str, float] = {
    "corners_up": 0.085,
    "corners_down": 0.05,
    "mouth_wider": 0.08,
    "jaw_dropped": 0.12,
    "brows_raised": 0.042,
    "brows_lowered": 0.05,
    "brows_drawn": 0.03,
    "inner_brows": 0.026,
    "brows_oblique": 0.022,
    "eyes_wider": 0.20,
    "eyes_narrower": 0.08,
    "eye_shut": 0.55,
}
"""Differences from the person's own rest at which a movement is clearly there, in eye distances; those of the eyes are
shares of how far they are open at rest. They lie at about two thirds of what the normal built-in performances reach at
their height, and above what talking, nodding and waiting people reach in the clips of `benchmarks/driver_segments`."""

GAPING_EYE_DISTANCES = 0.45
"""Eye distances: a mouth that is open wider shouts or yawns, whatever its corners do."""
PARTED_EYE_DISTANCES = 0.05
"""Eye distances up to which an open mouth counts as closed."""

MAX_POUT_EYE_DISTANCES = 0.06
"""Eye distances by which a mouth may be narrower in sadness; beyond, it purses its lips or speaks."""

OUTER_BROW_SCALE_EYE_DISTANCES = 0.015
"""Eye distances by which the outer end of a brow comes more than 0.7 of the inner end's way in surprise. In fear, which
shares raised brows and wide eyes with it, the outer end stays behind (AU 1 with 4)."""
MOUTH_WIDTH_SCALE_EYE_DISTANCES = 0.06
"""Eye distances by which the mouth narrows in surprise, and is drawn wide in fear (AU 20)."""
BROW_GAP_SCALE_EYE_DISTANCES = 0.02
"""Eye distances by which the brows part in surprise."""

MAX_WINK_YAW_RADIANS = 0.45
"""Radians of yaw from rest, beyond which one eye is seen too obliquely to tell a wink."""

Shown = Literal["happy", "surprise", "anger", "fear", "sadness", "wink"]
"""What a face can show."""

Course = NDArray[np.float64]
"""A value for each frame, (N,)."""


@dataclass(frozen=True)
class Movements:
    """What a face does, frame by frame: 1 is clearly. Fields that `CLEAR_MOVEMENTS` does not name are in eye distances, `yaw` in
    radians; `like_surprise` is above 0 where raised brows and wide eyes are rather those of surprise than of fear."""

    corners_up: Course
    corners_down: Course
    mouth_wider: Course
    jaw_dropped: Course
    brows_raised: Course
    brows_lowered: Course
    brows_drawn: Course
    inner_brows: Course
    brows_oblique: Course
    eyes_wider: Course
    eyes_narrower: Course
    one_eye_shut: Course
    other_eye_shut: Course
    like_surprise: Course
    mouth_open: Course
    mouth_narrower: Course
    yaw: Course


def show(moved: NDArray[np.floating], rest: NDArray[np.floating]) -> dict[Shown, Course]:
    """How clearly each frame shows each of the emotions and the wink: 1 and more is clearly.

    Parameters
    ----------
    moved : (N, 12) the measures' differences from rest, without the tracker's single-frame jumps. rest : (12,).
    """
    done = movements(moved, rest)
    return {emotion: prototype(done) for emotion, prototype in PROTOTYPES.items()}


def movements(moved: NDArray[np.floating], rest: NDArray[np.floating]) -> Movements:
    """The movements that measures (N, 12), as differences from rest (12,), tell of."""
    of = dict(zip(MEASURES, np.asarray(moved, float).T, strict=True))
    corners = np.stack([of["right_corner_up"], of["left_corner_up"]])
    inner, outer, apart = of["inner_brows_up"], of["outer_brows_up"], of["brows_apart"]
    eyes = [MEASURES.index("right_eye_open"), MEASURES.index("left_eye_open")]
    lids = moved[:, eyes].T / np.maximum(rest[eyes], 0.1)[:, None]
    shut = np.sort(-lids, axis=0) / CLEAR_MOVEMENTS["eye_shut"]
    brow = (outer - 0.7 * inner) / OUTER_BROW_SCALE_EYE_DISTANCES
    return Movements(
        corners_up=corners.min(axis=0) / CLEAR_MOVEMENTS["corners_up"],
        corners_down=-corners.max(axis=0) / CLEAR_MOVEMENTS["corners_down"],
        mouth_wider=of["mouth_wide"] / CLEAR_MOVEMENTS["mouth_wider"],
        jaw_dropped=of["mouth_open"] / CLEAR_MOVEMENTS["jaw_dropped"],
        brows_raised=np.minimum(inner, outer) / CLEAR_MOVEMENTS["brows_raised"],
        brows_lowered=-(inner + outer) / 2 / CLEAR_MOVEMENTS["brows_lowered"],
        brows_drawn=-apart / CLEAR_MOVEMENTS["brows_drawn"],
        inner_brows=inner / CLEAR_MOVEMENTS["inner_brows"],
        brows_oblique=(inner - outer) / CLEAR_MOVEMENTS["brows_oblique"],
        # The tracker sees one eye wider than the other.
        eyes_wider=(lids.min(axis=0) + lids.mean(axis=0)) / 2 / CLEAR_MOVEMENTS["eyes_wider"],
        eyes_narrower=-lids.mean(axis=0) / CLEAR_MOVEMENTS["eyes_narrower"],
        one_eye_shut=shut[1],
        other_eye_shut=np.maximum(shut[0], 0),
        like_surprise=brow - of["mouth_wide"] / MOUTH_WIDTH_SCALE_EYE_DISTANCES + apart / BROW_GAP_SCALE_EYE_DISTANCES,
        mouth_open=of["mouth_open"],
        mouth_narrower=-of["mouth_wide"],
        yaw=of["yaw"],
    )


def happy(done: Movements) -> Course:
    """Both corners of the mouth go up and apart (AU 12); a mouth that gapes is no smile."""
    return _all(done.corners_up, done.mouth_wider, 1 + (GAPING_EYE_DISTANCES - done.mouth_open) / 0.1)


def surprise(done: Movements) -> Course:
    """The whole brows rise (AU 1 and 2), with wide eyes (AU 5), or less wide ones and a jaw that drops (AU 26)."""
    startled = np.maximum(done.eyes_wider, 0.6 * done.jaw_dropped + 0.6 * done.eyes_wider)
    return _unless(_all(done.brows_raised, startled, 1 + done.like_surprise), done.corners_up)


def anger(done: Movements) -> Course:
    """The brows are lowered and drawn together (AU 4): either may be faint where the other is strong."""
    frown = _all((done.brows_lowered + done.brows_drawn) / 1.5, done.brows_lowered / 0.45, done.brows_drawn / 0.25)
    return _unless(_unless(frown, done.corners_up), wink(done))


def fear(done: Movements) -> Course:
    """The inner brows rise (AU 1 and 4) over eyes that are wide open (AU 5), and not as in surprise."""
    return _unless(_all(done.inner_brows, done.eyes_wider / 1.2, 0.5 - done.like_surprise), done.corners_up)


def sadness(done: Movements) -> Course:
    """The brows become oblique (AU 1 and 4), the lids sink, the corners of the closed mouth go down (AU 15)."""
    oblique = _all(done.brows_oblique, done.inner_brows)
    both = (oblique + np.minimum(done.corners_down, 1.5)) / 1.3
    mouth = np.minimum(2 - done.mouth_open / PARTED_EYE_DISTANCES, 2 - done.mouth_narrower / MAX_POUT_EYE_DISTANCES)
    return _unless(_all(both, oblique, done.corners_down / 0.2, done.eyes_narrower, mouth), done.corners_up)


def wink(done: Movements) -> Course:
    """One eye shuts and the other does not (AU 46)."""
    return _all(done.one_eye_shut, 2 - 2.2 * done.other_eye_shut, 4 * (MAX_WINK_YAW_RADIANS - np.abs(done.yaw)))


PROTOTYPES: Mapping[Shown, Callable[[Movements], Course]] = {
    "happy": happy,
    "surprise": surprise,
    "anger": anger,
    "fear": fear,
    "sadness": sadness,
    "wink": wink,
}


def _all(*parts: Course) -> Course:
    """What all parts show; below 0 is nothing."""
    return np.maximum(np.min(parts, axis=0), 0.0)


def _unless(shown: Course, other: Course) -> Course:
    """Less by as much as something that speaks against it is clearly there."""
    return np.asarray(shown * np.clip(2 - 2 * other, 0, 1), float)
