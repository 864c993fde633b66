"""Distances on shapes where they are known."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from benchmarks.scan_studio.comparison.distance import (
    MAX_EDGE_METRES,
    MeasuredSurface,
    above,
    below,
    between_surfaces,
    measured_surface,
    of_cloud,
)


def ball(radius: float, divisions: int = 4) -> tuple[np.ndarray, np.ndarray]:
    made = trimesh.creation.icosphere(divisions)
    return np.asarray(made.vertices) * radius, np.asarray(made.faces)


@pytest.fixture(scope="module")
def truth() -> MeasuredSurface:
    """A ball of half a metre."""
    return measured_surface(*ball(0.5))


def test_balls_one_in_the_other_are_as_far_apart_as_their_radii(truth: MeasuredSurface) -> None:
    distances = between_surfaces(truth, measured_surface(*ball(0.51)))
    for value in (distances.mean, distances.to_truth, distances.from_truth, distances.p90, distances.h95):
        assert value == pytest.approx(0.01, abs=3e-4)
    assert distances.largest == pytest.approx(0.01, abs=1.5e-3)  # facets lie within the ball


def test_a_surface_lies_on_itself(truth: MeasuredSurface) -> None:
    assert between_surfaces(truth, truth).largest < 1e-9


def test_large_triangles_are_measured_exactly() -> None:
    """A cube of twelve triangles: the vertices say nothing of how far its faces are."""
    cube = trimesh.creation.box((1, 1, 1))
    surface = measured_surface(cube.vertices, cube.faces)
    edges = surface.vertices[surface.triangles] - surface.vertices[np.roll(surface.triangles, 1, 1)]
    assert np.linalg.norm(edges, axis=-1).max() <= MAX_EDGE_METRES + 1e-9
    points = np.random.default_rng(0).uniform(-0.45, 0.45, (500, 3))
    points[:, 2] = 0.53
    np.testing.assert_allclose(surface.distance(points), 0.03, atol=1e-9)


def test_what_is_missing_counts_from_the_truth_alone(truth: MeasuredSurface) -> None:
    upper = truth.samples[truth.samples[:, 1] > 0]
    distances = of_cloud(upper, truth)
    assert distances.to_truth < 1e-9
    assert distances.from_truth > 0.1
    assert distances.largest == pytest.approx(0.5 * np.sqrt(2), abs=0.02)  # from the lower pole to the equator
    assert of_cloud(upper, truth, above(0.05)).from_truth < 1e-9


def test_regions_divide_a_body(truth: MeasuredSurface) -> None:
    points = truth.samples + np.where(truth.samples[:, 1:2] > 0.2, [0, 0, 0], [0, -0.02, 0])
    assert of_cloud(points, truth, above(0.21)).to_truth < 1e-9
    assert of_cloud(points, truth, below(0.1)).to_truth > 0.005


def test_linings_do_not_count_as_truth(truth: MeasuredSurface) -> None:
    outer, inner = ball(0.5), ball(0.3)
    both = np.concatenate([outer[0], inner[0]]), np.concatenate([outer[1], inner[1] + len(outer[0])])
    assert between_surfaces(truth, measured_surface(*both)).largest < 2e-3


def test_a_region_without_anything_is_refused(truth: MeasuredSurface) -> None:
    with pytest.raises(ValueError, match="nothing in this region"):
        of_cloud(truth.samples, truth, above(1.0))
