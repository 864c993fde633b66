"""What views look through: all that is before a wall they see, and nothing behind it."""

import numpy as np
import pytest

from engine.geometry.camera import Camera
from engine.geometry.multiview.free_space import SeenSurfaces, seen_depths

AWAY = 2.0
LENS = Camera((0, 0, AWAY), 200.0, (49.5, 49.5), (100, 100))


def wall(facing: float) -> tuple[np.ndarray, np.ndarray]:
    """Points of a wall at z = 0, a centimetre apart, with normals towards the camera or away from it."""
    across, up = np.meshgrid(np.arange(-0.3, 0.3, 0.01), np.arange(-0.3, 0.3, 0.01))
    points = np.stack([across.ravel(), up.ravel(), np.zeros(across.size)], 1)
    return points, np.tile([0, 0, facing], (len(points), 1))


def test_a_wall_of_points_has_no_holes_and_is_as_far_as_it_is() -> None:
    depths = seen_depths(*wall(1.0), LENS, 0.012)
    inner = depths[30:70, 30:70]
    assert inner == pytest.approx(AWAY, abs=1e-5)
    assert np.isinf(depths[0, 0]), "nothing is known beside it"


def test_who_turns_away_hides_nothing() -> None:
    assert np.isinf(seen_depths(*wall(-1.0), LENS, 0.012)).all()


def test_the_nearer_of_two_walls_is_seen() -> None:
    points, normals = wall(1.0)
    nearer = points + np.array([0, 0, 0.5])
    both = np.concatenate([points, nearer]), np.concatenate([normals, normals])
    assert seen_depths(*both, LENS, 0.012)[50, 50] == pytest.approx(AWAY - 0.5, abs=1e-5)


def test_places_before_what_is_seen_are_free_and_places_behind_are_unknown() -> None:
    seen = SeenSurfaces([LENS], [seen_depths(*wall(1.0), LENS, 0.012)])
    places = np.array([[0, 0, 0.1], [0, 0, 0.002], [0, 0, -0.1], [0.9, 0, 0.1]])
    assert seen.votes(places, 0.006).tolist() == [[1, 0], [0, 1], [0, 0], [0, 0]]
