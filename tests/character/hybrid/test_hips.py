"""Backs of hips: level with what is seen in front, and the leg's own further down."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.hybrid.hips import at_hips, hips_behind
from engine.character.hybrid.hybrid import Hybrid, make_hybrid
from engine.character.hybrid.seam import with_the_trunks_colours
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, TRUNK_LABEL
from engine.character.shell.colours.texels import SHELL_TEXTURE_SIZE_TEXELS, texels
from engine.character.shell.template_mesh import template_mesh
from engine.character.texture.texture import Tiles
from engine.geometry.mesh.surface import vertex_normals
from engine.imaging.masks.mask_distance import dilate_mask
from engine.render.rasterisation.attributes import interpolate
from tests.character.hybrid.test_hybrid import figure_and_outline

Seen = tuple[Figure, FittedBody, Silhouette, Labels]
SHIRT, TROUSERS, SKIN = (40, 160, 60), (40, 50, 150), (220, 170, 140)


@pytest.fixture(scope="module")
def seen() -> Seen:
    return figure_and_outline()


@pytest.fixture(scope="module")
def hybrid(seen: Seen) -> Hybrid:
    figure, fitted, silhouette, labels = seen
    return make_hybrid(figure, silhouette, fitted, labels)


def test_a_hem_is_as_high_behind_as_in_front(seen: Seen) -> None:
    _, _, silhouette, labels = seen
    legs = np.flatnonzero(np.isin(labels.labels, LEG_LABELS).any(1))
    hem = int(legs[0]) + 12  # below where the template's legs begin
    to_picture = (hem - silhouette.to_grid[1, 2]) / silhouette.to_grid[1, 1]
    height, width = silhouette.alpha.shape
    rows = np.arange(height)[:, None, None]
    rgb = np.broadcast_to(np.where(rows < to_picture, SHIRT, TROUSERS), (height, width, 3)).astype(np.uint8).copy()
    rgb[silhouette.alpha < 0.5] = 255
    places = np.array([[210.0, hem - 30], [210.0, hem + 30]])
    behind = hips_behind(rgb, labels, silhouette, places)
    margin = 3 / silhouette.to_grid[1, 1]
    body = silhouette.alpha > 0.99
    for first, last, colour in (
        (to_picture - 25, to_picture - margin, SHIRT),
        (to_picture + margin, to_picture + 25, TROUSERS),
    ):
        band = body & (rows[..., 0] > first) & (rows[..., 0] < last)
        band &= np.isin(_in_picture(labels, silhouette), (TRUNK_LABEL, *LEG_LABELS))
        assert band.sum() > 500
        off = np.abs(behind[band].astype(int) - colour).max(1)
        assert (off < 12).mean() > 0.98
    np.testing.assert_array_equal(hips_behind(rgb, labels, silhouette, places[:0]), rgb)


def test_backs_of_hips_have_the_hem_where_it_is_in_front(seen: Seen, hybrid: Hybrid) -> None:
    """Of a shell that was black all over: it is left so as far as backs of legs are not level with the trunk."""
    figure, _, silhouette, labels = seen
    mesh, raster = hybrid.shell.mesh, texels()
    facing = -vertex_normals(hybrid.shell.pictured, mesh.triangles)[:, 2]
    leg = np.isin(hybrid.limbs.limb, LEG_LABELS) & (mesh.parts[:, TRUNK_LABEL] < 0.5)
    values = np.column_stack([hybrid.shell.pictured[:, 1], facing, at_hips(hybrid), leg]).astype(np.float32)
    y, turned, level, share = np.moveaxis(interpolate(values, mesh.triangles, raster), -1, 0)
    behind = (raster.triangle >= 0) & (turned < -0.4) & (level > 0.3) & (share > 0.999)
    hem = float(np.median(y[behind]))
    to_picture = (hem - silhouette.to_grid[1, 2]) / silhouette.to_grid[1, 1]
    height, width = silhouette.alpha.shape
    rows = np.arange(height)[:, None, None]
    rgb = np.broadcast_to(np.where(rows < to_picture, SHIRT, TROUSERS), (height, width, 3)).astype(np.uint8).copy()
    rgb[silhouette.alpha < 0.5] = 255
    white = np.full((*labels.labels.shape, 3), 255, np.uint8)
    tiles = Tiles(white, white, white, np.zeros(labels.labels.shape, np.bool_), 1.0, np.zeros(2))
    black = np.zeros((SHELL_TEXTURE_SIZE_TEXELS, SHELL_TEXTURE_SIZE_TEXELS, 3), np.uint8)
    texture = with_the_trunks_colours(black, hybrid, tiles, replace(figure, rgb=rgb), silhouette)
    for area, colour in ((behind & (y < hem - 3), SHIRT), (behind & (y > hem + 3), TROUSERS)):
        off = np.abs(texture[area] - level[area][:, None] * colour).max(1)
        assert area.sum() > 1000 and np.median(off) < 5
    strange = replace(hybrid, strange=np.ones_like(hybrid.strange))  # nothing in the picture is surely a leg's
    texture = with_the_trunks_colours(black, strange, tiles, replace(figure, rgb=rgb), silhouette)
    before = (raster.triangle >= 0) & (turned > 0.4) & (level > 0.3) & (share > 0.999)
    assert before.sum() > 1000 and not texture[before].any(), "fronts are not what is behind"


def test_what_is_seen_of_an_arm_goes_over_into_what_is_not_without_a_border(seen: Seen, hybrid: Hybrid) -> None:
    """Lit in front by twenty grey levels more than what is filled: as light just beyond what is seen, and not at all behind."""
    figure, _, silhouette, labels = seen
    mesh, raster = hybrid.shell.mesh, texels()
    facing = -vertex_normals(hybrid.shell.pictured, mesh.triangles)[:, 2]
    arm = np.isin(hybrid.limbs.limb, ARM_LABELS) & (mesh.parts[:, TRUNK_LABEL] < 0.1) & (mesh.hand < 0.1)
    turned, share = np.moveaxis(
        interpolate(np.column_stack([facing, arm]).astype(np.float32), mesh.triangles, raster), -1, 0
    )
    arm = (raster.triangle >= 0) & (share > 0.999)
    lit = np.full((*silhouette.alpha.shape, 3), 140, np.uint8)
    dark = np.full((*labels.labels.shape, 3), 120, np.uint8)
    tiles = Tiles(dark, dark, dark, np.zeros(labels.labels.shape, np.bool_), 1.0, np.zeros(2))
    filled = np.full((SHELL_TEXTURE_SIZE_TEXELS, SHELL_TEXTURE_SIZE_TEXELS, 3), 120, np.uint8)
    texture = with_the_trunks_colours(filled, hybrid, tiles, replace(figure, rgb=lit), silhouette)[..., 0].astype(int)
    front, beside, behind = (arm & (low < turned) & (turned < high) for low, high in ((0.4, 1), (0, 0.12), (-1, -0.9)))
    assert (texture[front] >= 139).mean() > 0.9
    assert np.median(texture[beside]) > 134
    assert np.median(texture[behind]) < 126


def test_neither_the_wall_nor_an_arm_beside_them_is_on_hips(seen: Seen) -> None:
    """The template may be wider than who is pictured."""
    _, _, silhouette, labels = seen
    shown = _in_picture(labels, silhouette)
    height, width = silhouette.alpha.shape
    rgb = np.full((height, width, 3), 255, np.uint8)
    rgb[silhouette.alpha > 0.5] = TROUSERS
    rgb[(silhouette.alpha > 0.5) & np.isin(shown, ARM_LABELS)] = SKIN
    body = np.isin(shown, (TRUNK_LABEL, *LEG_LABELS)) & (silhouette.alpha > 0.99)
    rows = np.flatnonzero(np.isin(labels.labels, LEG_LABELS).any(1))[0] + np.array([-20.0, 20.0])
    behind = hips_behind(rgb, labels, silhouette, np.stack([[210.0, 210.0], rows], 1))
    first, last = ((rows - silhouette.to_grid[1, 2]) / silhouette.to_grid[1, 1]).astype(int)
    about = dilate_mask(body, 8)
    about[:first] = about[last:] = False
    assert about.sum() > body[first:last].sum()
    assert np.abs(behind[about].astype(int) - TROUSERS).max() < 12


def _hips(seen: Seen, narrow: int = 0) -> tuple[Labels, np.ndarray, int, float]:
    """Labels of somebody of whose trunk, down to so many rows above a hem at the hips, arms leave a middle alone; their body (H, W) in the picture;
    and the hem's row on the grid and in the picture."""
    _, _, silhouette, labels = seen
    hem = int(np.flatnonzero(np.isin(labels.labels, LEG_LABELS).any(1))[0]) + 12
    found = labels.labels.copy()
    if narrow:
        above = found[: hem - narrow]
        middle = int(np.median(np.nonzero(above == TRUNK_LABEL)[1]))
        beside = np.abs(np.arange(found.shape[1]) - middle)[None] > 10
        above[(above == TRUNK_LABEL) & beside] = ARM_LABELS[0]
    labels = replace(labels, labels=found)
    body = np.isin(_in_picture(labels, silhouette), (TRUNK_LABEL, *LEG_LABELS)) & (silhouette.alpha > 0.99)
    return labels, body, hem, (hem - silhouette.to_grid[1, 2]) / silhouette.to_grid[1, 1]


