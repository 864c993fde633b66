"""Sheets through scattered points: where the points are, on the mean, and going on as they do."""

import numpy as np
import pytest

from engine.geometry.point_clouds.point_sheet import sheet_through


def disc(count: int, scatter: float) -> np.ndarray:
    """Points about a disc of radius 0.1 across the y axis."""
    random = np.random.default_rng(3)
    angle, radius = random.uniform(0, 2 * np.pi, count), 0.1 * np.sqrt(random.uniform(0, 1, count))
    return np.stack([radius * np.cos(angle), random.normal(0, scatter, count), radius * np.sin(angle)], 1)


def test_points_that_scatter_to_both_sides_become_one_thin_sheet() -> None:
    sheet = sheet_through(disc(4000, 0.004), 0.025, 4, 0.003)
    inner = np.linalg.norm(sheet.points[:, [0, 2]], axis=1) < 0.085
    assert np.abs(sheet.points[inner, 1]).max() < 0.0025
    assert np.abs(sheet.normals[inner, 1]).min() > 0.97


def test_distances_are_those_of_the_plane_and_of_its_border() -> None:
    sheet = sheet_through(disc(4000, 0.0), 0.02, 1, 0.002)
    across, along = sheet.distances(np.array([[0, 0.01, 0], [0.05, -0.004, 0], [0.115, 0.006, 0.0]]))
    assert across == pytest.approx([0.01, 0.004, 0.006], abs=1e-6)
    assert along[:2].max() < 0.003 and along[2] == pytest.approx(0.015, abs=0.003)


def test_lone_points_make_no_sheet() -> None:
    assert not len(sheet_through(np.eye(3), 0.02, 2, 0.003).points)
    far = np.concatenate([disc(3000, 0.001), [[0.5, 0.5, 0.5]]])
    assert np.linalg.norm(sheet_through(far, 0.02, 2, 0.003).points, axis=1).max() < 0.12
