"""Arms stop at their own body: at a trunk that is a round pillar it is known where that is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from humanoids import build_skeleton
from numpy.typing import NDArray

from engine.geometry.rigging.half_joints import with_half_joints
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion import rotation
from engine.motion.arms.arms_outside import arms_outside
from engine.motion.arms.solid_body import solid_body
from engine.motion.clip import Clip
from engine.motion.kinematics import joint_places, world_rotations

FRAME_COUNT = 40


def pillar_with_arms(radius: float, top: float = 1.3) -> SkinnedMesh:
    """A trunk that is an upright pillar about the origin, moved by the hips, and arms that are pegs around their bones."""
    skeleton = build_skeleton()
    turns, heights = np.meshgrid(np.arange(48) * 2 * np.pi / 48, np.linspace(0.3, top, 41))
    trunk = np.stack([radius * np.sin(turns), heights, radius * np.cos(turns)], -1).reshape(-1, 3)
    low = (np.arange(40)[:, None] * 48 + np.arange(48)).ravel()
    beside = (np.arange(40)[:, None] * 48 + (np.arange(48) + 1) % 48).ravel()
    triangles = np.concatenate([np.stack([low, beside, beside + 48], 1), np.stack([low, beside + 48, low + 48], 1)])
    vertices, bones = [trunk], [np.full(len(trunk), skeleton.index("Hips"))]
    for side in ("Left", "Right"):
        for bone, end in (("ForeArm", "Hand"), ("Hand", "HandMiddle3")):
            a, b = (skeleton.heads[skeleton.index(side + name)] for name in (bone, end))
            around = [0.02 * np.array([0, np.cos(t), np.sin(t)]) for t in np.arange(8) * np.pi / 4]
            vertices.append(np.concatenate([a + (b - a) * share + around for share in np.linspace(0, 1, 9)]))
            bones.append(np.full(72, skeleton.index(side + bone)))
    joints = np.zeros((sum(map(len, vertices)), 4), np.uint8)
    joints[:, 0] = np.concatenate(bones)
    return SkinnedMesh(
        skeleton=skeleton,
        vertices=np.concatenate(vertices).astype(np.float32),
        triangles=triangles.astype(np.int32),
        uv=np.zeros((len(joints), 2), np.float32),
        bones=joints,
        weights=np.tile(np.array([1, 0, 0, 0], np.float32), (len(joints), 1)),
        texture=np.zeros((2, 2, 3), np.uint8),
    )


def hanging(
    skeleton: Skeleton, degrees: NDArray[np.floating], elbow: float = 20.0, loops: bool = False, swing: float = 0.0
) -> Clip:
    """The left arm hangs at these degrees (F,) from straight down, swung forward by others, the elbow bent forward, the palm
    inwards; the right one is stretched out."""
    rotations = rotation.identity(len(degrees), len(skeleton.names))
    rotations[:, skeleton.index("LeftArm")] = rotation.multiply(
        rotation.about("x", -np.radians(swing)), rotation.about("z", np.radians(degrees - 90))
    )
    bend = np.full(len(degrees), -np.radians(elbow))
    rotations[:, skeleton.index("LeftForeArm")] = rotation.about("y", bend)
    root = np.tile(skeleton.heads[:1], (len(degrees), 1))
    return Clip("hang", 30.0, rotations.astype(np.float32), root.astype(np.float32), loops)


def from_pillar(mesh: SkinnedMesh, clip: Clip) -> NDArray[np.float64]:
    """(F, P) metres from the pillar's axis of the points around elbow, wrist and hand of the left arm, less the pegs' radius."""
    names = ("LeftForeArm", "LeftHand", "LeftHandMiddle1", "LeftHandMiddle3")
    places = joint_places(mesh.skeleton, clip)[:, [mesh.skeleton.index(name) for name in names]]
    return np.asarray(np.hypot(places[..., 0], places[..., 2]) - 0.02)


@pytest.mark.parametrize("radius", [0.2, 0.24, 0.28])
def test_hands_and_forearms_stop_at_the_surface(radius: float) -> None:
    mesh = pillar_with_arms(radius)
    clip = hanging(mesh.skeleton, np.full(FRAME_COUNT, 2.0))
    assert from_pillar(mesh, clip).min() < radius - 0.02
    outside = from_pillar(mesh, arms_outside(solid_body(mesh), clip))
    assert (outside.min(1) > radius - 0.005).all()
    assert (outside.min(1) < radius + 0.01).all(), "no further than to the surface"


def test_where_nothing_touches_nothing_changes() -> None:
    mesh = pillar_with_arms(0.2)
    body = solid_body(mesh)
    away = hanging(mesh.skeleton, np.full(FRAME_COUNT, 30.0))
    assert arms_outside(body, away) is away
    touches = hanging(mesh.skeleton, np.where(np.arange(FRAME_COUNT) == 24, 2.0, 30.0))
    mended = arms_outside(body, touches)
    assert (mended.rotations[24] != touches.rotations[24]).any()
    assert (mended.rotations[:10] == touches.rotations[:10]).all()
    right = [joint for joint, name in enumerate(mesh.skeleton.names) if not name.startswith("Left")]
    assert (mended.rotations[:, right] == touches.rotations[:, right]).all()
    assert (mended.root == touches.root).all()


def test_a_hand_keeps_how_it_is_turned_in_the_world() -> None:
    mesh = pillar_with_arms(0.26)
    clip = hanging(mesh.skeleton, np.full(FRAME_COUNT, 2.0))
    mended = arms_outside(solid_body(mesh), clip)
    before, after = (world_rotations(mesh.skeleton.parents, one.rotations) for one in (clip, mended))
    hand = [joint for joint, name in enumerate(mesh.skeleton.names) if name.startswith("LeftHand")]
    turned = rotation.multiply(rotation.inverse(before[:, hand]), after[:, hand])
    assert rotation.angle(turned).max() < 1e-3


def test_an_arm_is_on_its_way_before_it_touches() -> None:
    """Of an arm that swings in slowly and out again the steps differ from one to the next by less than 4 mm, quaternions by little."""
    mesh = pillar_with_arms(0.24)
    clip = hanging(mesh.skeleton, 15 + 13 * np.cos(np.linspace(0, 2 * np.pi, FRAME_COUNT)))
    mended = arms_outside(solid_body(mesh), clip)
    hand = joint_places(mesh.skeleton, mended)[:, mesh.skeleton.index("LeftHand")]
    assert np.linalg.norm(np.diff(hand, n=2, axis=0), axis=1).max() < 0.004
    assert np.abs(np.diff(mended.rotations, axis=0)).max() < 0.1
    assert from_pillar(mesh, mended).min() > 0.24 - 0.01


def test_a_loop_stays_one() -> None:
    """A loop begun at another of its frames is the same loop."""
    mesh = pillar_with_arms(0.24)
    body = solid_body(mesh)
    phase = np.arange(FRAME_COUNT) * 2 * np.pi / FRAME_COUNT
    clip = hanging(mesh.skeleton, 15 + 13 * np.cos(phase), loops=True)
    later = replace(clip, rotations=np.roll(clip.rotations, 7, axis=0))
    mended, again = arms_outside(body, clip), arms_outside(body, later)
    assert (mended.rotations != clip.rotations).any()
    assert np.roll(mended.rotations, 7, axis=0) == pytest.approx(again.rotations, abs=1e-5)


def test_an_arm_that_is_nearly_straight_is_swung_and_not_bent() -> None:
    mesh = pillar_with_arms(0.24)
    clip = hanging(mesh.skeleton, np.full(FRAME_COUNT, 2.0), elbow=8.0)
    mended = arms_outside(solid_body(mesh), clip)
    elbow = mesh.skeleton.index("LeftForeArm")
    bent = np.degrees(rotation.angle(mended.rotations[:, elbow]))
    assert (from_pillar(mesh, mended) > from_pillar(mesh, clip) + 0.02).any()
    assert bent == pytest.approx(8.0, abs=4.0)


def test_a_hand_is_laid_on_with_its_palm_and_does_not_slip_off() -> None:
    """Where the surface faces between where the palm faces and sideways, the hand goes the way of the palm, mostly."""
    mesh = pillar_with_arms(0.28, top=1.0)
    clip = hanging(mesh.skeleton, np.full(FRAME_COUNT, 2.0), elbow=5.0, swing=35.0)
    mended = arms_outside(solid_body(mesh), clip)
    wrist = mesh.skeleton.index("LeftHand")
    before, after = (joint_places(mesh.skeleton, one)[0, wrist] for one in (clip, mended))
    assert before[0] < before[2], "the surface there faces ahead more than aside"
    way = after - before
    assert way[0] > 2 * abs(way[2])


def test_a_clip_that_ends_as_it_begins_still_does() -> None:
    """With the arm in the trunk just after its beginning alone, what spreads that over time is not the same at both ends."""
    mesh = pillar_with_arms(0.25)
    degrees = np.full(FRAME_COUNT, 60.0)
    degrees[3:10] = 5.0
    clip = hanging(mesh.skeleton, degrees)
    found = arms_outside(solid_body(mesh), clip)
    assert found is not clip and len(found.rotations) == FRAME_COUNT
    assert np.abs(found.rotations[0] - clip.rotations[0]).max() > 1e-3, "the arm is on its way already"
    np.testing.assert_allclose(found.rotations[-1], found.rotations[0], atol=1e-6)


def test_arms_go_outside_where_half_joints_hold_the_skin() -> None:
    """What they move goes with the joint that they hang on: an arm that is turned out takes all of its own skin along."""
    plain, halved = (solid_body(mesh) for mesh in (pillar_with_arms(0.28), with_half_joints(pillar_with_arms(0.28))))
    for one, other in zip(plain.arms, halved.arms, strict=True):
        assert np.array_equal(one.points.places, other.points.places)
        assert other.points.bones[other.points.weights > 0].max() < len(plain.skeleton.names)
    mesh = with_half_joints(pillar_with_arms(0.28))
    clip = hanging(mesh.skeleton, np.full(FRAME_COUNT, 5.0))
    assert from_pillar(mesh, arms_outside(halved, clip)).min() > 0.28 - 0.03