def test_legs_of_shorts_that_rise_towards_the_sides_are_as_long_behind_as_in_their_middle(seen: Seen) -> None:
    labels, body, hem, row = _hips(seen)
    rows, columns = np.indices(body.shape)
    at_hem = np.flatnonzero(body[int(row)])
    middle, half = (at_hem[0] + at_hem[-1]) / 2, (at_hem[-1] - at_hem[0]) / 2
    rising = row - 30 * (np.abs(columns - middle) > 0.65 * half)
    rgb = np.where((rows < rising)[..., None], TROUSERS, SKIN).astype(np.uint8)
    behind = hips_behind(rgb, labels, seen[2], np.array([[210.0, hem - 30], [210.0, hem + 30]]))
    band = body & (rows > row - 24) & (rows < row - 5)
    assert band.sum() > 500
    assert (np.abs(behind[band].astype(int) - TROUSERS).max(1) < 12).mean() > 0.98


def test_hips_have_no_neckline(seen: Seen) -> None:
    """What arms leave of a shirt above them is no neck."""
    labels, body, hem, row = _hips(seen, narrow=15)
    rows, step = np.indices(body.shape)[0], 1 / seen[2].to_grid[1, 1]
    rgb = np.where((rows < row)[..., None], SHIRT, TROUSERS).astype(np.uint8)
    behind = hips_behind(rgb, labels, seen[2], np.array([[210.0, hem - 30], [210.0, hem + 30]]))
    band = body & (rows > row - 38 * step) & (rows < row - 6 * step)
    assert band.sum() > 200
    assert (np.abs(behind[band].astype(int) - SHIRT).max(1) < 12).mean() > 0.95


