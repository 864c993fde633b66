"""Bodies with known pose and shape come back from their landmarks, and from several views more nearly than from one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.body import load_template
from engine.body.body_space import load_body_space
from engine.body.fitting.body_fitting import fit_body
from engine.body.fitting.first_guess import first_guess
from engine.body.fitting.observation import DIRECTED_LIMBS, Crossing, Observation
from engine.body.fitting.posing import FITTED_JOINTS, POSED_SHAPE_COEFFICIENTS, BodyPoser, forward, rotation_matrices
from engine.body.fitting.residuals import CROSSING_DEPTH_METRES, residuals
from engine.body.landmarks import landmark_model
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig
from engine.geometry.camera import Camera

SPACE = load_body_space()
MARKS = landmark_model(load_template(), SPACE, load_rig(HUMAN_RIG))
FOCAL, CENTRE = 1400.0, (320.0, 400.0)
CAMERA = Camera((0, 0, 0), FOCAL, CENTRE, (820, 640))


def somebody(seed: int) -> np.ndarray:
    """Parameters of somebody who stands, arms and head anywhere within reason."""
    random = np.random.default_rng(seed)
    turns = np.zeros((len(FITTED_JOINTS), 3))
    turns[0, 1] = random.uniform(-0.5, 0.5)
    for side, sign in (("Left", 1), ("Right", -1)):
        turns[FITTED_JOINTS.index(f"{side}Arm")] = [
            0,
            sign * random.uniform(-0.5, 0.2),
            -sign * random.uniform(-0.3, 1.2),
        ]
        turns[FITTED_JOINTS.index(f"{side}ForeArm")] = [0, -sign * random.uniform(0, 1.2), 0]
        turns[FITTED_JOINTS.index(f"{side}UpLeg")] = [random.uniform(-0.3, 0.05), 0, sign * random.uniform(0, 0.2)]
        turns[FITTED_JOINTS.index(f"{side}Leg")] = [random.uniform(0, 0.4), 0, 0]
    turns[FITTED_JOINTS.index("Head")] = random.uniform(-0.2, 0.2, 3)
    return np.concatenate([[0.1, 0.0, -4.5], turns.ravel(), random.normal(0, 0.7, POSED_SHAPE_COEFFICIENTS)])


def test_exact_landmarks_give_the_joints_within_two_centimetres() -> None:
    """In the median over joints and people; seen from the root, since only it says how far away somebody is."""
    off = []
    for seed in range(12):
        joints, points = forward(SPACE, MARKS, somebody(seed))
        pixels = points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE
        place = dict(zip(SPACE.names, joints, strict=True))
        limbs = np.stack([place[b] - place[a] for a, b in DIRECTED_LIMBS])
        limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
        trust = np.ones(len(pixels), np.float32), np.ones(len(DIRECTED_LIMBS), np.float32)
        seen = Observation(
            pixels.astype(np.float32), trust[0], limbs.astype(np.float32), trust[1], CAMERA, landmark_sigma=0.002
        )
        fit = fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place))
        found, _ = forward(SPACE, MARKS, fit.parameters)
        turned = [SPACE.names.index(name) for name in FITTED_JOINTS]
        off.append(np.linalg.norm((found - found[0]) - (joints - joints[0]), axis=1)[turned])
        assert fit.reprojection < 0.01 * np.ptp(pixels[:, 1])
    assert np.median(off) < 0.02


@pytest.mark.parametrize("seed", range(4))
def test_the_first_guess_has_limbs_point_where_they_are_seen_to(seed: int) -> None:
    """Upper ones in the trunk's axes, lower ones in those of the upper."""
    joints, points = forward(SPACE, MARKS, somebody(seed))
    pixels = (points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE).astype(np.float32)
    place = dict(zip(SPACE.names, joints, strict=True))

    def limbs_of(at: dict[str, np.ndarray]) -> np.ndarray:
        limbs = np.stack([at[b] - at[a] for a, b in DIRECTED_LIMBS])
        return np.asarray(limbs / np.linalg.norm(limbs, axis=1, keepdims=True))

    sure = np.ones(len(DIRECTED_LIMBS), np.float32)
    seen = Observation(pixels, np.ones(len(pixels), np.float32), limbs_of(place).astype(np.float32), sure, CAMERA)
    guessed, _ = forward(SPACE, MARKS, first_guess(SPACE, MARKS, seen, place))
    cosines = (limbs_of(dict(zip(SPACE.names, guessed, strict=True))) * limbs_of(place)).sum(1)
    assert np.degrees(np.arccos(cosines.min())) < 5


