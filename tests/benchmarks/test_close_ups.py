"""Which moments close-ups show, and how far irises part."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed, shut

from benchmarks.portrait_figures.close_ups import irises_apart, moments
from engine.perception.face.landmarks import LEFT_IRIS, RIGHT_IRIS


def test_shown_are_six_frames_with_eyes_shut_and_the_mouth_wide_among_them() -> None:
    face = placed(120, (180, 140))
    faces = np.stack([face] * 12)
    faces[3], faces[7], faces[8] = shut(face, 0.1), opened(face, 0.5), opened(face, 0.25)
    shown = moments(faces)
    assert len(set(shown)) == 6 and shown == sorted(shown)
    assert {3, 7, 8} <= set(shown)


def test_irises_part_by_what_they_are_further_apart_than_at_rest() -> None:
    rest = shut(placed(120, (180, 140)), 1.6)
    width = np.linalg.norm(rest[33, :2] - rest[133, :2])
    together, apart = rest.copy(), rest.copy()
    together[[*RIGHT_IRIS, *LEFT_IRIS], 0] += 4
    apart[list(RIGHT_IRIS), 0] -= 6
    apart[list(LEFT_IRIS), 0] += 6
    assert irises_apart(together[None], rest)[0] == pytest.approx(0, abs=0.02)
    assert irises_apart(apart[None], rest)[0] == pytest.approx(12 / width, abs=0.03)
