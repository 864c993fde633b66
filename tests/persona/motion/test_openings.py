"""Lids and lips that meet: which of two sides goes to meet the other."""

from __future__ import annotations

import numpy as np

from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, RIGHT_EYE
from engine.persona.motion.contact import corrected


def middle_of(contour: tuple[int, ...]) -> tuple[int, int]:
    """The upper and the lower vertex in the middle of an opening."""
    return contour[len(contour) // 4], contour[-(len(contour) // 4)]


def test_lids_shut_from_above_and_lips_from_below() -> None:
    """A driver who shuts both openings, and a puppet that has not moved yet."""
    rest = frontalise(canonical_face()[None].astype(np.float64))[0]
    lips, *eyes = (middle_of(contour) for contour in (LIPS_INNER, RIGHT_EYE, LEFT_EYE))
    opened = rest.copy()
    opened[[LIPS_INNER[-place] for place in range(1, len(LIPS_INNER) // 2)], 1] += (
        0.2  # a mouth that stands open at rest
    )
    shutting = np.zeros_like(opened)
    for contour in (LIPS_INNER, RIGHT_EYE, LEFT_EYE):
        for place in range(1, len(contour) // 2):
            upper, lower = contour[place], contour[-place]
            shutting[upper] = (opened[lower] - opened[upper]) / 2
            shutting[lower] = -shutting[upper]
    found = corrected(np.zeros_like(opened), np.ones(len(opened)), shutting, opened, opened)
    shut = opened + found
    for upper, lower in (lips, *eyes):
        gap = np.linalg.norm(opened[lower] - opened[upper])
        assert np.linalg.norm(shut[lower] - shut[upper]) < 0.1 * gap
    for upper, lower in eyes:
        assert np.linalg.norm(found[upper]) > 1.3 * np.linalg.norm(found[lower])
    assert np.linalg.norm(found[lips[1]]) > 1.3 * np.linalg.norm(found[lips[0]])