def test_who_strides_towards_the_viewer_is_not_fitted_flat() -> None:
    """The feet's distance in depth, of somebody who walks at an ordinary pace and is seen as they are."""
    truth = np.zeros(len(somebody(0)))
    truth[:3] = [0.1, 0.0, -4.5]
    turns = truth[3:-POSED_SHAPE_COEFFICIENTS].reshape(-1, 3)
    for name, turn in {"LeftArm": (0, 0, -1.1), "RightArm": (0, 0, 1.1), "LeftUpLeg": (-0.4, 0, 0),
                       "LeftLeg": (0.15, 0, 0), "RightUpLeg": (0.15, 0, 0), "RightLeg": (0.3, 0, 0)}.items():  # fmt: skip
        turns[FITTED_JOINTS.index(name)] = turn
    joints, points = forward(SPACE, MARKS, truth)
    pixels = (points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE).astype(np.float32)
    place = dict(zip(SPACE.names, joints, strict=True))
    limbs = np.stack([place[b] - place[a] for a, b in DIRECTED_LIMBS]).astype(np.float32)
    limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
    seen = Observation(
        pixels, np.ones(len(pixels), np.float32), limbs, np.ones(len(DIRECTED_LIMBS), np.float32), CAMERA
    )
    found, _ = forward(SPACE, MARKS, fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place)).parameters)
    feet = [SPACE.names.index(f"{side}Foot") for side in ("Left", "Right")]
    strides = [at[feet[0], 2] - at[feet[1], 2] for at in (joints, found)]
    assert strides[0] > 0.45
    assert abs(strides[1] / strides[0] - 1) < 0.15


@pytest.mark.parametrize("front", [0, 1])
def test_of_crossed_forearms_that_is_before_the_other_which_is_said_to_be(front: int) -> None:
    """From landmarks alone, which fit both."""
    truth = np.zeros(len(somebody(0)))
    truth[:3] = [0.1, 0.0, -4.5]
    turns = truth[3:-POSED_SHAPE_COEFFICIENTS].reshape(-1, 3)
    for side, sign in (("Left", 1), ("Right", -1)):
        turns[FITTED_JOINTS.index(f"{side}Arm")] = [0.6, 0, -1.25 * sign]
        turns[FITTED_JOINTS.index(f"{side}ForeArm")] = [0, -1.9 * sign, 0]
    joints, points = forward(SPACE, MARKS, truth)
    pixels = (points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE).astype(np.float32)
    place = dict(zip(SPACE.names, joints, strict=True))
    limbs = np.stack([place[b] - place[a] for a, b in DIRECTED_LIMBS]).astype(np.float32)
    limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
    trust = np.ones(len(pixels), np.float32), np.ones(len(DIRECTED_LIMBS), np.float32)
    seen = Observation(pixels, trust[0], limbs, trust[1], CAMERA, crossing=Crossing(front, 0.5, 0.5))
    fit = fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place))
    found, _ = forward(SPACE, MARKS, fit.parameters)
    middle = [
        np.mean([found[SPACE.names.index(f"{side}{name}"), 2] for name in ("ForeArm", "Hand")])
        for side in ("Left", "Right")
    ]
    assert middle[front] - middle[1 - front] > CROSSING_DEPTH_METRES - 0.02
    assert fit.reprojection < 0.015 * np.ptp(pixels[:, 1])


AROUND = (0.0, 1.3, -1.2, 2.8)
"""Radians by which cameras stand beside the front, about the person."""


def view_from(
    angle: float, truth: np.ndarray, random: np.random.Generator
) -> tuple[Observation, dict[str, np.ndarray]]:
    """What a camera sees of somebody, and perception makes of it: landmarks off by their usual share of the height, which
    the test projects itself, and directions of limbs as `DIRECTED_LIMBS` are believed. With the trunk's places in its axes."""
    middle = truth[:3]
    eye = middle + 4.5 * np.array([np.sin(angle), 0.15, np.cos(angle)])
    camera = Camera((0, 0, 0), FOCAL, CENTRE, (820, 640)).aimed(eye, middle)
    joints, points = forward(SPACE, MARKS, truth)
    seen, joints = ((at - camera.eye) @ np.array(camera.axes).T for at in (points, joints))
    pixels = seen[:, :2] * [FOCAL, -FOCAL] / -seen[:, 2:] + CENTRE
    pixels += random.normal(0, 0.012 * np.ptp(pixels[:, 1]), pixels.shape)
    place = dict(zip(SPACE.names, joints, strict=True))
    limbs = np.stack([place[b] - place[a] for a, b in DIRECTED_LIMBS])
    limbs = limbs / np.linalg.norm(limbs, axis=1, keepdims=True) + random.normal(0, 0.2, (len(DIRECTED_LIMBS), 3))
    limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
    trust = np.ones(len(pixels), np.float32), np.ones(len(DIRECTED_LIMBS), np.float32)
    return Observation(pixels.astype(np.float32), trust[0], limbs.astype(np.float32), trust[1], camera), place


