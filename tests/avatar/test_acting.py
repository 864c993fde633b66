"""Films of an avatar: it stays in the picture, stands as it was filmed, and its face does what is asked."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from template_character import template_character, walk

from engine.avatar.acting import Scene, built_in_clips, bust_camera, film, standing_clip, wide_camera
from engine.avatar.combined_targets import COMBINED_TARGETS, with_combined_targets
from engine.body.template import FACE_UNITS
from engine.geometry.rigging.morph_target import MorphTrack, morph_target
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion.edit import loop_travel
from engine.motion.kinematics import pose_transforms

SIZE = (72, 128)


@pytest.fixture(scope="module")
def mesh() -> SkinnedMesh:
    return template_character(texture_size=64)


def test_the_pose_of_the_film_turns_each_joint_s_axes_as_they_were(mesh: SkinnedMesh) -> None:
    random = Rotation.random(len(mesh.skeleton.names), random_state=3).as_matrix()
    root = np.array([0.1, 0.9, -0.2])
    clip = standing_clip(mesh, random, root, 30.0)
    transforms = pose_transforms(mesh.skeleton, clip.rotations, clip.root)[0]
    assert transforms[:, :3, :3] == pytest.approx(random, abs=1e-5)
    hips = transforms[0, :3, :3] @ mesh.skeleton.heads[0] + transforms[0, :3, 3]
    assert hips == pytest.approx(root, abs=1e-5)


def test_none_of_the_built_in_loops_goes_anywhere(mesh: SkinnedMesh) -> None:
    clips = built_in_clips(mesh, 30.0)
    assert len({clip.name for clip in clips}) == len(clips) == 8
    assert max(np.linalg.norm(loop_travel(clip)) for clip in clips if clip.loops) < 0.1


def test_all_of_a_motion_is_in_the_wide_picture_and_the_face_in_the_near_one(mesh: SkinnedMesh) -> None:
    clip = walk(mesh.skeleton, travels=False)
    transforms = pose_transforms(mesh.skeleton, clip.rotations, clip.root)
    hands = mesh.skeleton.index("LeftHand"), mesh.skeleton.index("RightHand")
    wide, near = wide_camera(mesh, clip, SIZE), bust_camera(mesh, clip, SIZE)
    for moves in transforms:
        places = np.stack([moves[j, :3, :3] @ mesh.skeleton.heads[j] + moves[j, :3, 3] for j in hands])
        seen = wide.project(places)[:, :2]
        assert (seen > 0).all() and (seen < np.array(SIZE)).all()
    head = mesh.skeleton.index("Head")
    crown = transforms[0][head, :3, :3] @ mesh.skeleton.heads[head] + transforms[0][head, :3, 3]
    assert near.project(crown[None])[0, 2] < 0.6 * wide.project(crown[None])[0, 2]


def test_a_face_is_held_where_a_clip_begins_wherever_it_goes(mesh: SkinnedMesh) -> None:
    near = bust_camera(mesh, walk(mesh.skeleton, frames=30, travels=True), SIZE)
    begin = bust_camera(mesh, walk(mesh.skeleton, frames=30, travels=False), SIZE)
    np.testing.assert_allclose(near.eye, begin.eye, atol=1e-5)


def test_a_face_that_acts_changes_the_picture_where_it_acts(mesh: SkinnedMesh) -> None:
    top = mesh.vertices[:, 1].max()
    lifted = np.where(mesh.vertices[:, 1:2] > top - 0.05, np.float32([0, 0.05, 0]), np.float32(0))
    morphs = [morph_target("crown", lifted)]
    clip = walk(mesh.skeleton, frames=2, travels=False)
    track = MorphTrack(("crown",), np.array([[0.0], [1.0]], np.float32))
    rest, raised = film(mesh, morphs, Scene(clip, track), SIZE)
    rows = np.flatnonzero((rest != raised).any(axis=(1, 2)))
    drawn = np.flatnonzero((rest[:, :, 0].astype(int) - rest[:, :1, 0] != 0).any(axis=1))
    assert rows.min() < drawn.min()  # it is higher than before


def test_combined_targets_are_the_sums_of_their_units() -> None:
    random = np.random.default_rng(1)
    units = {unit: random.normal(size=(5, 3)).astype(np.float32) for unit in FACE_UNITS}
    found = with_combined_targets(units)
    assert list(found) == [*FACE_UNITS, *COMBINED_TARGETS]
    assert found["eyesClosed"] == pytest.approx(units["eyeBlinkLeft"] + units["eyeBlinkRight"])
    assert found["mouthOpen"] == pytest.approx(units["jawOpen"])
