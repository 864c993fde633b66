"""The driver's neutral frame s*: closed mouth, open eyes, calm brows, frontal, near the calm frames' mean (section 4).

First the driver's own face at rest is found, from the driver alone; then the frame nearest to it. Only where the target
itself wears an expression is the frame nearest to that looked for, because equation 1 carries differences against it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from engine.errors import InputError
from engine.face_animation.eyes.gaze import iris_positions
from engine.face_animation.motion_transfer.head_motion import turn_angles
from engine.perception.expression.features import lip_asymmetry
from engine.perception.expression.measures import (
    FACE_MEASURES,
    LID_MEASURES,
    MEASURES,
    MOUTH_MEASURES,
    REST_SPREAD,
    SPREAD_BELOW_REST,
    SPREAD_BETWEEN_PEOPLE,
    general_rest,
    lid_lowering,
    measure,
)
from engine.perception.face_track.track import FaceTrack

LOWERED_LIDS_WEIGHT = 4.0
"""How much lowered lids count, as a share of how far they are usually open."""

SIMILAR_REST_DISTANCE = 0.5
"""Frames that differ by less, root mean square in `REST_SPREAD`, from the one that is most at rest are as much so: their median
is the rest."""

MAX_COMPARED_FRAMES = 2000
"""Frames that are compared with one another: of longer videos as many, evenly spread."""

COMPARED_AT_ONCE = 128
"""Frames whose distances from all others are in memory together."""

NEUTRAL_TOLERANCE = 0.5
"""By how much more than the least a frame may differ from what is looked for and still be as good, mean square in
`REST_SPREAD`. The head's turn and the gaze choose among such frames."""

TURN_SCALE_RADIANS = 0.2
"""Radians by which the head is turned elsewhere than the target's that count as much as one `REST_SPREAD` of a measure."""
GAZE_SCALE = 0.1
"""Eye widths by which the eyes look elsewhere than the target's that count as much as one `REST_SPREAD` of a measure."""

TORN_MOUTH_SCALE = 0.05
"""Eye distances by which a mouth is torn aside that count as much as one `REST_SPREAD` of a measure."""

MIN_TORN_MOUTH = 0.15
"""Eye distances by which a target's mouth is torn aside, at least: under it, faces that are turned or painted seem so,
too."""

MIN_WORN_EXPRESSION = 0.5
"""Standard deviations of `SPREAD_BETWEEN_PEOPLE`, past the first, from which on a target wears an expression."""

MAX_CALM_DIFFERENCE = 2.0
"""Mean square by which a calm face differs from a face at rest, at most, in standard deviations of
`SPREAD_BETWEEN_PEOPLE`."""

Reason = Literal["chosen", "at_rest", "like_the_target", "nearest_to_rest"]


@dataclass(frozen=True)
class NeutralFrame:
    """A frame of the driver and why it was taken. It was `chosen` by the user, or is `at_rest` as the target is. It is
    `like_the_target` where it shares the target's expression, and `nearest_to_rest` where a driver never rests."""

    frame: int
    reason: Reason


def choose_neutral_frame(track: FaceTrack, target: NDArray[np.floating], chosen: int | None) -> NeutralFrame:
    """The frame of the driver that shows what the target shows: rest, or the expression that the target wears.

    Parameters
    ----------
    target : (478, 3) the target's mesh. chosen : the user's own choice, a frame of the track.

    Raises `InputError` `neutral_frame_out_of_range`.
    """
    if chosen is not None:
        if chosen >= len(track):
            raise InputError(
                "neutral_frame_out_of_range",
                f"neutral_frame counts the driver's frames that are used, from 0: after trim, at {track.fps:g} a second, there "
                f"are {len(track)}.",
                ("neutral_frame",),
            )
        return NeutralFrame(chosen, "chosen")
    values = measure(track.meshes)
    rest = estimate_rest(values[track.found])
    worn = expression_beyond_rest(target)
    face = (
        _face_unlike(values, rest + worn)
        + _torn(track, target, values, rest)
        + LOWERED_LIDS_WEIGHT * lid_lowering(values, rest[LID_MEASURES])
    )
    face = np.where(track.found, face, np.inf)
    place = (turn_angles(track.meshes, target) / TURN_SCALE_RADIANS) ** 2 + _gaze_unlike(track.meshes, target)
    frame = int(np.argmin(np.where(face <= face.min() + NEUTRAL_TOLERANCE, len(MEASURES) * face + place, np.inf)))
    taken = values[[frame]]
    if _face_unlike(taken, rest + worn)[0] < _face_unlike(taken, rest)[0]:
        return NeutralFrame(frame, "like_the_target")
    return NeutralFrame(frame, "at_rest" if distance_from_rest(taken)[0] <= MAX_CALM_DIFFERENCE else "nearest_to_rest")


def warn_if_never_at_rest(choice: NeutralFrame, warn: Callable[[str, str], None]) -> None:
    """Warn (`driver_never_at_rest`) where the driver shows a face at rest in none of its frames."""
    if choice.reason == "nearest_to_rest":
        warn(
            "driver_never_at_rest",
            f"The driver's face is at rest in none of its frames, so that frame {choice.frame} stands for it: let the "
            "performance begin with a calm face and closed lips, or choose neutral_frame by hand.",
        )