def errors(truth: np.ndarray, views: list[Observation], trunk: dict[str, np.ndarray]) -> tuple[float, float]:
    """Of a fit, metres: of the joints about the root, and of the skin in T-pose, each the root mean square."""
    fit = fit_body(SPACE, MARKS, views, first_guess(SPACE, MARKS, views[0], trunk))
    (found, _), (joints, _) = (forward(SPACE, MARKS, parameters) for parameters in (fit.parameters, truth))
    turned = [SPACE.names.index(name) for name in FITTED_JOINTS]
    pose = ((found - found[0]) - (joints - joints[0]))[turned]
    shape = SPACE.vertices(fit.coefficients) - SPACE.vertices(truth[-POSED_SHAPE_COEFFICIENTS:])
    return tuple(float(np.sqrt((off**2).sum(1).mean())) for off in (pose, shape))  # type: ignore[return-value]


def test_several_views_give_pose_and_shape_more_nearly_than_one() -> None:
    """The same noise in each view; one alone cannot tell how large somebody is, nor how far an arm reaches to it."""
    one, several = [], []
    for seed in range(3):
        random, truth = np.random.default_rng(seed), somebody(seed)
        seen = [view_from(angle, truth, random) for angle in AROUND]
        views = [view for view, _ in seen]
        one.append(errors(truth, views[:1], seen[0][1]))
        several.append(errors(truth, views, seen[0][1]))
    (pose_of_one, shape_of_one), (pose, shape) = np.mean(one, 0), np.mean(several, 0)
    assert pose < 0.6 * pose_of_one
    assert shape < 0.6 * shape_of_one
    assert pose < 0.03


def test_where_the_world_has_its_origin_does_not_matter() -> None:
    """The same view, by a camera that stands elsewhere and is turned: the same body, there, but for where the search stops."""
    random, truth = np.random.default_rng(1), somebody(1)
    view, trunk = view_from(0.7, truth, random)
    plain = replace(view, camera=CAMERA)
    fits = [fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, trunk)) for seen in (plain, view)]
    here, there = (forward(SPACE, MARKS, fit.parameters)[0] for fit in fits)
    there = (there - view.camera.eye) @ np.array(view.camera.axes).T
    np.testing.assert_allclose(there - there[0], here - here[0], atol=0.03)
    np.testing.assert_allclose(
        there[0], here[0], rtol=0.02, atol=0.01
    )  # one view hardly tells how far away somebody is
    assert fits[1].reprojection == pytest.approx(fits[0].reprojection, rel=0.01)


def test_what_no_view_shows_counts_once_however_often_somebody_is_seen() -> None:
    """Landmarks that are met exactly and no directions: all that is left are priors, of which one body has one each."""
    truth = somebody(3)
    _, points = forward(SPACE, MARKS, truth)
    pixels = (points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE).astype(np.float32)
    limbs = np.zeros((len(DIRECTED_LIMBS), 3), np.float32)
    seen = Observation(pixels, np.ones(len(pixels), np.float32), limbs, limbs[:, 0], CAMERA)
    once, thrice = (
        (residuals(BodyPoser(SPACE), MARKS, [seen] * count, [None] * count, truth[None]) ** 2).sum() for count in (1, 3)
    )
    assert thrice == pytest.approx(once, rel=1e-4)


def test_one_view_alone_and_as_the_only_one_of_several_are_the_same() -> None:
    view, trunk = view_from(0.0, somebody(2), np.random.default_rng(2))
    start = first_guess(SPACE, MARKS, view, trunk)
    alone, listed = (fit_body(SPACE, MARKS, views, start).parameters for views in (view, [view]))
    np.testing.assert_array_equal(alone, listed)
    with pytest.raises(ValueError, match="one view"):
        fit_body(SPACE, MARKS, [], start)


def test_turns_are_rotations_and_small_ones_too() -> None:
    vectors = np.array([[0, 0, 0], [1e-10, 0, 0], [0, np.pi / 2, 0], [0.3, -0.2, 0.9]])
    matrices = rotation_matrices(vectors)
    np.testing.assert_allclose(
        matrices @ np.swapaxes(matrices, 1, 2), np.broadcast_to(np.eye(3), (4, 3, 3)), atol=1e-12
    )
    np.testing.assert_allclose(matrices[2] @ [1, 0, 0], [0, 0, -1], atol=1e-12)


def test_landmarks_are_where_they_should_be() -> None:
    place = dict(zip(MARKS.names, MARKS.mean, strict=True))
    assert place["LeftEye"][0] > 0 > place["RightEye"][0]
    assert place["Nose"][2] > place["LeftEye"][2] > place["LeftEar"][2]
    assert place["LeftFootIndex"][2] > place["LeftHeel"][2]
    assert place["LeftWrist"][0] > place["LeftElbow"][0] > place["LeftShoulder"][0] > 0
