"""The template displaced to outlines that are known."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.parts import BODY_PARTS
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.rest_skeleton import pictured_joints
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.parts.label_map import Labels
from engine.character.shell.at_rest import shell_at_rest
from engine.character.shell.displacement import KnownPoints, displace
from engine.character.shell.outlines import part_outlines
from engine.character.shell.shell import with_head_at_face
from engine.character.shell.template_mesh import TemplateMesh, template_mesh
from engine.character.shell.thickness import thickened
from engine.geometry.rigging.skinning import skin
from engine.render.rasterisation.rasteriser import rasterise
from tests.character.fit.test_head_and_legs import standing

SHAPE = (460, 420)
NOTHING_KNOWN = KnownPoints(np.zeros(0, np.intp), np.zeros((0, 2)))


def arms_down() -> FittedBody:
    fitted = standing()
    for side, degrees in (("Left", -55), ("Right", 55)):
        turn = Rotation.from_euler("z", degrees, degrees=True).as_matrix()
        fitted.fit.rotations[load_human().rig.index(f"{side}Arm")] = turn
    return fitted


def on_grid(posed: PosedTemplate, mesh: TemplateMesh) -> NDArray[np.float64]:
    """The template (V, 3), 400 pixels high."""
    places = posed.vertices[mesh.ids]
    scale = 400 / np.ptp(places[:, 1])
    middle = (places.min(0) + places.max(0)) / 2
    return np.asarray((places - middle) * scale + [SHAPE[1] / 2, SHAPE[0] / 2, 0])


@pytest.fixture(scope="module")
def template() -> NDArray[np.float64]:
    return on_grid(pose_template(arms_down(), arms_down().picture_camera(), load_human()), template_mesh())


def labels_of(places: NDArray[np.float64], wider: int = 0) -> Labels:
    """What a picture of the template shows, clothes all around it so many pixels thick."""
    mesh = template_mesh()
    screen = np.stack([places[:, 0], places[:, 1], -places[:, 2]], 1)
    seen = rasterise(screen, mesh.triangles, SHAPE).triangle
    labels = np.where(seen >= 0, mesh.parts.argmax(1)[mesh.triangles[seen, 0]], -1).astype(np.int8)
    if wider:
        mask = cv2.dilate(
            (labels >= 0).astype(np.uint8), cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * wider + 1,) * 2)
        )
        _, nearest = cv2.distanceTransformWithLabels(
            (labels < 0).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
        )
        value = np.full(nearest.max() + 1, -1, np.int8)
        value[nearest[labels >= 0]] = labels[labels >= 0]
        labels = np.where(mask > 0, value[nearest], -1).astype(np.int8)
    nowhere = np.zeros(SHAPE, np.bool_)
    return Labels(labels, nowhere, np.zeros(0, np.int8), nowhere, np.full(SHAPE, -1, np.int8))


def covered(places: NDArray[np.float64]) -> NDArray[np.bool_]:
    screen = np.stack([places[:, 0], places[:, 1], -places[:, 2]], 1)
    return np.asarray(rasterise(screen, template_mesh().triangles, SHAPE).triangle >= 0)


def overlap(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> float:
    return float((one & other).sum() / (one | other).sum())


def test_by_its_own_outline_the_template_stays_what_it_is(template: NDArray[np.float64]) -> None:
    same = displace(template_mesh(), template, part_outlines(labels_of(template)), NOTHING_KNOWN).vertices
    away = np.linalg.norm(same - template, axis=1)
    assert np.median(away) < 1.2 and np.percentile(away, 99) < 5  # pixels of 400: parts go on beneath others
    assert overlap(covered(same), covered(template)) > 0.95


@pytest.fixture(scope="module")
def clothed(template: NDArray[np.float64]) -> NDArray[np.float64]:
    displaced = displace(template_mesh(), template, part_outlines(labels_of(template, 6)), NOTHING_KNOWN)
    return thickened(template_mesh(), template, displaced)


def test_clothes_make_it_wider_and_as_much_thicker(template: NDArray[np.float64], clothed: NDArray[np.float64]) -> None:
    mesh = template_mesh()
    worn = labels_of(template, 6).labels >= 0
    assert overlap(covered(template), worn) < 0.85 and overlap(covered(clothed), worn) > 0.94
    belly = (mesh.parts[:, BODY_PARTS.index("torso")] > 0.9) & (np.abs(template[:, 0] - SHAPE[1] / 2) < 15)
    more = (clothed - template)[belly, 2] * np.sign(template[belly, 2] - np.median(template[belly, 2]))
    assert 2 < np.median(more) < 8


def test_no_hand_is_drawn_out_and_nothing_is_folded_over(
    template: NDArray[np.float64], clothed: NDArray[np.float64]
) -> None:
    mesh = template_mesh()

    def normals(places: NDArray[np.float64]) -> NDArray[np.float64]:
        a, b, c = (places[mesh.triangles[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    before, after = normals(template), normals(clothed)
    assert ((before * after).sum(1) < 0).mean() < 0.01
    hand = (mesh.share("LeftHand") > 0.9)[mesh.triangles].all(1)
    grown = np.linalg.norm(after[hand], axis=1).sum() / np.linalg.norm(before[hand], axis=1).sum()
    assert 0.8 < grown < 1.8


def test_at_rest_it_is_what_the_pictured_joints_bring_to_the_picture() -> None:
    mesh, fitted = template_mesh(), arms_down()
    camera = fitted.picture_camera()
    posed = pose_template(fitted, camera, load_human())
    places, straight = posed.vertices[mesh.ids], posed.rest[mesh.ids]
    thicker = places.copy()
    thicker[:, :2] += 0.02 * camera.pixels_per_metre * np.sin(places[:, 1:2] / 20) * [1, 0.3]
    rest = shell_at_rest(mesh, straight, places, thicker, camera, fitted)
    transforms = pictured_joints(fitted, load_human().space).transforms()
    back = skin(rest, mesh.bones, mesh.weights, transforms)
    off = np.linalg.norm(back - camera.to_metres(thicker), axis=1)
    assert np.percentile(off, 99) < 1e-3 and off.max() < 1e-2  # metres
    np.testing.assert_allclose(
        shell_at_rest(mesh, straight, places, places, camera, fitted), straight, atol=6e-3
    )  # of six influences four are kept


def test_a_border_beside_what_is_held_is_no_outline(template: NDArray[np.float64]) -> None:
    """What a hand is hidden by has an edge there, the hand has none."""
    labels = labels_of(template)
    arm = BODY_PARTS.index("left_arm")
    y = np.nonzero(labels.labels == arm)[0]
    rows = np.arange(SHAPE[0])[:, None]
    hidden = (labels.labels == arm) & (rows > y.max() - 12)
    bare = replace(labels, labels=np.where(hidden, -1, labels.labels).astype(np.int8))
    held = replace(bare, held=np.where(hidden, arm, -1).astype(np.int8))
    cut = y.max() - 12

    def along_the_cut(one: Labels) -> int:
        points = part_outlines(one).of(arm).points
        return int((np.abs(points[:, 1] - cut) < 1.5).sum())

    assert along_the_cut(bare) > along_the_cut(held) + 2


def test_a_head_is_moved_and_enlarged_to_where_its_face_is_seen(template: NDArray[np.float64]) -> None:
    """A face that is a tenth larger and 8 pixels aside: so is the skull, the neck half as much, and the trunk not at all."""
    mesh = template_mesh()
    face = mesh.renamed(load_human().face[17:])
    middle = template[face, :2].mean(0)
    seen = middle + 1.1 * (template[face, :2] - middle) + [8, -2]
    placed = with_head_at_face(mesh, template, KnownPoints(face, seen))
    np.testing.assert_allclose(placed[face, :2], seen, atol=0.3)
    skull, trunk = mesh.share("Head") > 0.99, mesh.share("Head", "Neck") <= 0
    assert np.ptp(placed[skull, 1]) == pytest.approx(1.1 * np.ptp(template[skull, 1]), rel=0.01)
    assert np.ptp(placed[skull, 2]) == pytest.approx(1.1 * np.ptp(template[skull, 2]), rel=0.01), "in depth, too"
    np.testing.assert_array_equal(placed[trunk], template[trunk])
    between = (mesh.share("Head") <= 0) & (mesh.share("Neck") > 0.5)
    aside = (placed - template)[between, 0]
    assert aside.min() > 0.5 and aside.max() < 8, "the neck goes less far"
    np.testing.assert_array_equal(with_head_at_face(mesh, template, NOTHING_KNOWN), template)