def estimate_rest(values: NDArray[np.floating]) -> NDArray[np.float64]:
    """The measures (12,) of this person at rest, from those of all frames (N, 12) that show the face.

    The most probable frame: one that many are like and that is not unlike a face at rest. People at rest are
    distributed about the general rest by `SPREAD_BETWEEN_PEOPLE`, and one person at rest about their own by
    `REST_SPREAD`. Many alone would not do, for a driver may laugh through most of a clip; likeness alone would not, for
    people differ.

    It is a face that anybody would call calm, in however few frames this one is, for what the driver shows there stands for
    the target, who is taken to be at rest. `driver_segments.rest.own_rest` looks for a habit instead, which may be a smile.
    """
    seen = values[np.unique(np.linspace(0, len(values) - 1, min(MAX_COMPARED_FRAMES, len(values))).astype(int))].astype(
        float
    )
    blinking = lid_lowering(seen, np.quantile(seen[:, LID_MEASURES], 0.7, axis=0))
    cost = distance_from_rest(seen) - np.log(_density(seen)) + LOWERED_LIDS_WEIGHT * blinking
    alike = _mean_squares(seen[[int(np.argmin(cost))]], seen)[0] < SIMILAR_REST_DISTANCE**2
    return np.asarray(np.median(seen[alike & (cost <= np.quantile(cost[alike], 0.5))], axis=0), float)


def _density(seen: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N,) how many of the measures (N, 12) are like each: of a Gaussian of `REST_SPREAD` about it, in the mean. The distances of
    all from all would take what a long clip's meshes do, several times."""
    parts = np.array_split(seen, -(-len(seen) // COMPARED_AT_ONCE))
    return np.concatenate([np.exp(-_mean_squares(some, seen) / 2).mean(axis=1) for some in parts])


def _mean_squares(some: NDArray[np.float64], seen: NDArray[np.float64]) -> NDArray[np.float64]:
    """(M, N) mean square difference of measures (M, 12) from others (N, 12), in `REST_SPREAD`."""
    return np.asarray(cdist(some / REST_SPREAD, seen / REST_SPREAD, "sqeuclidean") / len(MEASURES), float)


def distance_from_rest(values: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) how unlike a face at rest faces with these measures (N, 12) are, whoever they are: the mean square of the
    differences, 1 is what people at rest differ by."""
    apart = values - general_rest()
    return np.asarray(
        np.mean((apart / np.where(apart < 0, SPREAD_BELOW_REST, SPREAD_BETWEEN_PEOPLE))[:, FACE_MEASURES] ** 2, axis=1),
        float,
    )


def expression_beyond_rest(target: NDArray[np.floating]) -> NDArray[np.float64]:
    """By how much the target's measures (12,) are beyond what people at rest differ by: of a mouth that is open or smiles.
    Brows and lids differ between people by as much as an expression moves them, and narrow mouths are a matter of style: of
    these a target tells nothing, and is taken to be at rest."""
    shown = (measure(np.asarray(target)[None])[0] - general_rest()) / SPREAD_BETWEEN_PEOPLE
    worn = np.zeros(len(MEASURES))
    worn[MOUTH_MEASURES] = np.maximum(shown[MOUTH_MEASURES] - 1, 0)
    return np.asarray(np.where(worn > MIN_WORN_EXPRESSION, worn, 0) * SPREAD_BETWEEN_PEOPLE, float)


def _face_unlike(values: NDArray[np.floating], wanted: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) mean square difference of measures (N, 12) from those `wanted` (12,), in `REST_SPREAD`, the head's turn left out."""
    return np.asarray((((values - wanted) / REST_SPREAD)[:, FACE_MEASURES] ** 2).mean(axis=1), float)


def _torn(
    track: FaceTrack, target: NDArray[np.floating], values: NDArray[np.floating], rest: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(N,) square of how far each frame's mouth is torn aside, in `TORN_MOUTH_SCALE`. It is measured from where the
    mouth is at rest, which is even but for as much, or from the target's where that is torn."""
    torn = lip_asymmetry(track.meshes)
    nearest = np.argsort(np.where(track.found, _face_unlike(values, rest), np.inf))[:5]
    wanted = np.median(torn[nearest], axis=0)
    wanted *= min(1, TORN_MOUTH_SCALE / max(float(np.linalg.norm(wanted, axis=-1).mean()), 1e-6))
    shown = lip_asymmetry(np.asarray(target)[None])[0]
    if np.linalg.norm(shown, axis=-1).mean() > MIN_TORN_MOUTH:
        wanted = shown
    return np.asarray((np.linalg.norm(torn - wanted, axis=-1).mean(axis=-1) / TORN_MOUTH_SCALE) ** 2, float)


def _gaze_unlike(meshes: NDArray[np.floating], target: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) square of how far each frame's eyes look elsewhere than the target's, in `GAZE_SCALE`."""
    aside = np.linalg.norm(iris_positions(meshes) - iris_positions(np.asarray(target)[None]), axis=-1).mean(axis=-1)
    return np.asarray((aside / GAZE_SCALE) ** 2, float)
