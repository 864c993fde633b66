"""Skin of lids that lies tucked beside their rims."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.eyes.tucked_lids import (
    CORNER_LID_SHARE,
    LID_SKIN_EYE_WIDTHS,
    SLID_EYE_WIDTHS,
    TUCKED_EYE_WIDTHS,
    LidColumns,
    tucked_lid,
    with_tucked_lids,
)
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lid_rims import lid_rim, upper_lid_columns
from engine.avatar.registration.template_skin.skin import EYE_PARTS
from engine.geometry.mesh.closest_points import closest_points

WIDTH = 0.024
"""Metres."""
RIM = np.array([[-WIDTH / 2, 0, 0], [0, 0.005, 0], [WIDTH / 2, 0, 0], [0, -0.005, 0]])


def straight_columns() -> NDArray[np.float64]:
    """(2, 13, 3) one column up from the middle of the rim, and one from its corner, with a vertex each twentieth of the width."""
    rise = WIDTH / 20 * np.arange(13)
    return np.stack([np.column_stack([0 * rise + x, y + rise, 0 * rise]) for x, y in ((0, 0.005), (WIDTH / 2, 0))])


def test_lids_take_a_tuck_and_what_is_beyond_the_brow_stays() -> None:
    tucked = tucked_lid(straight_columns(), RIM)
    up = (tucked[0, :, 1] - 0.005) / WIDTH
    np.testing.assert_allclose(up[[0, 4]], [0, TUCKED_EYE_WIDTHS], atol=1e-9)
    assert np.diff(up).min() > 0 and LID_SKIN_EYE_WIDTHS == 0.2
    np.testing.assert_allclose(up[9:], np.arange(9, 13) / 20, atol=1e-9)
    assert SLID_EYE_WIDTHS == 0.45
    np.testing.assert_allclose(tucked[1], straight_columns()[1])  # at the corner nothing slides


def test_how_long_a_lid_is_out_of_its_tuck_is_known_again() -> None:
    columns = LidColumns.of(straight_columns(), RIM)
    again = LidColumns.of(tucked_lid(straight_columns(), RIM), RIM)
    np.testing.assert_allclose(again.untucked(), columns.lengths, atol=1e-9)


def test_the_fold_of_a_tucked_lid_is_where_its_skin_ends_and_sooner_at_a_corner() -> None:
    up = LidColumns.of(tucked_lid(straight_columns(), RIM), RIM).up()
    np.testing.assert_allclose(up[0, [0, 2, 4]], [0, 0.5, 1], atol=1e-9)
    np.testing.assert_allclose(up[1, :3], [0, 0.05 / (0.2 * CORNER_LID_SHARE), 0.1 / (0.2 * CORNER_LID_SHARE)])


def test_rims_stay_and_the_surface_is_the_same(models: HumanModels) -> None:
    before = models.template.vertices.astype(np.float64)
    after = with_tucked_lids(models.template, before)
    skin = models.skin
    off = closest_points(after[skin.vertices], before[skin.vertices], skin.triangles).distance
    moved = np.linalg.norm(after - before, axis=1)
    assert moved.max() > 0.002 and off.max() < 0.0003
    for part in EYE_PARTS:
        assert not moved[lid_rim(models.template, part)].any()


def test_columns_begin_at_the_rim_and_cross_none_of_each_other(models: HumanModels) -> None:
    for part in EYE_PARTS:
        columns = upper_lid_columns(models.template, part)
        assert len(np.unique(columns)) == columns.size and len(columns) > 8
        assert np.isin(columns[:, 0], lid_rim(models.template, part)).all()
        assert not np.isin(columns[:, 1:], lid_rim(models.template, part)).any()
        heights = models.template.vertices[columns, 1]
        assert (heights[:, -1] > heights[:, 0]).all()
