"""Legs that cross, or hide one another from the side: which is before, and the other made where it is hidden. The template stands for the person, so that all is
known of what nobody sees."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from engine.body.fitting.body_fitting import Fit
from engine.body.fitting.posing import POSED_SHAPE_COEFFICIENTS
from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import FittedBody, load_human, pose_template
from engine.character.fit.template_maps import side_maps
from engine.character.parts.label_map import label_parts
from engine.character.parts.overlapping_legs import as_the_template, leg_before
from engine.character.surface.front_and_back import stitch_front_and_back
from engine.character.surface.layers import build_layers
from engine.geometry.camera import Camera
from engine.geometry.mesh.welding import is_closed
from engine.imaging.masks.mask_distance import distance_to

SIZE = (448, 260)
LEFT, RIGHT = BODY_PARTS.index("left_leg"), BODY_PARTS.index("right_leg")
LEFT_ARM, RIGHT_ARM = BODY_PARTS.index("left_arm"), BODY_PARTS.index("right_arm")
ARMS_DOWN = {"LeftArm": (0, 0, -60), "RightArm": (0, 0, 60)}
AT_THE_KNEES = {"LeftUpLeg": (-14, 0, -16), "LeftLeg": (14, 0, -4), "RightUpLeg": (2, 0, 10)}
FROM_THE_SIDE = {"Hips": (0, 75, 0)}
AT_THE_SHINS = {"RightUpLeg": (-9, 0, 13), "RightLeg": (4, 0, 0), "LeftUpLeg": (5, 0, -7), "LeftLeg": (6, 0, 0)}


def fitted_as(turns: dict[str, tuple[int, int, int]]) -> FittedBody:
    human = load_human()
    rotations = np.broadcast_to(np.eye(3, dtype=np.float32), (len(human.rig.names), 3, 3)).copy()
    for joint, degrees in (ARMS_DOWN | turns).items():
        rotations[human.rig.index(joint)] = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    place = np.array([0, 0.05, -3.0], np.float32)
    fit = Fit(np.zeros(POSED_SHAPE_COEFFICIENTS, np.float32), rotations, place, 0.0, np.zeros(1))
    return FittedBody(
        fit, Camera((0, 0, 0), 660.0, (SIZE[1] / 2, SIZE[0] / 2), SIZE), np.zeros(len(rotations), np.bool_)
    )


def standing(turns: dict[str, tuple[int, int, int]]) -> PosedTemplate:
    fitted = fitted_as(turns)
    return pose_template(fitted, fitted.picture_camera(), load_human())


def without_arms(template: PosedTemplate) -> np.ndarray:
    """The triangles (T,) of all else."""
    part = vertex_parts(load_human().rig)[template.triangles]
    return ~np.isin(part, (LEFT_ARM, RIGHT_ARM)).any(axis=1)


def leg_of(template: PosedTemplate, leg: int) -> np.ndarray:
    """A leg's triangles."""
    part = vertex_parts(load_human().rig)[template.triangles]
    return template.triangles[(part == leg).all(1)]


@pytest.mark.parametrize(
    ("turns", "before", "behind", "worn"),
    [(AT_THE_KNEES, LEFT, RIGHT, 0), (AT_THE_SHINS, RIGHT, LEFT, 4), (FROM_THE_SIDE, RIGHT, LEFT, 4)],
    ids=["knees, bare", "shins, in trousers", "side, in trousers"],
)
def test_the_leg_behind_goes_on_where_it_is_hidden(
    turns: dict[str, tuple[int, int, int]], before: int, behind: int, worn: int
) -> None:
    human, template = load_human(), standing(turns)
    mask = side_maps(template.vertices, template.triangles, SIZE, "front").mask
    mask = cv2.dilate(mask.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=worn) > 0
    rgb = np.where(mask[..., None], [60, 60, 90], [200, 200, 200]).astype(np.uint8)
    found = label_parts(rgb, mask, template, human.rig)
    assert before in found.apart and behind not in found.apart

    own = [side_maps(template.vertices, leg_of(template, behind), SIZE, side) for side in ("front", "back")]
    other = side_maps(template.vertices, leg_of(template, before), SIZE, "front")
    hidden = own[0].mask & other.mask & (other.depth > own[0].depth)
    assert hidden.sum() > 500
    layers = build_layers(found, template, human.rig)
    body, leg = layers[0], layers[1]
    # between hip, where the leg goes over into the trunk, and sole
    rows = np.arange(int(template.joints[human.rig.index("LeftLeg"), 1]), SIZE[0])
    hidden[: rows[0]] = False
    assert (body.mask & hidden).sum() > 0.95 * hidden.sum()
    worn_on_it = cv2.dilate(own[0].mask.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=max(worn - 1, 0)) > 0
    wider = worn_on_it & (found.labels == before)
    wider[: rows[0]] = False
    assert (body.mask & wider).sum() > 0.93 * wider.sum(), "as wide as what is worn on the other"
    shared = body.mask & leg.mask & hidden
    assert (body.front.depth > body.back.depth)[shared].all(), "it has a front and a back"
    assert np.mean((leg.front.depth > body.front.depth)[shared]) > 0.99, "behind the other"

    mesh = stitch_front_and_back(layers, mask.astype(np.float32))
    _, point = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    assert is_closed(point.ravel()[mesh.triangles])
    y, x = np.nonzero(hidden)
    truth = np.concatenate([np.stack([x, y, side.depth[y, x]], 1) for side in own])
    near = hidden[tuple(np.clip(np.rint(mesh.vertices[:, 1::-1]), 0, np.array(SIZE) - 1).astype(int).T)]
    made = mesh.vertices[near & (mesh.layer == 0)]
    ways = [cKDTree(a).query(b)[0].mean() / template.pixels_per_metre for a, b in ((made, truth), (truth, made))]
    assert np.mean(ways) < 0.03

    moving = np.zeros(len(human.rig.names), np.bool_)
    side = "Left" if before == LEFT else "Right"
    moving[[k for k, name in enumerate(human.rig.names) if name.startswith(side)]] = True
    for surface in (body.front, body.back):
        assert surface.weights[hidden & body.mask][:, moving].sum(1).max() < 0.05, "the other leg does not move it"


