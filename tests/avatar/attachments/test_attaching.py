"""What stands off the template's body becomes a piece of its own, if silhouettes show it, and nothing else does."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine.avatar.acting import standing_clip
from engine.avatar.attachments.attaching import Sighting, attachments, body_surface, standing_points
from engine.avatar.mesh import AVATAR_PARTS, skinned_mesh, surface_of, wearing
from engine.avatar.registration.models import HumanModels, load_models
from engine.avatar.registration.rigging import Pose
from engine.avatar.texture.template_surface import template_surface
from engine.avatar.worn import Attachments, no_attachments
from engine.body.rest_pose import t_pose
from engine.geometry.camera import Camera
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.rigging.skinning import skin
from engine.geometry.texture_charts.atlas_room import cells_of
from engine.motion.kinematics import pose_transforms
from engine.render.rasterisation.rasteriser import rasterise

BRIM_WIDTH, BRIM_THICKNESS = 0.06, 0.005
"""Metres from the head to the brim's rim, and from its upper side to its lower."""
NEAR_VIEWS, FAR_VIEWS = 24, 6
"""Around the head and shoulders; and around all of the person, without which what no other sees were as large as it may be."""

Mesh = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Hatted:
    """A person of the template in T-pose, `vertices` (V, 3), with a flat brim: its middle and radii, its points and its mesh."""

    vertices: np.ndarray
    middle: np.ndarray
    outer: float
    points: np.ndarray
    brim: Mesh


@pytest.fixture(scope="module")
def human() -> HumanModels:
    return load_models()


@pytest.fixture(scope="module")
def hatted(human: HumanModels) -> Hatted:
    template, rig = human.template, human.rig
    vertices = t_pose(rig, template.vertices, template.vertices_of("body"))[2].astype(np.float64)
    body = vertices[human.skin.vertices]
    head = body[human.skin.regions["head"]]
    level = head[:, 1].max() - 0.06
    band = head[np.abs(head[:, 1] - level) < 0.012]
    middle = np.array([0, level, (band[:, 2].min() + band[:, 2].max()) / 2])
    inner = np.linalg.norm((band - middle)[:, [0, 2]], axis=1).min()
    outer = np.linalg.norm((band - middle)[:, [0, 2]], axis=1).max() + BRIM_WIDTH
    random = np.random.default_rng(5)
    turn, radius = random.uniform(0, 2 * np.pi, 30_000), np.sqrt(random.uniform(inner**2, outer**2, 30_000))
    flat = np.stack([radius * np.sin(turn), random.normal(0, 0.002, len(turn)), radius * np.cos(turn)], 1)
    around = np.linspace(0, 2 * np.pi, 73)[:-1]
    rim = np.stack([np.sin(around), 0 * around, np.cos(around)], 1)
    half = np.array([0, BRIM_THICKNESS / 2, 0])
    rings = ((inner - 0.02) * rim + half, outer * rim + half, outer * rim - half, (inner - 0.02) * rim - half)
    places = np.concatenate(rings)
    k, following = np.arange(72), (np.arange(72) + 1) % 72
    triangles = np.concatenate(
        [
            np.stack(corners, 1)
            for ring in range(3)
            for corners in (
                (k + 72 * ring, k + 72 * ring + 72, following + 72 * ring),
                (following + 72 * ring, k + 72 * ring + 72, following + 72 * ring + 72),
            )
        ]
    )
    return Hatted(vertices, middle, float(outer), middle + flat, (middle + places, triangles.astype(np.int32)))


def cloud_of(human: HumanModels, vertices: np.ndarray, more: np.ndarray) -> PointCloud:
    """The skin's vertices, and more points that face up."""
    skin_points = vertices[human.skin.vertices]
    normals = np.concatenate([vertex_normals(skin_points, human.skin.triangles), np.tile([0, 1.0, 0], (len(more), 1))])
    points = np.concatenate([skin_points, more])
    return PointCloud(points.astype(np.float32), normals.astype(np.float32), np.zeros(points.shape, np.uint8))


def seen(human: HumanModels, vertices: np.ndarray, worn: Mesh | None) -> tuple[list[np.ndarray], list[Camera]]:
    """The silhouettes of the skin, with what is worn or without."""
    lens = Camera((0, 0, 0), 900.0, (119.5, 199.5), (400, 240))
    places, triangles = vertices[human.skin.vertices], human.skin.triangles
    if worn is not None:
        triangles = np.concatenate([triangles, worn[1] + np.int32(len(places))])
        places = np.concatenate([places, worn[0]])
    cameras, masks = [], []
    turns = np.concatenate([2 * np.pi * np.arange(count) / count for count in (NEAR_VIEWS, FAR_VIEWS)])
    for turn, away, level in zip(
        turns, [3.0] * NEAR_VIEWS + [9.0] * FAR_VIEWS, [1.35] * NEAR_VIEWS + [0.9] * FAR_VIEWS, strict=True
    ):
        camera = lens.aimed((away * np.sin(turn), 1.9, away * np.cos(turn)), (0, level, 0))
        cameras.append(camera)
        masks.append(rasterise(camera.project(places), triangles, camera.size, perspective=True).triangle >= 0)
    return masks, cameras


@pytest.fixture(scope="module")
def found(human: HumanModels, hatted: Hatted) -> Attachments:
    cloud = cloud_of(human, hatted.vertices, hatted.points)
    return attachments(human, hatted.vertices, Sighting(cloud, *seen(human, hatted.vertices, hatted.brim)))


