"""Points between a face's vertices, on the smooth surface through them."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed

from engine.face_animation.warping.round_cheeks import points_between
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, LIPS_OUTER, RIGHT_EYE, eye_distance

FACE = placed(90, (300, 300)).astype(np.float64)
ALL = np.arange(len(FACE))


def test_what_moves_affinely_does_so_everywhere() -> None:
    points, weights = points_between(FACE, ALL)
    assert len(points) > 300
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    turn = np.array([[0.9, -0.2], [0.3, 1.1]])
    np.testing.assert_allclose(weights @ (FACE[:, :2] @ turn + (5, -7)), points @ turn + (5, -7), atol=1e-8)


def test_a_round_surface_is_met_better_than_by_flat_triangles() -> None:
    """An ellipsoid's depth: off by less than half of what the middle of each edge is."""
    points, weights = points_between(FACE, ALL)
    middle, half = FACE[:, :2].mean(axis=0), 1.6 * np.ptp(FACE[:, :2], axis=0) / 2

    def depth(places: np.ndarray) -> np.ndarray:
        return 200 * np.sqrt(np.clip(1 - (((places - middle) / half) ** 2).sum(axis=1), 0, 1))

    flat = np.array([(depth(FACE[:, :2][[a, b]]).mean()) - depth(points[None, k])[0] for k, (a, b) in _edges(weights)])
    round_ = (weights @ depth(FACE[:, :2]) - depth(points))[[k for k, _ in _edges(weights)]]
    assert np.abs(round_).mean() < 0.5 * np.abs(flat).mean()


def _edges(weights) -> list[tuple[int, tuple[int, int]]]:  # type: ignore[no-untyped-def]
    """Of the points in the middle of an edge between two vertices: their number, and these, which have the largest weights."""
    dense = weights.toarray()
    ends = np.sort(np.argsort(dense, axis=1)[:, -2:], axis=1)
    points, _ = points_between(FACE, ALL)
    middle = FACE[ends, :2].mean(axis=1)
    return [(k, (int(a), int(b))) for k, (a, b) in enumerate(ends) if np.allclose(middle[k], points[k], atol=1e-6)]


def test_lids_and_lips_stay_as_they_are() -> None:
    """No point lies between two of their vertices, whose folds are no round surface."""
    points, _ = points_between(FACE, ALL)
    unit = float(eye_distance(FACE[:, :2]))
    for contour in (RIGHT_EYE, LEFT_EYE, LIPS_OUTER, LIPS_INNER):
        ring = FACE[list(contour), :2]
        middles = (ring + np.roll(ring, -1, axis=0)) / 2
        assert np.linalg.norm(points[:, None] - middles, axis=2).min() > 1e-3 * unit


@pytest.mark.parametrize("gone", [(), (10, 338, 297, 234)])
def test_points_lie_within_the_band_and_follow_usable_vertices_alone(gone: tuple[int, ...]) -> None:
    usable = np.setdiff1d(ALL, gone)
    points, weights = points_between(FACE, usable)
    assert weights.shape == (len(points), len(usable))
    nose = FACE[4, :2]
    assert np.linalg.norm(points - nose, axis=1).min() > 0.2 * float(eye_distance(FACE[:, :2]))