def _in_picture(labels: Labels, silhouette: Silhouette) -> np.ndarray:
    """The label (H, W) of each pixel of the picture."""
    height, width = silhouette.alpha.shape
    y, x = np.mgrid[:height, :width]
    column, row = (
        np.clip(np.rint(at * silhouette.to_grid[k, k] + silhouette.to_grid[k, 2]), 0, labels.labels.shape[1 - k] - 1)
        for k, at in enumerate((x, y))
    )
    return labels.labels[row.astype(int), column.astype(int)]


def test_thighs_go_over_to_their_own_further_down_and_lifted_ones_are_so_from_the_hip(
    seen: Seen, hybrid: Hybrid
) -> None:
    mesh = template_mesh()
    level = at_hips(hybrid)
    assert level.min() >= 0 and level.max() == 1
    assert not level[~np.isin(hybrid.limbs.limb, LEG_LABELS)].any()
    knees = mesh.share("LeftLeg", "RightLeg") > 0.5
    assert not level[knees].any()
    space = load_human().space
    rise = space.mean[mesh.ids][:, 1]
    left = hybrid.limbs.limb == LEG_LABELS[0]
    order = np.argsort(rise[left])
    assert (np.diff(level[left][order]) >= 0).all(), "the higher, the more"
    lifted = hybrid.shell.pictured.copy()
    thigh = mesh.share("LeftUpLeg", "LeftLeg") > 0.5
    joint = lifted[thigh & (rise > np.quantile(rise[thigh], 0.97))].mean(0)
    turn = Rotation.from_euler("x", 80, degrees=True)
    lifted[thigh] = turn.apply(lifted[thigh] - joint) + joint
    raised = at_hips(replace(hybrid, shell=replace(hybrid.shell, pictured=lifted)))
    assert not raised[left].any()
    np.testing.assert_array_equal(raised[~left], level[~left])
