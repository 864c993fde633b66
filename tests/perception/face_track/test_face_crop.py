"""Faces between two looks."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import in_crop, opened, painted, placed, smiling
from numpy.typing import NDArray

from engine.perception.face_track.face_crop import CROP_SHAPE, FaceCrop, crop_face, crop_place, interpolate_crops

REST = placed(60, (150, 120))
OTHER = opened(smiling(placed(72, (190, 140), roll=12)), 0.35)
INSIDE = (slice(60, 250), slice(70, 220))
"""Where a face fills the crop."""


def look(mesh: NDArray[np.float32]) -> FaceCrop:
    return FaceCrop(mesh, crop_place(mesh), painted(in_crop(mesh), CROP_SHAPE[::-1]))


def test_a_face_is_cut_out_upright_by_its_eyes() -> None:
    """From a picture that holds it enlarged and rolled."""
    seen = crop_face(painted(OTHER, (400, 360)), OTHER)
    np.testing.assert_allclose(seen.in_crop(), in_crop(OTHER)[:, :2], atol=1e-3)
    apart = np.abs(seen.crop[INSIDE].astype(int) - look(OTHER).crop[INSIDE])
    assert apart.mean() < 4


@pytest.mark.parametrize(("share", "whose"), [(0.0, REST), (1.0, OTHER)])
def test_at_either_end_it_is_the_one_or_the_other(share: float, whose: NDArray[np.float32]) -> None:
    seen = interpolate_crops(look(REST), look(OTHER), share)
    np.testing.assert_allclose(seen.mesh, whose, atol=1e-3)
    assert np.abs(seen.crop.astype(int) - look(whose).crop)[INSIDE].mean() < 1.5


@pytest.mark.parametrize("share", [0.25, 0.5, 0.8])
def test_on_the_way_features_lie_where_the_mesh_between_has_them(share: float) -> None:
    """Two drawings of one face make a third one of it, no double exposure."""
    seen = interpolate_crops(look(REST), look(OTHER), share)
    np.testing.assert_allclose(seen.mesh, (1 - share) * REST + share * OTHER, atol=1e-3)
    drawn = painted(in_crop(seen.mesh), CROP_SHAPE[::-1])
    assert np.abs(seen.crop[INSIDE].astype(int) - drawn[INSIDE]).mean() < 1.5
    faded = (1 - share) * look(REST).crop.astype(float) + share * look(OTHER).crop
    assert np.abs(faded[INSIDE] - drawn[INSIDE]).mean() > 2.5