def test_a_brim_is_a_thin_piece_as_wide_as_it_is(hatted: Hatted, found: Attachments) -> None:
    off = found.vertices - hatted.middle
    radius = np.linalg.norm(off[:, [0, 2]], axis=1)
    assert radius.max() == pytest.approx(hatted.outer, abs=0.012)
    sides = np.histogram(np.arctan2(off[radius > hatted.outer - 0.015, 0], off[radius > hatted.outer - 0.015, 2]), 12)[
        0
    ]
    assert sides.min() > 0, "it goes all around"
    standing = off[radius > hatted.outer - 0.04]
    assert 0.003 < np.ptp(standing[:, 1]) < 0.02


def test_the_points_of_the_brim_and_of_its_root_are_those_that_stand_off(human: HumanModels, hatted: Hatted) -> None:
    cloud = cloud_of(human, hatted.vertices, hatted.points)
    off = standing_points(human, hatted.vertices, Sighting(cloud, *seen(human, hatted.vertices, hatted.brim)))
    assert np.abs(off[:, 1] - hatted.middle[1]).max() < 0.05
    radius = np.linalg.norm((off - hatted.middle)[:, [0, 2]], axis=1)
    assert radius.max() > hatted.outer - 0.01
    face = hatted.vertices[human.skin.vertices[human.skin.face_points[36:]]]
    assert cKDTree(off).query(face)[0].min() > 0.005, "the face is the skin's"


def test_the_piece_of_a_brim_has_the_crown_that_it_encloses(
    human: HumanModels, hatted: Hatted, found: Attachments
) -> None:
    body = body_surface(human, hatted.vertices)
    crown = body.vertices[body.vertices[:, 1] > body.vertices[:, 1].max() - 0.02]
    over = closest_points(crown, found.vertices, found.triangles)
    assert over.distance.max() < 0.008
    assert found.vertices[:, 1].max() > crown[:, 1].max()
    assert found.vertices[:, 1].min() > body.vertices[human.skin.face_points[8], 1], "and no chin"


def test_it_turns_with_the_head_alone(human: HumanModels, found: Attachments) -> None:
    assert (found.bones[:, 0] == human.rig.index("Head")).all() and (found.weights[:, 0] == 1).all()


def test_its_charts_lie_beside_the_template_s(human: HumanModels, found: Attachments) -> None:
    taken = cells_of(template_surface(human.template, human.rig).atlas)
    assert not (cells_of(found.atlas) & taken).any()
    assert len(found.atlas.corners) == len(found.triangles)


def test_points_that_no_silhouette_shows_are_no_piece(human: HumanModels, hatted: Hatted) -> None:
    cloud = cloud_of(human, hatted.vertices, hatted.points)
    bare = attachments(human, hatted.vertices, Sighting(cloud, *seen(human, hatted.vertices, None)))
    assert not len(bare.triangles)


def test_eyes_and_mouth_are_of_the_face_that_stays_free_and_the_crown_is_not(
    human: HumanModels, hatted: Hatted
) -> None:
    body = body_surface(human, hatted.vertices)
    assert body.face[human.skin.face_points[36:]].all()
    assert not body.face[body.vertices[:, 1].argmax()]


def test_nothing_is_worn_beside_arms_where_silhouettes_fill_the_gap_to_the_trunk(
    human: HumanModels, hatted: Hatted
) -> None:
    body = body_surface(human, hatted.vertices)
    strongest = human.skin.bones[:, 0]
    for bone in ("LeftArm", "LeftForeArm", "RightArm", "RightForeArm"):
        arm = strongest == human.rig.index(bone)
        assert arm.sum() > 50 and body.own[arm].all()
    assert not body.own[human.skin.regions["head"]].any()


def test_in_the_pose_of_the_film_it_is_where_it_was_measured(
    human: HumanModels, hatted: Hatted, found: Attachments
) -> None:
    rig, surface = human.rig, surface_of(human.template)
    skeleton, _, rest = t_pose(rig, human.template.vertices, human.template.vertices_of("body"))
    turn = np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1.0]])
    rotations = np.tile(turn, (len(rig.names), 1, 1))
    joints = skeleton.heads @ turn.T + [0.1, 0.2, 0.3]
    mesh = skinned_mesh(surface, rig, skeleton, rest, np.zeros((8, 8, 3), np.uint8))
    worn = Attachments(
        found.vertices @ turn.T + [0.1, 0.2, 0.3], found.triangles, found.atlas, found.bones, found.weights
    )
    whole = wearing(mesh, worn, Pose(joints, rotations))
    clip = standing_clip(whole, rotations, joints[0], 30.0)
    posed = skin(whole.vertices, whole.bones, whole.weights, pose_transforms(skeleton, clip.rotations, clip.root)[0])
    corners = posed[whole.triangles[len(mesh.triangles) :]]
    assert corners == pytest.approx(worn.vertices[worn.triangles], abs=1e-4)
    assert whole.uv[whole.triangles[len(mesh.triangles) :]] == pytest.approx(found.atlas.uv[found.atlas.corners])


def test_the_surface_that_is_textured_has_it_and_without_anything_is_as_before(
    human: HumanModels, found: Attachments
) -> None:
    bare = template_surface(human.template, human.rig)
    worn = bare.wearing(found)
    assert len(worn.triangles) == len(bare.triangles) + len(found.triangles)
    fitted = worn.fitted(worn.rest)
    assert fitted.stitched[len(bare.triangles) :].all()
    assert {part: int(worn.of(part).sum()) for part in AVATAR_PARTS} == {
        part: int(bare.of(part).sum()) for part in AVATAR_PARTS
    }
    assert len(bare.wearing(no_attachments()).triangles) == len(bare.triangles)