def test_neither_leg_goes_on_behind_a_hand_that_hangs_beside_the_hip() -> None:
    human, template = load_human(), standing(FROM_THE_SIDE)
    covered = template.covers(np.ones(len(template.triangles), np.bool_), SIZE)
    mask = cv2.dilate(covered.astype(np.uint8), np.ones((7, 7), np.uint8)) > 0
    rgb = np.where(mask[..., None], [60, 60, 90], [200, 200, 200]).astype(np.uint8)
    found = label_parts(rgb, mask, template, human.rig)
    trunk = template.covers(without_arms(template), SIZE)
    beyond = (found.labels == RIGHT_ARM) & (distance_to(trunk) > 4)
    beyond[: int(template.joints[human.rig.index("LeftUpLeg"), 1]) - 15] = False
    assert beyond.sum() > 200
    for layer in build_layers(found, template, human.rig)[:2]:
        assert not (layer.mask & beyond).any()


@pytest.mark.parametrize(
    ("turn", "before"), [(0, None), (45, None), (55, RIGHT), (75, RIGHT), (-75, LEFT), (105, RIGHT)]
)
def test_the_nearer_leg_is_before_the_other_as_the_body_turns(turn: int, before: int | None) -> None:
    assert leg_before(np.full(SIZE, LEFT), standing({"Hips": (0, turn, 0)}), load_human().rig) == before


def test_the_leg_before_is_the_one_that_is_seen_where_they_cross() -> None:
    rig, template = load_human().rig, standing(AT_THE_KNEES)
    for leg in (LEFT, RIGHT):
        labels = np.full(SIZE, leg)
        assert leg_before(labels, template, rig) == leg
    nothing = np.full(SIZE, -1)
    assert leg_before(nothing, template, rig) is None


def test_trousers_of_the_leg_before_hide_as_much_as_they_stand_off() -> None:
    """Two upright legs side by side, the one before 4 pixels wider than the template on its free side."""
    template = np.full((60, 60), -1)
    template[:, 20:30], template[:, 30:40] = LEFT, RIGHT
    labels = np.full((60, 60), -1)
    labels[:, 16:30], labels[:, 30:44] = LEFT, RIGHT
    found = as_the_template(labels, template, LEFT)
    assert (found[:, 16:34] == LEFT).all()
    assert (found[:, 34:44] == RIGHT).all()
    assert (found[labels < 0] == -1).all()
    bare = np.where(template >= 0, labels, -1)
    np.testing.assert_array_equal(as_the_template(bare, template, LEFT)[:, 32:40], bare[:, 32:40])


def test_where_nobody_sees_the_crossing_the_template_tells_which_leg_hides_the_other() -> None:
    rig, template = load_human().rig, standing({"Hips": (0, 82, 0), "LeftUpLeg": (8, 0, 0), "LeftLeg": (-14, 0, 0)})
    legs = np.full(SIZE, -1)
    legs[int(template.joints[rig.index("LeftFoot"), 1]) :] = RIGHT
    assert leg_before(legs, template, rig) == RIGHT


def test_a_long_skirt_from_the_side_leaves_the_far_leg_below_it_its_own() -> None:
    """What the leg before wears is looked for on its lower half: further up is a skirt."""
    human, template = load_human(), standing(FROM_THE_SIDE)
    mask = template.covers(np.ones(len(template.triangles), np.bool_), SIZE)
    hips, knees = (int(template.joints[human.rig.index(name), 1]) for name in ("LeftUpLeg", "LeftLeg"))
    hem, middle = knees + 45, float(template.joints[human.rig.index("Hips"), 0])
    y, x = np.mgrid[: SIZE[0], : SIZE[1]]
    skirt = (y >= hips - 30) & (y < hem) & (abs(x - middle) < 34 + (y - hips) / 1.6)
    rgb = np.where(skirt[..., None], [40, 120, 60], np.where(mask[..., None], [225, 180, 150], [140, 140, 145]))
    found = label_parts(rgb.astype(np.uint8), mask | skirt, template, human.rig).labels
    part = vertex_parts(human.rig)[template.triangles]
    far = template.shows((part == LEFT).all(1), SIZE)
    far[: hem + 2] = False
    assert far.sum() > 100
    assert (found[far] == LEFT).mean() > 0.9
