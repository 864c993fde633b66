"""A character of two surfaces, of the template itself in its own outline: what it is as pictured, and what joints show as they bend."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import GRID_HEIGHT_PIXELS, Silhouette
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.hybrid.cut_off import cut_off
from engine.character.hybrid.hybrid import Hybrid, limbs_alone, make_hybrid
from engine.character.hybrid.joined_characters import joined
from engine.character.hybrid.limbs import limbs_of
from engine.character.hybrid.outline_warp import drawn_to_the_outline
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, HEAD_LABEL, LEG_LABELS
from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character, bind
from engine.character.rig.shell_binding import bind_shell
from engine.character.shell.template_mesh import template_mesh
from engine.character.stages import make_hybrid_character
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.mesh.welding import is_closed, weld
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms
from engine.render.rasterisation.rasteriser import rasterise
from tests.character.fit.test_head_and_legs import figure_with
from tests.character.shell.test_displacement import arms_down

SIZE = (GRID_HEIGHT_PIXELS + 80, 420)
PIXELS_PER_METRE = 150.0
"""Of what is drawn to be compared."""
AROUND = 0.12
"""Metres around a joint within which gaps are looked for."""


def figure_and_outline() -> tuple[Figure, FittedBody, Silhouette, Labels]:
    """The template with its arms down, `GRID_HEIGHT_PIXELS` pixels high, in a green picture."""
    fitted, mesh = arms_down(), template_mesh()
    seen = pose_template(fitted, fitted.picture_camera(), load_human()).vertices[mesh.ids]
    scale = GRID_HEIGHT_PIXELS / np.ptp(seen[:, 1])
    middle = (seen.min(0) + seen.max(0)) / 2
    to_grid = np.array([[scale, 0, SIZE[1] / 2 - scale * middle[0]], [0, scale, SIZE[0] / 2 - scale * middle[1]]])
    places = seen * scale + [to_grid[0, 2], to_grid[1, 2], 0]
    triangle = rasterise(places * [1, 1, -1], mesh.triangles, SIZE).triangle
    labels = np.where(triangle >= 0, mesh.parts.argmax(1)[mesh.triangles[triangle, 0]], -1).astype(np.int8)
    mask = labels >= 0
    figure = figure_with(None)
    alpha = cv2.warpAffine(mask.astype(np.float32), to_grid, (600, 800), flags=cv2.WARP_INVERSE_MAP)
    rgb = np.full((*SIZE, 3), [0, 200, 0], np.uint8)
    silhouette = Silhouette(alpha, mask.astype(np.float32), mask, rgb, to_grid)
    nowhere = np.zeros(SIZE, np.bool_)
    return (
        figure,
        fitted,
        silhouette,
        Labels(labels, nowhere, np.zeros(0, np.int8), nowhere, np.full(SIZE, -1, np.int8)),
    )


@pytest.fixture(scope="module")
def made() -> tuple[Hybrid, Character, Character]:
    """Both surfaces, the character of both, red limbs and a blue trunk, and that of the whole shell."""
    figure, fitted, silhouette, labels = figure_and_outline()
    hybrid = make_hybrid(figure, silhouette, fitted, labels)
    red, blue = (np.full((64, 64, 3), colour, np.uint8) for colour in ((250, 0, 0), (0, 0, 250)))
    figure = replace(figure, rgb=np.zeros((800, 600, 3), np.uint8))
    whole, limbs = (bind_shell(one, figure, silhouette, fitted, red) for one in (hybrid.shell, limbs_alone(hybrid)))
    trunk, camera = hybrid.trunk, silhouette.camera(fitted.picture_camera())
    uv = np.full((len(trunk.vertices), 2), 0.5, np.float32)
    relief = bind(trunk, silhouette.mask, camera, fitted, load_human().space, blue, uv)
    return hybrid, joined(limbs, relief), whole


def turned(character: Character, joint: str, axis: str, degrees: float) -> Clip:
    """As it is pictured, but for one joint."""
    pictured = character.pictured
    rotations = pictured.rotations.copy()
    at = character.mesh.skeleton.index(joint)
    turn = Rotation.from_euler(axis, degrees, degrees=True) * Rotation.from_quat(rotations[0, at])
    rotations[0, at] = turn.as_quat()
    return replace(pictured, rotations=rotations)


def on_screen(places: NDArray[np.floating], side: bool) -> NDArray[np.float64]:
    """Places (V, 3) in a picture (500, 400), seen from the front or from a side, along parallel rays."""
    seen = places[:, [2, 1, 0]] * [-1, 1, 1] if side else places
    return np.asarray(np.array([200, 400, 0]) + PIXELS_PER_METRE * seen * [1, -1, -1], np.float64)


def drawn(mesh: SkinnedMesh, places: NDArray[np.floating], side: bool) -> NDArray[np.bool_]:
    return np.asarray(rasterise(on_screen(places, side), mesh.triangles, (500, 400)).triangle >= 0)


def test_as_pictured_it_fills_its_outline(made: tuple[Hybrid, Character, Character]) -> None:
    hybrid, character, whole = made
    cover = [drawn(one.mesh, pose(one, one.pictured), False) for one in (character, whole)]
    assert (cover[0] & cover[1]).sum() > 0.98 * (cover[0] | cover[1]).sum()
    own = np.zeros(hybrid.labels.labels.shape, np.bool_)
    for vertices, triangles in (
        (hybrid.trunk.vertices, hybrid.trunk.triangles),
        (hybrid.shell.pictured, limbs_alone(hybrid).mesh.triangles),
    ):
        own |= rasterise(vertices * [1, 1, -1], triangles, own.shape).triangle >= 0
    mask = hybrid.labels.labels >= 0
    assert (own & mask).sum() > 0.98 * (own | mask).sum()


def test_it_is_closed_and_its_weights_sum_to_one(made: tuple[Hybrid, Character, Character]) -> None:
    mesh = made[1].mesh
    assert is_closed(weld(mesh)[mesh.triangles])
    np.testing.assert_allclose(mesh.weights.sum(1), 1, atol=1e-5)
    assert abs(mesh.vertices[:, 1].min()) < 1e-5, "it stands on the ground"


def test_beyond_the_edge_of_the_picture_nothing_is_made_up(made: tuple[Hybrid, Character, Character]) -> None:
    hybrid, _, _ = made
    mesh, pictured = hybrid.shell.mesh, hybrid.shell.pictured
    within = pictured[:, 1] < np.percentile(pictured[:, 1], 60)
    cut = limbs_of(mesh, pictured, hybrid.labels, arms_down(), within)
    assert (cut.limb[~within] == -1).all() and (cut.limb == hybrid.limbs.limb)[within].all()
    assert is_closed(cut_off(mesh, cut).triangles)


def test_limbs_are_the_shells_and_the_trunk_has_none(made: tuple[Hybrid, Character, Character]) -> None:
    hybrid = made[0]
    part, shown = hybrid.shell.mesh.parts, hybrid.limbs.limb >= 0
    assert shown[part[:, [*ARM_LABELS, *LEG_LABELS]].max(1) > 0.9].all()
    seen = hybrid.trunk.pixels(np.arange(len(hybrid.trunk.vertices)), hybrid.labels.labels.shape)
    far = cv2.distanceTransform((~np.isin(hybrid.labels.labels, [0, 1])).astype(np.uint8), cv2.DIST_L2, 5)
    assert far[seen].max() < 7, "but for what goes on behind them, and a smooth border"


@pytest.mark.parametrize(
    ("joint", "axis"), [("LeftArm", "z"), ("RightArm", "x"), ("LeftUpLeg", "x"), ("RightUpLeg", "z")]
)
@pytest.mark.parametrize("degrees", [-60, -30, 30, 60])
def test_as_a_joint_bends_there_is_no_gap(
    made: tuple[Hybrid, Character, Character], joint: str, axis: str, degrees: float
) -> None:
    """Wherever the whole shell is, which has no seam, the two surfaces are."""
    _, character, whole = made
    clip = turned(character, joint, axis, degrees)
    skeleton = character.mesh.skeleton
    at = pose_transforms(skeleton, clip.rotations, clip.root)[0, skeleton.index(joint)]
    place = at[:3, :3] @ skeleton.heads[skeleton.index(joint)] + at[:3, 3]
    for side in (False, True):
        x, y = on_screen(place[None], side)[0, :2]
        near = np.hypot(*(np.indices((500, 400)) - np.array([y, x])[:, None, None])) < AROUND * PIXELS_PER_METRE
        own, all_of_it = (drawn(one.mesh, pose(one, clip), side) for one in (character, whole))
        bare = cv2.erode((all_of_it & ~own & near).astype(np.uint8), np.ones((3, 3), np.uint8))
        assert bare.sum() == 0, f"{joint} turned by {degrees} about {axis}"


def test_each_surface_keeps_its_colours(made: tuple[Hybrid, Character, Character]) -> None:
    hybrid, character, _ = made
    mesh, limbs = character.mesh, len(limbs_alone(hybrid).mesh.corners)
    height, width = mesh.texture.shape[:2]
    x, y = np.clip(np.rint(mesh.uv * [width, height] - 0.5).astype(int), 0, [width - 1, height - 1]).T
    colours = mesh.texture[y, x]
    assert (colours[:limbs] == [250, 0, 0]).all() and (colours[limbs:] == [0, 0, 250]).all()


def test_limbs_are_drawn_to_the_outline(made: tuple[Hybrid, Character, Character]) -> None:
    """An outline two pixels further to the right: arms go there, and nothing is torn."""
    hybrid = made[0]
    mesh, pictured, limbs = hybrid.shell.mesh, hybrid.shell.pictured, hybrid.limbs
    mask = cv2.GaussianBlur((hybrid.labels.labels >= 0).astype(np.float32), (0, 0), 1)
    beside = np.roll(mask, 2, 1)
    triangles = limbs_alone(hybrid).mesh.triangles
    moved = drawn_to_the_outline(pictured, limbs, triangles, hybrid.trunk, beside) - pictured
    forearms = (limbs.limb >= 0) & ~limbs.overlap & (np.abs(pictured[:, 0] - SIZE[1] / 2) > 60)
    x, y, z = moved[forearms].mean(0)
    assert 1.2 < x < 2.2 and abs(y) < 0.3 and z == 0
    assert (moved[limbs.limb < 0] == 0).all() and (moved[:, 2] == 0).all()
    edges = mesh.triangles[:, [0, 1]][((limbs.limb >= 0) & ~limbs.overlap)[mesh.triangles].all(1)]
    assert np.abs(moved[edges[:, 0]] - moved[edges[:, 1]]).max() < 2.5, "pixels between neighbours"


def test_what_is_held_draws_no_limb_to_its_outline(made: tuple[Hybrid, Character, Character]) -> None:
    """The same outline, all of which is that of something held."""
    hybrid = made[0]
    mask = cv2.GaussianBlur((hybrid.labels.labels >= 0).astype(np.float32), (0, 0), 1)
    held = np.where(cv2.dilate(mask, np.ones((15, 15))) > 0, ARM_LABELS[0], -1).astype(np.int8)
    pictured, triangles = hybrid.shell.pictured, limbs_alone(hybrid).mesh.triangles
    moved = drawn_to_the_outline(pictured, hybrid.limbs, triangles, hybrid.trunk, np.roll(mask, 2, 1), held)
    np.testing.assert_array_equal(moved, pictured)


def test_at_shoulders_the_trunk_ends_beneath_the_shell(made: tuple[Hybrid, Character, Character]) -> None:
    """Where an arm is cut from it, the trunk's front is behind the arm's, so that its border is no step."""
    hybrid = made[0]
    shape = hybrid.labels.labels.shape
    arms = np.isin(hybrid.labels.labels, ARM_LABELS)
    shell, trunk = (
        -rasterise(vertices * [1, 1, -1], triangles, shape).depth
        for vertices, triangles in (
            (hybrid.shell.pictured, limbs_alone(hybrid).mesh.triangles),
            (hybrid.trunk.vertices, hybrid.trunk.triangles),
        )
    )
    beside = cv2.dilate(arms.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    at = hybrid.at_shoulders() & beside & np.isfinite(shell) & np.isfinite(trunk)
    assert at.sum() > 20 and (shell > trunk)[at].mean() > 0.9


def test_hair_before_a_shoulder_is_no_colour_of_the_body_s() -> None:
    """Grey all over, and red hair down to the chest."""
    figure, fitted, silhouette, labels = figure_and_outline()
    hybrid = make_hybrid(figure, silhouette, fitted, labels)
    arm = labels.labels == ARM_LABELS[0]
    top, side = int(np.flatnonzero(arm.any(1))[0]), int(np.flatnonzero(arm.any(0))[0])
    hair = np.zeros(SIZE, np.bool_)
    hair[top - 20 : top + 30, side - 25 : side + 12] = True
    hair &= labels.labels >= 0
    held = np.where(hair, HEAD_LABEL, -1).astype(np.int8)
    own = replace(hybrid.labels, labels=np.where(hair, -1, hybrid.labels.labels).astype(np.int8), held=held)
    hybrid = replace(hybrid, labels=own)
    body = hair & (labels.labels != HEAD_LABEL)
    np.testing.assert_array_equal(hybrid.before_the_body(labels), body)
    to_picture = cv2.warpAffine(
        hair.astype(np.float32), silhouette.to_grid, (600, 800), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    )
    rgb = np.where(to_picture[..., None] > 0.5, (200, 20, 20), (120, 120, 120)).astype(np.uint8)
    figure = replace(figure, rgb=rgb)
    character = make_hybrid_character(figure, silhouette, fitted, labels, hybrid, 60_000, "see_through")
    mesh = character.mesh
    texel = np.rint(mesh.uv * np.array(mesh.texture.shape[1::-1]) - 0.5).astype(int)
    x, y = np.clip(texel, 0, np.array(mesh.texture.shape[1::-1]) - 1).T
    red, green, _ = mesh.texture[y, x].astype(int).T
    behind = vertex_normals(pose(character, character.pictured), mesh.triangles)[:, 2] < -0.3
    shoulder = [mesh.skeleton.names.index(f"Left{name}") for name in ("Shoulder", "Arm")]
    behind &= np.isin(mesh.bones[:, 0], shoulder)
    assert behind.sum() > 100 and (red - green > 12)[behind].mean() < 0.03
