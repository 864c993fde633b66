"""How much the plane counts beside the head turned in space."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_face import driver, opened, placed, shut, smiling
from numpy.typing import NDArray
from pydantic import ValidationError

from engine.face_animation.acting_options import ActingOptions, Part
from engine.face_animation.motion_transfer.control_motion import PLANE_SHARE, ControlMotion, carry_motion, plane_share
from engine.face_animation.motion_transfer.control_points import place_control_points
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy
from engine.face_animation.motion_transfer.landmark_residuals import LandmarkResiduals
from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS, gap_limits
from engine.face_animation.mouth.lip_curves import thickness_shares
from engine.face_animation.mouth.lips_and_skin import LIP_COLUMNS
from engine.perception.face.landmarks import (
    FACE_OVAL,
    LEFT_BROW,
    LEFT_EYE,
    LEFT_IRIS,
    LIPS_INNER,
    LIPS_OUTER,
    RIGHT_BROW,
    RIGHT_EYE,
    RIGHT_IRIS,
    eye_opening,
)
from engine.portrait.options import PortraitOptions

PARTS: dict[Part, list[int]] = {
    "eyes": [*RIGHT_EYE, *LEFT_EYE],
    "brows": [*RIGHT_BROW[:5], *LEFT_BROW[:5]],  # their upper edges: the lower ones go half with the eyes
    "mouth": [*LIPS_OUTER, *LIPS_INNER],
}


def test_a_frontal_face_moves_in_space_alone() -> None:
    assert plane_share(placed(60, (150, 140))).max() == 0


@pytest.mark.parametrize(("yaw", "share"), [(6.5, 0.5), (10, 1), (25, 1)])
def test_inside_a_turned_face_the_plane_counts_and_never_on_its_contour(yaw: float, share: float) -> None:
    face = placed(60, (150, 140), yaw=yaw)
    counts = plane_share(face)
    assert np.abs(counts[list(FACE_OVAL)]).max() < 0.02
    assert counts[[1, 133, 362, 13, 14]] == pytest.approx(PLANE_SHARE * share, abs=0.03)


def grimace(face: NDArray[np.float32]) -> NDArray[np.float32]:
    """The face with half-shut eyes that look aside, brows up, and a mouth that smiles and opens."""
    made = shut(smiling(opened(face, 0.3)), 0.5)
    made[[*RIGHT_BROW, *LEFT_BROW], 1] -= 8
    made[[*RIGHT_IRIS, *LEFT_IRIS], 0] += 3
    return made


def carried(folder: Path, in_space: bool, **options: object) -> ControlMotion:
    """What the control points of a face do when a driver, at rest in its first frame, makes a grimace in its second."""
    rest, target = placed(80, (200, 180)), placed(60, (150, 130))
    track = driver(folder, [rest, grimace(rest)], size=(400, 400))
    control = place_control_points(target, np.ones((300, 300), np.float32))
    proxy = build_head_proxy(control.points, target) if in_space else None
    return list(carry_motion(track, 0, target, control, proxy, ActingOptions(**options)))[1]


def test_all_parts_can_be_named_in_one_word() -> None:
    assert PortraitOptions.model_validate({"follow": ["all"]}) == PortraitOptions()
    with pytest.raises(ValidationError):
        PortraitOptions.model_validate({"follow": ["all", "mouth"]})


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("part", PARTS)
def test_what_is_named_follows_and_the_rest_stays(tmp_path: Path, part: Part, in_space: bool) -> None:
    everything, made = carried(tmp_path, in_space), carried(tmp_path, in_space, follow=(part,))
    for name, vertices in PARTS.items():
        most = np.linalg.norm(everything.offsets[vertices], axis=1).max()
        assert most > 2
        wanted = everything.offsets[vertices] if name == part else 0.0
        assert np.linalg.norm(made.offsets[vertices] - wanted, axis=1).max() < 0.12 * most, name
    assert np.abs(made.look).max() > 0.02 if part == "eyes" else not made.look.any()


class OneLidLowered(LandmarkResiduals):
    """A second look that takes one upper lid to be too high."""

    def __init__(self) -> None:
        pass

    def corrections(self, faces: NDArray[np.floating], placed: NDArray[np.floating]) -> NDArray[np.floating]:
        lowered = np.zeros(placed.shape)
        lowered[:, np.array(LID_EDGE_VERTEX_PAIRS)[:7, 0], 1] = 2.0
        return lowered


@pytest.mark.parametrize("strength", [1.0, 1.5])
def test_both_lids_open_as_far_and_no_farther_than_they_may_however_strongly(tmp_path: Path, strength: float) -> None:
    rest, target = placed(80, (200, 180)), placed(60, (150, 130))
    wide = shut(rest, 1.5)
    wide[np.array(LID_EDGE_VERTEX_PAIRS)[:7, 0], 1] += 1.0  # a tracker sees one of them less open
    track = driver(tmp_path, [rest, wide], size=(400, 400))
    control = place_control_points(target, np.ones((300, 300), np.float32))
    proxy, options = build_head_proxy(control.points, target), ActingOptions(strength=strength)
    made = list(carry_motion(track, 0, target, control, proxy, options, OneLidLowered()))[1]
    opened_by = eye_opening(control.points[:478] + made.offsets[:478]) / eye_opening(target)
    assert opened_by[0] == pytest.approx(opened_by[1], abs=0.02)
    assert 1.05 < opened_by.max() < gap_limits(target).max() + 0.02


@pytest.mark.parametrize("lips", [0.3, 1.0])
def test_lips_of_a_mouth_that_opens_wide_keep_their_thickness(tmp_path: Path, lips: float) -> None:
    """As the driver's do; on a target with thin ones, too, where the way of a thick one would turn them inside out."""
    rest, target = placed(80, (200, 180)), placed(60, (150, 130))
    for column in np.array(LIP_COLUMNS).reshape(-1, 4):
        target[column] = target[column[-2]] + lips * (target[column] - target[column[-2]])
    wide = opened(rest, 0.3)
    for column in LIP_COLUMNS[1]:
        wide[list(column)] = wide[column[-1]] + 0.7 * (wide[list(column)] - wide[column[-1]])
    track = driver(tmp_path, [rest, wide], size=(400, 400))
    control = place_control_points(target, np.ones((300, 300), np.float32))
    made = list(carry_motion(track, 0, target, control, build_head_proxy(control.points, target), ActingOptions()))[1]
    face = control.points[:478] + made.offsets[:478]
    wanted = thickness_shares(np.asarray(track.meshes[1:]), np.asarray(track.meshes[0]))[0]
    kept = thickness_shares(face[None], target)[0]
    assert (kept > 0.93 * np.minimum(wanted, 1)).all(), (kept, wanted)
