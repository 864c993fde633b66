"""How far within silhouettes places are: of a ball, as far as from its surface."""

import numpy as np
import pytest

from engine.geometry.camera import Camera
from engine.geometry.multiview.silhouette_depth import Beside, silhouette_depths

RADIUS, AWAY = 0.2, 3.0
PIXEL = 1.2 * AWAY / 400
"""Metres: a pixel at that distance, and a little."""


def ring(count: int) -> list[Camera]:
    lens = Camera((0, 0, 0), 400.0, (99.5, 99.5), (200, 200))
    turns = np.arange(count) * 2 * np.pi / count
    return [lens.aimed((AWAY * np.sin(turn), 0, AWAY * np.cos(turn)), (0, 0, 0)) for turn in turns]


def balls(count: int) -> list[np.ndarray]:
    """What each camera of a ring sees of a ball at the origin."""
    rows, columns = np.mgrid[:200, :200] - 99.5
    seen = 400.0 * RADIUS / np.sqrt(AWAY**2 - RADIUS**2)
    return [np.hypot(rows, columns) < seen] * count


def test_depths_are_distances_to_the_silhouettes_rims() -> None:
    points = np.array([[0, 0, 0], [0, 0.15, 0], [0, 0.25, 0]])
    found, seen = silhouette_depths(points, balls(12), ring(12), 0.0)
    assert found == pytest.approx([0.2, 0.05, -0.05], abs=PIXEL)
    assert (seen == 12).all()


def test_a_share_of_wrong_silhouettes_is_passed_over() -> None:
    masks = balls(12)
    masks[0] = masks[7] = np.zeros((200, 200), np.bool_)
    strict, loose = (silhouette_depths(np.zeros((1, 3)), masks, ring(12), wrong)[0][0] for wrong in (0.1, 0.2))
    assert strict < 0 and loose == pytest.approx(0.2, abs=PIXEL)


def test_who_is_in_no_picture_is_outside_of_none() -> None:
    found, seen = silhouette_depths(np.array([[0, 9.0, 0]]), balls(4), ring(4), 0.0)
    assert np.isinf(found[0]) and seen[0] == 0


def test_views_say_nothing_of_what_is_behind_or_hardly_beside_what_is_known() -> None:
    known = [np.hypot(*(np.mgrid[:200, :200] - 99.5)) < 15] * 8  # 11 cm about the middle
    points = np.array([[0, 0.05, 0], [0, 0.13, 0], [0, 0.16, 0]])
    found, seen = silhouette_depths(points, balls(8), ring(8), 0.0, Beside(known, 0.03))
    assert seen.tolist() == [0, 0, 8] and found[2] == pytest.approx(0.04, abs=PIXEL)
