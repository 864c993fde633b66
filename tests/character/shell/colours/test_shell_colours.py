"""The texture of a whole shell, before pictures whose colours are known everywhere."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import load_human
from engine.character.parts.label_map import Labels
from engine.character.shell.colours.ears import ear_shade
from engine.character.shell.colours.evidence import witness
from engine.character.shell.colours.paint import paint_shell
from engine.character.shell.colours.texels import SHELL_TEXTURE_SIZE_TEXELS, texels
from engine.character.shell.shell import Shell
from engine.character.shell.template_mesh import template_mesh
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise

HEIGHT, WIDTH = 260, 300
SKIN, HAIR, CLOTH, WALL = (200, 150, 120), (60, 40, 20), (30, 60, 160), (20, 230, 20)
RIM = (250, 0, 250)


def standing() -> Shell:
    """The mean body at rest, seen from before."""
    mesh = template_mesh()
    rest = load_human().space.mean[mesh.ids].astype(np.float64)
    scale = (HEIGHT - 40) / np.ptp(rest[:, 1])
    pictured = (rest - [rest[:, 0].mean(), rest[:, 1].max(), 0]) * [scale, -scale, scale] + [WIDTH / 2, 20, 0]
    return Shell(mesh, pictured, pictured, rest)


@pytest.fixture(scope="module")
def seen() -> tuple[Shell, Silhouette, Labels]:
    shell = standing()
    screen = shell.pictured * [1, 1, -1]
    raster = rasterise(screen, shell.mesh.triangles, (HEIGHT, WIDTH))
    mask = raster.triangle >= 0
    part = shell.mesh.parts.argmax(1)[shell.mesh.triangles[raster.triangle]][..., 0]
    none = np.full(mask.shape, -1, np.int8)
    labels = Labels(np.where(mask, part, -1).astype(np.int8), ~mask & False, np.zeros(0, np.int8), ~mask & False, none)
    on_grid = np.array([[1.0, 0, 0], [0, 1, 0]])
    rgb = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    return shell, Silhouette(mask.astype(np.float32), mask.astype(np.float32), mask, rgb, on_grid), labels


def dressed(shell: Shell, silhouette: Silhouette) -> NDArray[np.uint8]:
    """In cloth up to the neck, with hair above the brows, before a green wall."""
    mesh = shell.mesh
    eyes = shell.pictured[mesh.eye, 1].mean()
    colours = np.where(mesh.parts[:, BODY_PARTS.index("head"), None] > 0.5, SKIN, CLOTH).astype(np.float32)
    colours[(mesh.head > 0.5) & (shell.pictured[:, 1] < eyes - 6)] = HAIR
    raster = rasterise(shell.pictured * [1, 1, -1], mesh.triangles, (HEIGHT, WIDTH))
    drawn = interpolate(colours, mesh.triangles, raster)
    return np.where(silhouette.mask[..., None], drawn, WALL).astype(np.uint8)


def test_all_of_somebody_in_one_colour_is_in_it_and_nothing_of_the_wall(
    seen: tuple[Shell, Silhouette, Labels],
) -> None:
    shell, silhouette, labels = seen
    rgb = np.where(silhouette.mask[..., None], np.array(CLOTH), np.array(WALL)).astype(np.uint8)
    texture = paint_shell(rgb, silhouette, labels, shell)
    assert texture.shape == (SHELL_TEXTURE_SIZE_TEXELS, SHELL_TEXTURE_SIZE_TEXELS, 3) and texture.dtype == np.uint8
    folds = interpolate(ear_shade()[:, None], shell.mesh.triangles, texels())[..., 0]
    assert np.abs(texture.astype(int) - CLOTH)[folds == 1].max() <= 2
    darker = texture[(texels().triangle >= 0) & (folds < 0.6)].astype(float)
    assert (darker < np.array(CLOTH) * 0.75).all(), "but for the folds of ears, which nobody sees from before"


def test_the_back_of_a_head_is_hair_and_that_of_a_trunk_is_cloth(seen: tuple[Shell, Silhouette, Labels]) -> None:
    shell, silhouette, labels = seen
    texture = paint_shell(dressed(shell, silhouette), silhouette, labels, shell).astype(int)
    mesh, raster = shell.mesh, texels()
    rest = interpolate(shell.rest, mesh.triangles, raster)
    parts = interpolate(mesh.parts, mesh.triangles, raster)
    level = shell.rest[mesh.eye, 1].mean()
    on = raster.triangle >= 0
    back = on & (rest[..., 2] < -0.06)
    high = on & (rest[..., 2] < -0.02) & (parts[..., 0] > 0.9) & (np.abs(rest[..., 1] - level) < 0.04)
    trunk = back & (parts[..., 1] > 0.95)
    assert high.sum() > 1000 and trunk.sum() > 1000
    assert np.median(np.abs(texture[high] - HAIR).max(-1)) < 10
    assert np.median(np.abs(texture[trunk] - CLOTH).max(-1)) < 4


def test_what_is_shown_is_the_pictures_own(seen: tuple[Shell, Silhouette, Labels]) -> None:
    shell, silhouette, labels = seen
    y, x = np.indices((HEIGHT, WIDTH))
    rgb = np.stack([x * 0.8, y * 0.9, 120 + 0 * x], -1).astype(np.uint8)
    texture = paint_shell(rgb, silhouette, labels, shell)
    told = witness(rgb, silhouette, labels, shell)
    points = interpolate(told.attributes, shell.mesh.triangles, texels())
    chest = (texels().triangle >= 0) & (points[..., 3] > 0.9) & (points[..., 5] > 0.9)
    found = told.of(points[chest])
    assert (found.shown == 1).mean() > 0.9 and found.source.mean() > 0.8
    surely = np.zeros_like(chest)
    surely[chest] = found.source
    surely = surely & np.roll(surely, 8, 0) & np.roll(surely, -8, 0) & np.roll(surely, 8, 1) & np.roll(surely, -8, 1)
    expected = points[surely][:, :2] * [0.8, 0.9]
    assert surely.sum() > 5000
    assert np.abs(texture[surely][:, :2] - expected).max() < 2


def test_nothing_of_a_heads_rim_is_drawn_out_over_its_side(seen: tuple[Shell, Silhouette, Labels]) -> None:
    """A rim of another colour, of few pixels: light from behind, a wall. Neither where a head turns away, nor between eye and ear."""
    shell, silhouette, labels = seen
    mesh = shell.mesh
    rgb = dressed(shell, silhouette)
    told = witness(rgb, silhouette, labels, shell)
    seen_at = rasterise(shell.pictured * [1, 1, -1], mesh.triangles, (HEIGHT, WIDTH))
    towards = interpolate(told.attributes, mesh.triangles, seen_at)[..., 3]
    rgb[silhouette.mask & (labels.labels == BODY_PARTS.index("head")) & (towards < 0.3)] = RIM
    texture = paint_shell(rgb, silhouette, labels, shell).astype(float)
    of_rim = np.clip((np.minimum(texture[..., 0], texture[..., 2]) - texture[..., 1]) / RIM[0], 0, 1)
    points = interpolate(told.attributes, mesh.triangles, texels())
    below_eyes = shell.rest[mesh.eye, 1].mean() - interpolate(shell.rest, mesh.triangles, texels())[..., 1]
    shown = (texels().triangle >= 0) & (points[..., 4] > 0.95) & (told.of(points).shown > 0.5)
    turned_away = shown & (points[..., 3] < 0.2)
    temples = shown & (points[..., 3] > 0.3) & (points[..., 3] < 0.5) & (below_eyes > 0) & (below_eyes < 0.06)
    for area in (turned_away, temples):
        assert area.sum() > 5000 and of_rim[area].mean() < 0.05


def test_what_is_filled_begins_in_the_light_of_what_it_meets(seen: tuple[Shell, Silhouette, Labels]) -> None:
    """Arms tell what each other is like all round; one of them is in the shade."""
    shell, silhouette, labels = seen
    bright = np.array(CLOTH) + 24
    right = np.arange(WIDTH) < WIDTH / 2
    rgb = np.where(silhouette.mask[..., None], np.where(right[:, None], bright, CLOTH), WALL).astype(np.uint8)
    texture = paint_shell(rgb, silhouette, labels, shell).astype(float)
    told = witness(rgb, silhouette, labels, shell)
    on = texels().triangle >= 0
    shown = on & (told.of(interpolate(told.attributes, shell.mesh.triangles, texels())).shown > 0)
    away = cv2.distanceTransform((~shown).astype(np.uint8), cv2.DIST_L2, 5)
    parts = interpolate(shell.mesh.parts, shell.mesh.triangles, texels())
    for arm, colour in (("left_arm", CLOTH), ("right_arm", bright)):
        beside = on & (parts[..., BODY_PARTS.index(arm)] > 0.9) & (away > 2) & (away < 8)
        off = np.abs(texture[beside] - colour).max(-1)
        assert beside.sum() > 5000 and (off > 18).mean() < 0.03


def test_wall_that_the_mask_takes_in_is_no_source(seen: tuple[Shell, Silhouette, Labels]) -> None:
    shell, silhouette, labels = seen
    rgb = dressed(shell, silhouette)
    wide = cv2.dilate(silhouette.mask.astype(np.uint8), np.ones((7, 7), np.uint8)) > 0
    taken = wide & ~silhouette.mask
    trunk = BODY_PARTS.index("torso")
    grown = replace(labels, labels=np.where(taken, trunk, labels.labels).astype(np.int8))
    told = witness(rgb, replace(silhouette, mask=wide, rgb=rgb), grown, shell)
    assert told.wall[taken].mean() > 0.9
    assert not told.wall[silhouette.mask & (labels.labels == trunk) & (told.inside > 6)].any()
