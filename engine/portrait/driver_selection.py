"""`auto`: which of several drivers fits a target best, and why."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.face_animation.target_face import TargetFace
from engine.kind import Candidates
from engine.package_data import package_data
from engine.performances import names
from engine.performances.catalogue import VIDEO_FOLDER
from engine.portrait.appearance import Appearance, appearance_of_driver, appearance_of_face
from engine.run import Run

CRITERION_WEIGHTS: Mapping[str, float] = {
    "expression": 0.35,
    "proportions": 0.25,
    "light": 0.15,
    "palette": 0.15,
    "turn": 0.10,
}
"""What counts how much. The expression first: what of it the driver never shows, stays on the face all the time."""

PROPORTIONS_SCALE = 0.05
"""Difference of proportions that brings a score down to 0.6, root mean square in eye distances."""
LIGHT_SCALE = 0.4
"""Difference of light that brings a score down to 0.6, slope of the logarithm of luminance."""
PALETTE_SCALE = 20.0
"""Colour difference that brings a score down to 0.6."""
SCORE_TURN_SCALE_DEGREES = 10.0
"""Degrees of turn beyond `MAX_DRIVER_TURN_DEGREES` that bring a score down to 0.6."""

LIGHTNESS_WEIGHT = 0.5
"""How much a difference in lightness counts against one in hue: exposure says little about a palette."""

MAX_DRIVER_TURN_DEGREES = 25.0
"""Degrees that a head can turn with the target's own turn included; see the limits in the documentation."""

EXPRESSION_SPREAD = np.array([0.03, 0.08, 0.02, 0.06, 0.05, 0.06])
"""By how much the measures of `engine.perception.expression.features.EXPRESSION_FEATURES` differ between people who do nothing: no difference
up to here counts (from the pictures and clips that the project is tried with)."""

TIE_MARGIN = 0.01
"""Scores that differ by less are a draw, which goes to the candidate that is named first."""


@dataclass(frozen=True)
class SelectedDriver:
    """The driver taken: its `name` and file; `scores` of every candidate, in all that counts and in `total`, each in
    [0, 1], 1 is a perfect fit."""

    name: str
    path: Path
    scores: Mapping[str, Mapping[str, float]]


def choose_driver(target: TargetFace, candidates: Candidates, run: Run) -> SelectedDriver:
    """Compare each candidate with the target and take the best.

    What a built-in performance looks like ships with it; other videos are looked at once and remembered by content.
    One that cannot be used is passed over with a warning (`driver_passed_over`).

    Raises
    ------
    InputError : `no_driver_fits`, there is none that can be used.
    """
    with run.timed("choose_driver"):
        face = appearance_of_face(target.rgb, target.mesh)
    scores: dict[str, dict[str, float]] = {}
    for name, path in candidates.files.items():
        try:
            appearance = known_appearance(path) or run.stage(
                "driver_looks", appearance_of_driver, path, run.limits, run.tick, shared=True
            )
        except InputError as error:
            run.warn("driver_passed_over", f"The driver “{name}” cannot be used: {error.detail}")
        else:
            scores[name] = score_driver(face, appearance)
    if not scores:
        raise InputError("no_driver_fits", "None of the drivers can be used: name a video or another performance.")
    best = max(score["total"] for score in scores.values())
    name = next(name for name, score in scores.items() if score["total"] > best - TIE_MARGIN)
    return SelectedDriver(name, candidates.files[name], scores)


def score_driver(target: Appearance, driver: Appearance) -> dict[str, float]:
    """How well a driver fits a target: a score for each of `CRITERION_WEIGHTS`, and their weighted mean as `total`."""
    apart = np.sqrt(((target.proportions - driver.proportions) ** 2).sum(axis=1).mean())
    colour = (target.palette - driver.palette) * (LIGHTNESS_WEIGHT, 1, 1)
    scores = {
        "expression": _bell(float(np.sqrt(missing_expression(target, driver).min()))),
        "proportions": _bell(float(apart) / PROPORTIONS_SCALE),
        "light": _bell(float(np.linalg.norm(target.light - driver.light)) / LIGHT_SCALE),
        "palette": _bell(float(np.linalg.norm(colour)) / PALETTE_SCALE),
        "turn": _bell(max(target.turn + driver.turn - MAX_DRIVER_TURN_DEGREES, 0.0) / SCORE_TURN_SCALE_DEGREES),
    }
    total = sum(CRITERION_WEIGHTS[name] * score for name, score in scores.items())
    return {name: round(value, 4) for name, value in {**scores, "total": total}.items()}


def missing_expression(target: Appearance, driver: Appearance) -> NDArray[np.float64]:
    """(F,) how far each frame of the driver is from showing the target's expression; 0 where nothing beyond what
    people differ by is missing."""
    beyond = np.abs(driver.expressions.astype(float) - target.expressions[0]) / EXPRESSION_SPREAD - 1
    return np.asarray((np.maximum(beyond, 0) ** 2).sum(axis=1), float)


def known_appearance(path: Path) -> Appearance | None:
    """The appearance of a built-in performance; None for any other file."""
    if path.parent != VIDEO_FOLDER or path.stem not in names():
        return None
    return library_appearances().get(path.stem)


@cache
def library_appearances() -> Mapping[str, Appearance]:
    """The appearances of all built-in performances, as `python -m engine.portrait.library_appearances` wrote them down."""
    document = json.loads(package_data("engine.performances", "videos/appearances.json").read_text())
    figure = {name: np.array(document["figure"][name], np.float32) for name in ("proportions", "light", "palette")}
    return {
        name: Appearance(**figure, expressions=np.array(one["expressions"], np.float32), turn=one["turn"])
        for name, one in document["performances"].items()
    }


def _bell(x: float) -> float:
    return float(np.exp(-0.5 * x * x))
