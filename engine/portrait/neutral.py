"""The driver's neutral frame s*: closed mouth, open eyes, calm brows, frontal, near the calm frames' mean (section 4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.perception.landmarks import RIGID, eye_opening, fiducials, mouth_opening
from engine.portrait.driver import DriverTrack
from engine.portrait.expression import EXPRESSION, expression, lopsided
from engine.portrait.head_motion import fit_rigid, turns

MOUTH, SHUT, CORNERS, WIDE, TORN, UPPER, EYES, TURN, MEAN = 4.0, 2.0, 10.0, 4.0, 20.0, 10.0, 2.0, 1.5, 3.0
"""What counts how much: a mouth that is further open, or less open, than the target's, how far its corners lie higher or
lower, by how much it is wider and by how much it is torn to another side (eye distances), brows and lids that no calm face shows, closing of the eyes, radians of
turn, and distance from the mean. A mouth that stays a little open does less harm than one that is pressed together,
because the frame with the right opening smiles and the target does not."""

USUAL = 0.05
"""Eye distances by which mouths differ between people who do nothing."""

CALM = {"inner_brows_up": (0.28, 0.31, 0.41), "eyes_open": (0.18, 0.24, 0.40)}
"""Where people who do nothing have the brows' inner ends and the lids: most of two dozen from the second value to the third,
and a driver down to the first that has them there most of the time. They differ by as much as an expression moves them: a
target's alone do not tell what it shows, and are taken to be at rest."""

CALMEST = 0.2
"""Share of a driver's frames that stand for its face at rest: over a whole clip it may be surprised most of the time."""


def choose_neutral_frame(track: DriverTrack, target: NDArray[np.floating], chosen: int | None) -> int:
    """The frame of the driver that shows what the target shows.

    For a neutral target that is the driver's neutral frame. For one that smiles or is turned it is the frame
    whose expression is nearest, because equation 1 carries differences against it.

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
        return chosen
    cost = neutral_cost(track.meshes, target)
    return int(np.argmin(np.where(track.found, cost, np.inf)))


def neutral_cost(meshes: NDArray[np.float32], target: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) how far each frame's mesh (478, 3) is from showing the target's expression, 0 is a match."""
    rigid = list(RIGID)
    middle = meshes[len(meshes) // 2].astype(float)
    scale, rotation, shift = fit_rigid(middle[rigid], meshes[:, rigid], np.ones(len(rigid)))
    inner = fiducials(meshes)[:, 17:]
    at_rest = np.einsum("nji,nvj->nvi", rotation, inner - shift[:, None]) / scale[:, None, None]
    unit = float(np.linalg.norm(middle[33] - middle[263]))
    angle = turns(meshes, target)
    opening = mouth_opening(meshes) - float(mouth_opening(target))
    mouth = np.maximum(MOUTH * opening, -SHUT * opening)
    corners, wide = (EXPRESSION.index(name) for name in ("corners_up", "mouth_wide"))
    shown, wanted = expression(meshes), expression(np.asarray(target)[None])[0]
    smile = np.maximum(np.abs(shown[:, corners] - wanted[corners]) - USUAL, 0)
    at_most = max(float(wanted[wide]), float(np.quantile(shown[:, wide], 0.2)))
    grin = np.maximum(shown[:, wide] - at_most - USUAL, 0)
    torn = np.linalg.norm(lopsided(meshes) - lopsided(np.asarray(target)[None]), axis=-1).mean(axis=-1)
    torn = np.maximum(torn - USUAL, 0)
    upper = sum(_outside(shown[:, k], wanted[k], *CALM[name]) for k, name in enumerate(EXPRESSION) if name in CALM)
    cost = mouth + CORNERS * smile + WIDE * grin + TORN * torn + UPPER * upper + TURN * angle
    calm = cost <= np.quantile(cost, CALMEST)
    eyes = eye_opening(meshes)
    closing = np.clip(1 - eyes / np.maximum(np.median(eyes[calm], axis=0), 1e-3), 0, 1).max(axis=1)
    far = np.linalg.norm(at_rest - np.median(at_rest[calm], axis=0), axis=-1).mean(axis=-1) / unit
    return np.asarray(cost + EYES * closing + MEAN * far, float)


def _outside(shown: NDArray[np.floating], wanted: float, least: float, low: float, high: float) -> NDArray[np.floating]:
    """(N,) how far values (N,) lie outside of a range that is widened to what is wanted, and towards what is usual."""
    low = min(low, wanted, max(float(np.median(shown)), least))
    return np.maximum(np.maximum(low - shown, shown - max(high, wanted)), 0)
