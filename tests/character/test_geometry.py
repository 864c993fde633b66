"""The parts of a character's making, each on something whose answer is known."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.body.body_space import load_body_space
from engine.body.fitting.body_fitting import Fit
from engine.body.parts import BODY_PARTS
from engine.character.figure.picture_space import PictureCamera
from engine.character.fit.template_fit import FittedBody
from engine.character.fit.template_maps import side_maps
from engine.character.parts.labels import (
    hair_beside_arms,
    refined_labels,
    rough_labels,
    without_specks,
)
from engine.character.parts.occlusion import completed
from engine.character.rig.rigging import MIN_VOLUME_RATIO, TARGET_VOLUME_RATIO, at_rest, bind
from engine.character.surface.front_and_back import Layer, stitch_front_and_back
from engine.character.surface.part_surface import Surface, part_surface, warp_part
from engine.geometry.camera import Camera
from engine.geometry.mesh.welding import is_closed
from engine.geometry.rigging.skinning import skin
from engine.imaging.filling.nearest import continued_colours
from engine.motion.kinematics import joint_places, pose_transforms


def disk(size: int, radius: float, x: float, y: float) -> np.ndarray:
    rows, columns = np.mgrid[:size, :size]
    return np.hypot(columns - x, rows - y) < radius


def test_picture_space_and_metres_are_each_others_inverse() -> None:
    camera = PictureCamera(Camera((0, 0, 0), 900.0, (310.0, 205.5), (412, 621)), 3.2)
    points = np.random.default_rng(0).uniform(-1, 1, (200, 3)) - [0, 0, 3]
    np.testing.assert_allclose(camera.to_metres(camera.to_picture(points)), points, atol=1e-9)


def ball(size: int, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """A sphere in picture space around the middle, with outward triangles for y down."""
    import trimesh

    mesh = trimesh.creation.icosphere(4, radius)
    return mesh.vertices + np.array([size / 2, size / 2, 0]), mesh.faces[:, ::-1].astype(np.int32)


def test_a_ball_warped_to_a_wider_outline_grows_deeper_with_it() -> None:
    """Normals are warped, not depth: the paper's figure 3."""
    size = 160
    vertices, triangles = ball(size, 30)
    front = side_maps(vertices, triangles, (size, size), "front")
    back = side_maps(vertices, triangles, (size, size), "back")
    assert abs(np.nanmax(front.depth) - 30) < 0.5
    assert abs(np.nanmin(back.depth) + 30) < 0.5
    assert front.normals[size // 2, size // 2, 2] > 0.99
    assert back.normals[size // 2, size // 2, 2] > 0.99
    warp = warp_part(front.mask, front.mask)
    same = part_surface(front.mask, warp, front, np.ones((size, size, 1), np.float32))
    assert np.nanmean(np.abs(same.depth - front.depth)) < 1.5
    assert 24 < same.depth[size // 2, size // 2] < 36
    behind = part_surface(front.mask, warp, back, np.ones((size, size, 1), np.float32))
    assert np.nanmean(np.abs(behind.depth - back.depth)) < 1.5
    assert -36 < behind.depth[size // 2, size // 2] < -24


def test_what_is_seen_into_a_cut_is_no_surface() -> None:
    """A ball without its lower third, cut aslant: from behind one sees into it, and there it goes on as it was."""
    size = 160
    vertices, triangles = ball(size, 30)
    middle = vertices[triangles].mean(1) - [size / 2, size / 2, 0]
    triangles = triangles[middle @ [0, 1, -0.35] < 16]
    front, back = (side_maps(vertices, triangles, (size, size), side) for side in ("front", "back"))
    into = back.mask & (back.normals[..., 2] < 0)
    assert into.sum() > 200
    warp = warp_part(front.mask, front.mask)
    behind = part_surface(front.mask, warp, back, np.ones((size, size, 1), np.float32))
    rows, columns = np.nonzero(front.mask)
    sphere = -np.sqrt(np.maximum(900 - (rows - size / 2) ** 2 - (columns - size / 2) ** 2, 0))
    off = behind.depth[rows, columns] - sphere
    assert np.abs(off).mean() < 2
    assert off.min() > -9, "nothing sticks out behind"


def test_weights_are_carried_along() -> None:
    size = 120
    vertices, triangles = ball(size, 30)
    front = side_maps(vertices, triangles, (size, size), "front")
    upper = (np.arange(size) < size / 2)[:, None] & np.ones(size, bool)
    weights = np.stack([upper, ~upper], -1).astype(np.float32)
    mask = disk(size, 45, 60, 60)
    surface = part_surface(mask, warp_part(mask, front.mask), front, weights)
    assert surface.weights[25, 60, 0] > 0.95
    assert surface.weights[95, 60, 1] > 0.95
    np.testing.assert_allclose(surface.weights[disk(size, 45, 60, 60)].sum(-1), 1, atol=1e-5)


def layer(mask: np.ndarray, depth: float = 8.0) -> Layer:
    inside = np.asarray(cv2.distanceTransform(mask.astype(np.uint8), cv2.DIST_L2, 5))
    sides = [np.where(mask, sign * np.minimum(inside, depth), np.nan).astype(np.float32) for sign in (1, -1)]
    weights = np.zeros((*mask.shape, 52), np.float32)
    weights[..., 0] = 1
    return Layer(mask, *(Surface(side, weights) for side in sides))


@pytest.mark.parametrize("count", [1, 2])
def test_sheets_are_closed_and_end_at_the_masks_edge(count: int) -> None:
    soft = np.clip(20.3 - np.hypot(*(np.mgrid[:64, :64] - 31.5)) + 0.5, 0, 1).astype(np.float32)
    layers = [layer(soft > 0.5), layer(disk(64, 9, 40, 32))][:count]
    mesh = stitch_front_and_back(layers, soft)
    _, point = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    assert is_closed(point.ravel()[mesh.triangles])
    body = mesh.vertices[mesh.layer == 0]
    radius = np.hypot(body[:, 0] - 31.5, body[:, 1] - 31.5).max()
    assert abs(radius - 20.3) < 0.5, "within half a pixel"
    rim = mesh.vertices[mesh.rim & (mesh.layer == 0)]
    mean = np.hypot(rim[:, 0] - 31.5, rim[:, 1] - 31.5).mean()
    assert abs(mean - 20.3) < 0.05, "and in the mean neither larger nor smaller"
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    assert (np.cross(a, b) * c).sum() < 0, "outward for one who looks at a picture whose y points down"


def test_a_waist_of_one_pixel_is_no_pinch() -> None:
    mask = disk(40, 8, 12, 20) | disk(40, 8, 28, 20)
    mask[20, 19:22] = True
    mesh = stitch_front_and_back([layer(mask)], mask.astype(np.float32))
    _, point = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    assert is_closed(point.ravel()[mesh.triangles])


@pytest.mark.parametrize("held", [(), ("LeftHandIndex1", "LeftHandIndex2", "LeftHandIndex3")])
def test_posed_as_pictured_the_vertices_are_where_they_were(held: tuple[str, ...]) -> None:
    """Whether fingers are stretched in T-pose or kept as they are."""
    space, random = load_body_space(), np.random.default_rng(4)
    turns = Rotation.from_rotvec(random.normal(0, 0.3, (len(space.names), 3))).as_matrix()
    fit = Fit(
        random.normal(size=5).astype(np.float32),
        turns.astype(np.float32),
        np.array([0.1, 0.2, -3], np.float32),
        0.0,
        np.zeros(1),
    )
    mesh = stitch_front_and_back([layer(disk(64, 20, 32, 32))], disk(64, 20, 32, 32).astype(np.float32))
    weights = random.uniform(0, 1, (len(mesh.vertices), 4)).astype(np.float32)
    weights = -np.sort(-weights, 1) / weights.sum(1, keepdims=True)
    bones = random.integers(0, 22, (len(mesh.vertices), 4)).astype(np.uint8)
    mesh = replace(mesh, bones=bones, weights=weights)
    camera = PictureCamera(Camera((0, 0, 0), 100.0, (32, 32), (64, 64)), 3.0)
    kept = np.isin(space.names, held)
    fitted = FittedBody(fit, camera.camera, kept)
    nowhere = np.zeros((64, 64), np.bool_)  # where undersides of feet would be hidden
    character = bind(
        mesh, nowhere, camera, fitted, space, np.zeros((4, 4, 3), np.uint8), np.zeros((len(bones), 2), np.float32)
    )
    bound, pictured = character.mesh, character.pictured
    transforms = pose_transforms(bound.skeleton, pictured.rotations, pictured.root)[0]
    posed = skin(bound.vertices, bound.bones, bound.weights, transforms)
    np.testing.assert_allclose(posed, camera.to_metres(mesh.vertices) + character.eye, atol=2e-4)
    assert abs(bound.vertices[:, 1].min()) < 1e-5, "the T-pose stands on the ground"
    plain = FittedBody(fit, camera.camera, np.zeros_like(kept))
    straight = bind(mesh, nowhere, camera, plain, space, bound.texture, bound.uv)
    places = [joint_places(one.mesh.skeleton, one.pictured)[0] for one in (character, straight)]
    np.testing.assert_allclose(*places, atol=1e-4)
    np.testing.assert_allclose(pictured.rotations[0, kept], np.tile([0, 0, 0, 1], (len(held), 1)), atol=1e-6)


def test_what_brings_vertices_back_is_what_their_weights_blend() -> None:
    """Also where blended turns would crush a vertex, and it goes more with one joint: no more than it takes."""
    random = np.random.default_rng(8)
    transforms = np.tile(np.eye(4), (6, 1, 1))
    transforms[:, :3, :3] = Rotation.random(6, random_state=3).as_matrix()
    transforms[:, :3, 3] = random.normal(size=(6, 3))
    bones, posed = random.integers(0, 6, (500, 4)), random.normal(size=(500, 3))
    weights = -np.sort(-random.dirichlet(np.ones(4), 500).astype(np.float32), 1)
    vertices, kept, blended = at_rest(posed, bones, weights, transforms)
    volume = [np.linalg.det(np.einsum("vk,vkij->vij", w, transforms[bones])[:, :3, :3]) for w in (weights, kept)]
    halfway = np.linalg.det((transforms[bones[:, 0]] + transforms[bones[:, 1]])[:, :3, :3] / 2)
    least = np.where(halfway < MIN_VOLUME_RATIO, TARGET_VOLUME_RATIO, MIN_VOLUME_RATIO)
    crushed = volume[0] < least
    assert 50 < crushed.sum() < 450 and 50 < (halfway < MIN_VOLUME_RATIO).sum() < 450
    np.testing.assert_array_equal(kept[~crushed], weights[~crushed])
    assert (volume[1] > least - 1e-5).all() and np.median((volume[1] - least)[crushed]) < 0.02
    np.testing.assert_allclose(kept.sum(1), 1, atol=1e-6)
    np.testing.assert_allclose(
        blended, np.einsum("vk,vkij->vij", kept.astype(np.float64), transforms[bones]), atol=1e-6
    )
    back = np.einsum("vij,vj->vi", blended[:, :3, :3], vertices) + blended[:, :3, 3]
    np.testing.assert_allclose(back, posed, atol=1e-9)


def test_rough_labels_fill_the_mask_and_resemble_the_template() -> None:
    mask = np.zeros((120, 60), np.bool_)
    mask[5:115, 10:50] = True
    template = np.full((120, 60), -1)
    template[10:40, 15:45], template[40:110, 15:45] = BODY_PARTS.index("head"), BODY_PARTS.index("torso")
    found = rough_labels(mask, template)
    assert (found[~mask] == -1).all()
    assert set(np.unique(found[mask])) == {BODY_PARTS.index("head"), BODY_PARTS.index("torso")}
    assert (found[5:35, 10:50] == BODY_PARTS.index("head")).mean() > 0.97
    assert (found[45:115, 10:50] == BODY_PARTS.index("torso")).mean() > 0.97


def test_hair_beside_a_raised_arm_is_the_heads() -> None:
    head, arm = BODY_PARTS.index("head"), BODY_PARTS.index("right_arm")
    template = np.full((200, 200), -1)
    template[40:90, 120:160], template[20:180, 40:56] = head, arm
    labels = np.full((200, 200), -1)
    labels[20:120, 100:180], labels[20:180, 30:100] = (
        head,
        arm,
    )  # the hair reaches as far as the arm, and half of it is its
    rgb = np.full((200, 200, 3), (60, 40, 30), np.uint8)  # hair everywhere
    rgb[40:90, 120:160] = (225, 180, 150)
    rgb[:, :64] = (240, 240, 245)  # a white sleeve, wider than the arm in it
    rgb[130:180, 64:100] = (240, 240, 245)
    rgb = np.clip(rgb + np.random.default_rng(4).normal(0, 4, rgb.shape), 0, 255).astype(np.uint8)
    nothing = np.full(labels.shape, -1)
    found = hair_beside_arms(rgb, labels, template, nothing)
    hair = (labels == arm) & (rgb.mean(-1) < 120)
    assert (found[hair] == head).mean() > 0.95
    assert (found[(labels == arm) & ~hair] == arm).mean() > 0.97
    sure = np.where(hair, arm, -1)  # a hand that is seen there
    np.testing.assert_array_equal(hair_beside_arms(rgb, labels, template, sure), labels)


def test_an_arm_is_one_piece_unless_the_other_passes_before_it() -> None:
    torso, left, right = (BODY_PARTS.index(name) for name in ("torso", "left_arm", "right_arm"))
    labels = np.full((80, 120), torso)
    labels[10:20, 10:60], labels[60:62, 100:102] = left, left  # an arm and a speck
    labels[40:50, 10:60], labels[40:50, 30:36] = right, left  # an arm with the other before it: three pieces
    labels[70:75, 60:90] = right  # a piece aside, more than a quarter of the largest
    nowhere = np.zeros(labels.shape, np.bool_)
    found = without_specks(labels, np.full(labels.shape, -1), nowhere)
    np.testing.assert_array_equal(found == left, (labels == left) & (np.arange(120) < 90))
    np.testing.assert_array_equal(found == right, labels == right)
    hand = np.full(labels.shape, -1)
    hand[42:48, 50:60] = right
    found = without_specks(labels, hand, nowhere)
    assert (found[70:75, 60:90] == torso).all(), "smaller than the piece with the hand"
    assert (found[40:50, 10:30] == right).all()
    shoulder = np.zeros(labels.shape, np.bool_)
    shoulder[68:78, 55:95] = True
    found = without_specks(labels, hand, shoulder)
    assert (found[70:75, 60:90] == right).all(), "at a shoulder whose colours tell it from the trunk"


def test_refined_labels_go_to_where_the_colours_change() -> None:
    rgb = np.zeros((80, 80, 3), np.uint8)
    rgb[:, :46], rgb[:, 46:] = (200, 60, 50), (40, 80, 190)
    rgb = np.clip(rgb + np.random.default_rng(0).normal(0, 6, rgb.shape), 0, 255).astype(np.uint8)
    rough = np.where(np.arange(80) < 40, BODY_PARTS.index("torso"), BODY_PARTS.index("left_arm"))[None].repeat(80, 0)
    occlusion = np.zeros((80, 80), np.bool_)
    occlusion[10:70, 30:52] = True
    found = refined_labels(rgb, rough, occlusion, rough)
    assert (found[12:68, 30:46] == BODY_PARTS.index("torso")).mean() > 0.99
    assert (found[12:68, 46:52] == BODY_PARTS.index("left_arm")).mean() > 0.99
    assert (found[~occlusion] == rough[~occlusion]).all()


def test_refined_labels_stay_where_too_little_is_left_to_refine_them_again() -> None:
    """A red square among blue: it alone keeps its label, and has too few pixels for a second look at its colours."""
    rng = np.random.default_rng(0)
    red = np.zeros((80, 80), np.bool_)
    red[38:44, 38:44] = True
    rgb = np.where(red[..., None], (200, 50, 40), (60, 80, 160)) + rng.normal(0, 6, (80, 80, 3))
    rough = np.full((80, 80), BODY_PARTS.index("torso"))
    rough[28:54, 28:54] = BODY_PARTS.index("left_arm")
    occlusion = np.zeros_like(red)
    occlusion[15:-15, 15:-15] = True
    nowhere = np.full_like(rough, -1)
    found = refined_labels(np.clip(rgb, 0, 255).astype(np.uint8), rough, occlusion, nowhere)
    np.testing.assert_array_equal(found == BODY_PARTS.index("left_arm"), red)


def test_a_sleeve_before_a_trunk_of_the_same_cloth_stays_the_arms_and_its_hand_is_found() -> None:
    """The arm's mixture of colours is of cloth and skin, the trunk's of cloth alone: cloth is likelier to be the trunk's. The
    template's arm is where the sleeve is, and six pixels beside the hand."""
    torso, arm = BODY_PARTS.index("torso"), BODY_PARTS.index("left_arm")
    across, down = np.meshgrid(np.arange(100), np.arange(160))
    sleeve, hand = (across >= 70) & (down < 120), (across >= 64) & (down >= 120)
    rgb = np.where(hand[..., None], (215, 165, 140), (40, 44, 70))
    rgb = np.clip(rgb + np.random.default_rng(2).normal(0, 5, rgb.shape), 0, 255).astype(np.uint8)
    template = np.where(across >= 70, arm, torso)
    occlusion = (across >= 55) & (across < 88)
    found = refined_labels(rgb, template, occlusion, template)
    assert ((found == arm) == (sleeve | hand)).mean() > 0.99


def test_the_body_is_completed_behind_an_arm() -> None:
    """A square whose lower right corner an arm hides: the template's corner comes back."""
    template = np.zeros((100, 100), np.bool_)
    template[20:80, 20:80] = True
    arm = np.zeros_like(template)
    arm[60:90, 60:95] = True
    visible = template & ~arm
    near = np.asarray(cv2.dilate(arm.astype(np.uint8), np.ones((5, 5), np.uint8))) > 0
    found = completed(visible, arm, near, template)
    assert (found & visible).sum() == visible.sum()
    assert ((found ^ template).sum()) < 0.02 * template.sum()
    assert not (found & ~(template | arm)).any()


def test_colours_are_continued_beyond_the_mask() -> None:
    rgb = np.zeros((40, 40, 3), np.uint8)
    rgb[:, :20] = (200, 10, 10)
    own = np.zeros((40, 40), np.bool_)
    own[:, :20] = True
    found = continued_colours(rgb, own)
    assert np.abs(found.astype(int) - [200, 10, 10]).max() <= 1
