"""Fingers of the fitted body go where those of the picture are, and those that cannot be stretched stay as they are."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.body.fitting.body_fitting import Fit
from engine.body.fitting.posing import POSED_SHAPE_COEFFICIENTS
from engine.character.figure.figure import Figure
from engine.character.fit.hands import turn_hands
from engine.character.fit.head import joint_axes
from engine.character.fit.template_fit import FittedBody, load_human
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import FINGER_NAMES

FOCAL, CENTRE, PLACE = 2200.0, (499.5, 499.5), np.array([0, 0.1, -3.0])
NOBODY = np.zeros(POSED_SHAPE_COEFFICIENTS, np.float32)
DOWN = {"LeftArm": (0, 0, -1.2), "RightArm": (0, 0, 1.2)}


def standing(turns: dict[str, np.ndarray] | None = None) -> FittedBody:
    """Somebody who stands, arms down, some joints turned by rotation vectors."""
    human = load_human()
    own = np.tile(np.eye(3, dtype=np.float32), (len(human.rig.names), 1, 1))
    for name, vector in {**DOWN, **(turns or {})}.items():
        own[human.rig.index(name)] = Rotation.from_rotvec(vector).as_matrix()
    fit = Fit(NOBODY, own, PLACE.astype(np.float32), 0.0, np.zeros(1))
    return FittedBody(fit, Camera((0, 0, 0), FOCAL, CENTRE, (800, 600)), np.zeros(len(own), np.bool_))


def figure(left: np.ndarray | None) -> Figure:
    nothing = np.zeros((33, 3), np.float32)
    return Figure(np.zeros((1000, 1000, 3), np.uint8), None, nothing[:, :2], nothing[:, 0], nothing, True, (1000, 1000),
                  np.zeros((1, 4), np.float32), 0, np.zeros((1000, 1000), np.bool_), None, (left, None))  # fmt: skip


def places(body: FittedBody) -> np.ndarray:
    """The left hand's landmarks (21, 3), metres from the camera."""
    human = load_human()
    heads, model = human.space.joints(NOBODY), human.hands[0]
    axes, joints = joint_axes(human.rig.parents, body.fit.rotations, heads, body.fit.root_translation)
    return joints[model.joints] + np.einsum(
        "nij,nj->ni", axes[model.joints], (model.mean - heads[model.joints]).astype(float)
    )


def seen(body: FittedBody) -> np.ndarray:
    at = places(body)
    pixels = at[:, :2] * [FOCAL, -FOCAL] / -at[:, 2:] + CENTRE
    return np.column_stack([pixels, (at[:, 2] - at[0, 2]) * FOCAL / -at[0, 2]]).astype(np.float32)


def curled(angle: float, spread: float = 0.0) -> dict[str, np.ndarray]:
    """Turns of the left hand, which shows its back or palm to the viewer, and of its fingers."""
    model = load_human().hands[0]
    turns = {"LeftForeArm": np.array([0.9, 0, 0]), "LeftHand": np.array([0.7, 0, 0])}
    for finger, axis in zip(FINGER_NAMES[1:], model.bend[1:], strict=True):
        aside = (FINGER_NAMES.index(finger) - 2.4) * spread * model.spread
        turns[f"LeftHand{finger}1"] = (Rotation.from_rotvec(aside) * Rotation.from_rotvec(angle * axis)).as_rotvec()
        turns |= {f"LeftHand{finger}{k}": angle * axis for k in (2, 3)}
    return turns


@pytest.mark.parametrize(("angle", "spread", "stretched"), [(0.7, 0.0, False), (-0.15, -0.15, True)])
def test_fingers_go_where_they_are_seen(angle: float, spread: float, stretched: bool) -> None:
    truth = standing(curled(angle, spread))
    found = turn_hands(standing(), figure(seen(truth)))
    wrist = places(found) - places(found)[0], places(truth) - places(truth)[0]
    assert np.median(np.linalg.norm(wrist[0] - wrist[1], axis=1)) < 0.006
    rig = load_human().rig
    hand = [i for i, name in enumerate(rig.names) if name.startswith("LeftHand") or name == "LeftForeArm"]
    others = np.delete(np.arange(len(rig.names)), hand)
    assert (found.fit.rotations[others] == standing().fit.rotations[others]).all()
    fingers = [i for i in hand if rig.names[i] not in ("LeftHand", "LeftForeArm")]
    assert (found.kept[fingers] != stretched).all()
    assert not np.delete(found.kept, fingers).any()


def test_the_forearm_shares_the_hands_turn() -> None:
    found = turn_hands(standing(), figure(seen(standing(curled(0.1)))))
    rig = load_human().rig
    angles = [
        Rotation.from_matrix(found.fit.rotations[rig.index(name)]).as_rotvec()[0]
        for name in ("LeftForeArm", "LeftHand")
    ]
    np.testing.assert_allclose(angles, 0.8, atol=0.2)


def test_hands_that_are_not_seen_or_not_believed_stay() -> None:
    noise = np.random.default_rng(2).uniform(300, 400, (21, 3)).astype(np.float32)
    tiny = seen(standing(curled(0.3)))
    tiny[:, :2] = tiny[0, :2] + 0.05 * (tiny[:, :2] - tiny[0, :2])
    for hand in (None, noise, tiny):
        kept = turn_hands(standing(), figure(hand))
        np.testing.assert_array_equal(kept.fit.rotations, standing().fit.rotations)
        assert not kept.kept.any()
