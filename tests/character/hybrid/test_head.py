"""The shell's head on a relief, of the template in its own outline: when it is taken, and how it sits."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.parts import BODY_PARTS
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS, Silhouette
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.hybrid.cut_off import cut_off
from engine.character.hybrid.head import (
    COLLAR_SMOOTHING_PIXELS,
    hair_keeps_to_the_head,
    joined_at_the_neck,
    no_limbs,
    with_head,
    without_head,
)
from engine.character.hybrid.headed import make_headed_relief
from engine.character.hybrid.hybrid import Hybrid, limbs_alone, make_hybrid
from engine.character.hybrid.suited_surface import arm_raised, legs_pass, suited_surface
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS
from engine.character.shell.shell import ears_laid_back, eyes_in_sockets, shaped_head
from engine.character.shell.template_mesh import template_mesh
from engine.character.stages import build_mesh
from engine.character.surface.depth_order import INSET_PIXELS
from engine.geometry.mesh.welding import is_closed, same_rows
from engine.imaging.masks.mask_distance import dilate_mask, distance_to
from engine.render.rasterisation.rasteriser import rasterise
from tests.character.fit.test_head_and_legs import seen_face
from tests.character.hybrid.test_hybrid import figure_and_outline

HEAD, TRUNK = BODY_PARTS.index("head"), BODY_PARTS.index("torso")

COLLAR_DEPTH_PIXELS = 14
"""Pixels of the trunk below the head that show a neck in an open collar."""

Found = tuple[Figure, FittedBody, Silhouette, Labels]


@pytest.fixture(scope="module")
def found() -> Found:
    """The template, whose face is seen."""
    figure, fitted, silhouette, labels = figure_and_outline()
    return replace(figure, face=seen_face(np.eye(3))), fitted, silhouette, labels


@pytest.fixture(scope="module")
def template(found: Found) -> NDArray[np.float64]:
    """Its vertices in the picture."""
    figure, fitted, silhouette, labels = found
    return shaped_head(figure, silhouette, fitted, labels).template


@pytest.fixture(scope="module")
def open_collar(found: Found) -> tuple[Labels, Hybrid]:
    """A neck that is seen further down, as in an open collar: the labels, and both surfaces."""
    figure, fitted, silhouette, own = found
    neck = (own.labels == TRUNK) & dilate_mask(own.labels == HEAD, COLLAR_DEPTH_PIXELS)
    labels = replace(own, labels=np.where(neck, HEAD, own.labels).astype(np.int8))
    return labels, make_hybrid(figure, silhouette, fitted, labels)


def keeps(found: Found, template: NDArray[np.float64], labels: NDArray[np.int8]) -> bool:
    figure, _, silhouette, own = found
    return hair_keeps_to_the_head(figure, silhouette, replace(own, labels=labels), template_mesh(), template)


def test_a_head_in_its_own_outline_keeps_to_the_template(found: Found, template: NDArray[np.float64]) -> None:
    assert keeps(found, template, found[3].labels)


def test_hair_that_stands_off_or_falls_does_not(found: Found, template: NDArray[np.float64]) -> None:
    labels = found[3].labels
    head = labels == HEAD
    rows, columns = np.nonzero(head)
    middle = (rows.min() + rows.max()) // 2
    cap = dilate_mask(head, GRID_HEIGHT_PIXELS // 80) & (labels < 0)
    cap[middle:] = False
    assert keeps(found, template, np.where(cap, HEAD, labels).astype(np.int8)), "short hair"
    afro = dilate_mask(head, GRID_HEIGHT_PIXELS // 20) & (labels < 0)
    assert not keeps(found, template, np.where(afro, HEAD, labels).astype(np.int8))
    fallen = labels.copy()
    aside = (columns.max() - columns.min()) // 4
    fallen[middle : rows.max() + 10, columns.min() - aside : columns.max() + aside] = HEAD
    assert not keeps(found, template, fallen)


def test_without_a_face_or_cut_off_nothing_is_known_of_a_head(found: Found, template: NDArray[np.float64]) -> None:
    figure, _, silhouette, labels = found
    mesh = template_mesh()
    assert not hair_keeps_to_the_head(replace(figure, face=None), silhouette, labels, mesh, template)
    rows = np.nonzero((labels.labels == HEAD).any(1))[0]
    up = silhouette.to_grid.copy()
    up[1, 2] += (rows[0] + rows[-1]) / 2
    assert not hair_keeps_to_the_head(figure, replace(silhouette, to_grid=up), labels, mesh, template)


def test_a_picture_that_cuts_a_crown_off_has_the_head(found: Found, template: NDArray[np.float64]) -> None:
    figure, _, silhouette, labels = found
    rows = np.nonzero((labels.labels == HEAD).any(1))[0]
    up = silhouette.to_grid.copy()
    up[1, 2] += rows[0] + 0.1 * (rows[-1] - rows[0])
    assert hair_keeps_to_the_head(figure, replace(silhouette, to_grid=up), labels, template_mesh(), template)


def test_labels_without_a_head_have_its_neck_beneath(found: Found) -> None:
    labels = found[3].labels
    headless = without_head(found[3]).labels
    assert not (headless == HEAD).any()
    grown = (headless == TRUNK) & (labels == HEAD)
    assert 20 < grown.sum() < 0.3 * (labels == HEAD).sum()
    assert (headless[labels > TRUNK] == labels[labels > TRUNK]).all()
    assert not (grown & dilate_mask(labels < 0, 3)).any(), "it would stand beside the neck"


@pytest.fixture(scope="module")
def joined(found: Found) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]]:
    """Head and relief, vertices and triangles, in the picture."""
    figure, fitted, silhouette, labels = found
    mesh, shape = template_mesh(), shaped_head(*(figure, silhouette, fitted, labels))
    shown = with_head(no_limbs(mesh), mesh, fitted)
    relief = build_mesh(figure, silhouette, fitted, without_head(labels))
    pictured, relief = joined_at_the_neck(mesh, shape.pictured, shown, relief, labels)
    return pictured, cut_off(mesh, shown).triangles, relief.vertices, relief.triangles


def test_head_and_relief_fill_the_outline_and_each_is_seen_where_it_is_pictured(
    found: Found, joined: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]]
) -> None:
    pictured, triangles, places, relief = joined
    labels = found[3].labels
    assert is_closed(triangles) and is_closed(same_rows(places)[relief])
    vertices = np.concatenate([pictured, places]) * [1, 1, -1]
    seen = rasterise(vertices, np.concatenate([triangles, relief + len(pictured)]), labels.shape).triangle
    assert ((seen >= 0) & (labels >= 0)).sum() > 0.97 * ((seen >= 0) | (labels >= 0)).sum()
    of_head = (seen >= 0) & (seen < len(triangles))
    border = dilate_mask(labels == HEAD, 4) & dilate_mask(labels == TRUNK, 4)
    assert of_head[(labels == HEAD) & ~border].mean() > 0.98
    assert not of_head[(labels == TRUNK) & ~border].any()


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("degrees", [-30, 30])
def test_no_gap_opens_at_the_neck(
    found: Found,
    joined: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]],
    axis: str,
    degrees: float,
) -> None:
    """The head turned about its joint, the neck half as far: what it was seen to join it still does."""
    pictured, triangles, places, relief = joined
    mesh, fitted = template_mesh(), found[1]
    posed = pose_template(fitted, found[2].camera(fitted.picture_camera()), load_human())
    neck = posed.vertices[mesh.ids][mesh.share("Neck") > 0.5].mean(0)
    whole, half = (Rotation.from_euler(axis, share * degrees, degrees=True).as_matrix() for share in (1, 0.5))
    share = np.stack([mesh.share("Head", "Jaw", "LeftEye", "RightEye"), mesh.share("Neck")], 1)
    turned = pictured + share[:, :1] * ((pictured - neck) @ (whole - np.eye(3)).T)
    turned += share[:, 1:] * ((pictured - neck) @ (half - np.eye(3)).T)
    vertices = np.concatenate([turned, places]) * [1, 1, -1]
    size = found[3].labels.shape
    cover = rasterise(vertices, np.concatenate([triangles, relief + len(turned)]), size).triangle >= 0
    count, pieces = cv2.connectedComponents((~cover).astype(np.uint8))
    beside = pieces[0, 0]
    holes = ~cover & (pieces != beside)
    column, row = np.rint(neck[:2]).astype(int)
    about = holes[row - 40 : row + 40, column - 40 : column + 40]
    assert about.sum() < 4, f"{count} pieces"


@pytest.mark.parametrize(("towards", "bound"), [(1.0, 0.05), (-1.0, 0.2)])
def test_beside_shoulders_the_trunk_ends_within_the_neck(
    open_collar: tuple[Labels, Hybrid], towards: float, bound: float
) -> None:
    """Before and behind, where shoulders go on up to the neck, too: hardly any cloth is seen in the head."""
    labels, hybrid = open_collar[0].labels, open_collar[1]
    shell, trunk = (
        -rasterise(vertices * [1, 1, -towards], triangles, labels.shape).depth
        for vertices, triangles in (
            (hybrid.shell.pictured, limbs_alone(hybrid).mesh.triangles),
            (hybrid.trunk.vertices, hybrid.trunk.triangles),
        )
    )
    within = (labels == HEAD) & np.isfinite(trunk) & (distance_to(labels != HEAD) > COLLAR_SMOOTHING_PIXELS)
    assert within.sum() > 40 and (trunk > shell + INSET_PIXELS)[within].mean() < bound


def test_whose_head_is_not_seen_keeps_the_relief(found: Found) -> None:
    """A mask that a hand painted without a head: nothing is displaced, and nothing breaks."""
    figure, fitted, silhouette, labels = found
    headless = replace(labels, labels=np.where(labels.labels == HEAD, -1, labels.labels).astype(np.int8))
    headed = make_headed_relief(figure, silhouette, fitted, headless, build_mesh)
    assert headed.shell is None and headed.labels is headless
    shape = shaped_head(replace(figure, face=None), silhouette, fitted, headless)
    assert np.isfinite(shape.pictured).all()


def test_eyes_go_with_their_lids_as_a_whole() -> None:
    mesh = template_mesh()
    before = load_human().space.mean[mesh.ids].astype(np.float64) * 300
    after = before + 0.04 * before[:, [1, 0, 2]]
    moved = eyes_in_sockets(mesh, before, after)
    assert (moved[~mesh.eye] == after[~mesh.eye]).all()
    left = mesh.eye & (before[:, 0] > 0)
    for eye in (left, mesh.eye & ~left):
        steps = moved[eye] - before[eye]
        assert np.ptp(steps, axis=0).max() < 1e-9, "rigidly"
        expected = 0.04 * before[eye].mean(0)[[1, 0, 2]]
        np.testing.assert_allclose(steps[0], expected, atol=0.2)


def test_legs_that_pass_are_told_by_the_fit(found: Found) -> None:
    _, fitted, silhouette, labels = found
    assert not legs_pass(silhouette, fitted, labels)
    crossed = fitted.fit.rotations.copy()
    for side, degrees in (("Left", -14), ("Right", 14)):
        turn = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
        crossed[load_human().rig.index(f"{side}UpLeg")] = turn
    assert legs_pass(silhouette, replace(fitted, fit=replace(fitted.fit, rotations=crossed)), labels)
    assert set(LEG_LABELS) <= set(np.unique(labels.labels))


@pytest.mark.parametrize(("degrees", "raised"), [(-70, False), (0, False), (15, True), (80, True)])
def test_an_arm_is_raised_above_level(found: Found, degrees: float, raised: bool) -> None:
    _, fitted, silhouette, labels = found
    turns = fitted.fit.rotations.copy()
    turns[load_human().rig.index("RightArm")] = Rotation.from_euler("z", -degrees, degrees=True).as_matrix()
    posed = replace(fitted, fit=replace(fitted.fit, rotations=turns))
    assert arm_raised(posed) is raised
    assert suited_surface(silhouette, posed, labels) == ("relief" if raised else "hybrid")


def test_ears_that_stand_out_of_the_outline_are_laid_back() -> None:
    mesh = template_mesh()
    places = load_human().space.mean[mesh.ids].astype(np.float64) * [600, -600, 600] + [100, 1200, 0]
    ear, skull = mesh.ear, (mesh.head > 0.9) & ~mesh.ear
    wide = np.ones((1300, 220), np.bool_)
    assert (ears_laid_back(mesh, places, wide) == places).all(), "none of those that are within"
    edge = places[skull, 0].max()
    narrow = np.zeros_like(wide)
    narrow[:, : round(edge) + 1] = True
    laid = ears_laid_back(mesh, places, narrow)
    assert (laid[~ear] == places[~ear]).all()
    left = ear & (places[:, 0] > 100)
    assert (laid[ear & ~left] == places[ear & ~left]).all(), "each for itself"
    assert places[left, 0].max() > edge + 2 and laid[left, 0].max() < edge + 1.6
    order = np.argsort(places[left, 0])
    assert (np.diff(laid[left, 0][order]) >= -1e-9).all(), "it is narrower, and no fold is turned over"
