"""Lower teeth, tongue and the dark in a mouth that moves."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import WHITE, painted, placed
from scipy.spatial.transform import Rotation

from engine.face_animation.mouth.modelled.jaw import CHIN_VERTICES, held_between, jaw_of
from engine.face_animation.mouth.modelled.modelled_mouth import (
    BARING_JAW_RADIANS,
    MAX_CROWN_EYE_DISTANCES,
    STUB_EYE_DISTANCES,
    ModelledMouth,
    covered_crown,
    inside_light,
    jaw_behind_lips,
    stubs,
)
from engine.face_animation.mouth.modelled.mouth_colours import (
    FACE_HIGHLIGHT_PERCENTILE,
    MAX_TEETH_TO_HIGHLIGHT_RATIO,
    mouth_colours,
)
from engine.face_animation.mouth.modelled.mouth_light import mouth_light
from engine.face_animation.mouth.modelled.mouth_parts import (
    BAG_RINGS,
    OVERBITE_EYE_DISTANCES,
    OVERJET_EYE_DISTANCES,
    bag_surface,
    modelled_teeth,
    mouth_bag,
    tongue,
)
from engine.face_animation.mouth.modelled.resting_mouth import resting_mouth
from engine.face_animation.skin_colour import face_luminance
from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER

LOWER = [*LIPS_INNER[11:], *LIPS_OUTER[11:], *CHIN_VERTICES]
EYES = 80.0
SHAPE = (400, 400)
WALL = (0, 255, 0)


def front(angle: float) -> np.ndarray:
    """(478, 3) the general face from the front, in eye distances, its jaw open by an angle in radians."""
    shut = frontalise(canonical_face()[None].astype(np.float64))[0]
    upper, lower = np.array(LIPS_INNER[1:10]), np.array(LIPS_INNER[:10:-1])
    shut[upper] = shut[lower] = (shut[upper] + shut[lower]) / 2
    hinge = jaw_of(shut, shut)._replace(angle=angle)
    shut[LOWER] = hinge.moved(shut[LOWER])
    return shut


def seen(face: np.ndarray, yaw: float = 0.0) -> np.ndarray:
    """(478, 2) pixels."""
    turn = Rotation.from_euler("y", yaw, degrees=True).as_matrix()
    return ((face @ turn.T)[:, :2] * EYES + 180).astype(np.float32)


def picture(skin: tuple[int, int, int]) -> np.ndarray:
    rgb = np.full((*SHAPE, 3), skin, np.uint8)
    cv2.fillPoly(rgb, [np.rint(seen(front(0.0))[list(LIPS_OUTER)]).astype(np.int32)], [int(0.8 * one) for one in skin])
    return rgb


@pytest.fixture(scope="module")
def mouth() -> ModelledMouth:
    rest = front(0.0)
    colours = mouth_colours(picture((190, 150, 130)), seen(rest))
    return ModelledMouth(resting_mouth(rest, rest), colours, True)


@pytest.mark.parametrize("angle", [0.0, 0.1, 0.35])
def test_a_jaw_is_found_by_its_chin_from_before(angle: float) -> None:
    shut = front(0.0)
    found = jaw_of(front(angle)[:, :2], shut)
    assert found.angle == pytest.approx(angle, abs=1e-3) and found.aside == pytest.approx(0, abs=1e-9)
    edge = np.array([0.0, 1.1, -0.2])
    height = float(found.moved(edge)[1])
    assert held_between(found, edge, (height - 0.1, height + 0.1)) == found
    for heights, goal in (((height + 0.1, height + 0.2), height + 0.1), ((0.0, height - 0.05), height - 0.05)):
        held = held_between(found, edge, heights)
        assert held.moved(edge)[1] == pytest.approx(max(goal, edge[1]), abs=1e-3)
    points = np.random.default_rng(0).normal(0, 1, (5, 3))
    np.testing.assert_allclose(found._replace(angle=0.0).moved(points), points, atol=1e-12)


@pytest.mark.parametrize(("angle", "yaw"), [(0.08, 0.0), (0.2, 0.0), (0.35, 0.0), (0.2, 25.0), (0.3, -25.0)])
def test_nothing_shows_through_an_open_mouth(mouth: ModelledMouth, angle: float, yaw: float) -> None:
    face = seen(front(angle), yaw)
    frame = np.empty((*SHAPE, 3), np.uint8)
    frame[:] = WALL
    mouth.draw(frame, face, 0)
    inner = np.zeros(SHAPE, np.uint8)
    cv2.fillPoly(inner, [np.rint(face[list(LIPS_INNER)]).astype(np.int32)], 1)
    deep = cv2.erode(inner, np.ones((7, 7), np.uint8)) > 0
    assert deep.any() and (frame[deep].argmax(axis=1) != 1).all(), "reds and greys: no green wall"
    assert (frame[cv2.dilate(inner, np.ones((11, 11), np.uint8)) == 0] == WALL).all()


def test_a_shut_mouth_shows_nothing(mouth: ModelledMouth) -> None:
    frame = np.full((*SHAPE, 3), 99, np.uint8)
    mouth.draw(frame, seen(front(0.0)), 0)
    assert (frame == 99).all()


def test_lower_teeth_go_with_the_jaw_and_upper_ones_stay(mouth: ModelledMouth) -> None:
    at = resting_mouth(front(0.0), front(0.0))
    upper, lower = (len(modelled_teeth(at, one).vertices) for one in (True, False))
    shut, wide = (mouth.places(seen(front(angle))) for angle in (0.0, 0.3))
    moved = np.linalg.norm(wide - shut, axis=1) / EYES
    assert moved[:upper].max() < 5e-3 < 0.15 < moved[upper : upper + lower].min()


def test_both_rows_meet_behind_closed_lips() -> None:
    at = resting_mouth(front(0.0), front(0.0))
    upper, lower = (modelled_teeth(at, one).vertices for one in (True, False))
    assert upper[:, 1].max() > lower[:, 1].min(), "the upper ones reach over the lower ones"
    lips = at.front[list(LIPS_INNER)]
    assert lips[:, 1].mean() < upper[:, 1].max() and upper[:, 2].min() > lips[[4, 5, 6], 2].mean() + 0.02, (
        "behind the lips"
    )
    np.testing.assert_array_equal(mouth_bag(lips)[: len(lips)], lips)


def test_a_person_in_black_and_white_has_a_mouth_in_black_and_white() -> None:
    face = seen(front(0.0))
    grey, red = (mouth_colours(picture(skin), face) for skin in ((150, 150, 150), (200, 150, 130)))
    assert all((np.ptp(ramp.astype(int), axis=-1) == 0).all() for ramp in grey[:4]) and np.ptp(grey.albedo) == 0
    assert all(
        (ramp[..., 0] >= ramp[..., 2]).all() and np.ptp(ramp.astype(int), axis=-1).max() > 20 for ramp in red[:4]
    )
    dark = mouth_colours(picture((75, 52, 45)), face)
    assert all(one.mean() < 0.7 * other.mean() for one, other in zip(dark[:4], red[:4], strict=True)), (
        "in the light of the skin"
    )


def test_the_lightest_tooth_keeps_its_hue_in_a_bright_picture() -> None:
    bright, usual = (
        mouth_colours(picture(skin), seen(front(0.0))).upper.astype(float)[8, -1]
        for skin in ((245, 225, 200), (190, 170, 150))
    )
    assert bright.max() < 255
    np.testing.assert_allclose(bright / bright.max(), usual / usual.max(), atol=0.06)


def light_in(face: np.ndarray, albedo: tuple[float, float, float] = (0.5, 0.5, 0.5)) -> np.ndarray:
    """(h, w, 3) `mouth_light` in the box of a face's inner lips."""
    low, high = np.floor(face[list(LIPS_INNER)].min(axis=0)).astype(int), face[list(LIPS_INNER)].max(axis=0)
    shape = tuple(int(one) for one in np.ceil(high - low)[::-1])
    return mouth_light(face, low.astype(np.float32), shape, np.array(albedo))


def test_light_falls_towards_the_corners_and_the_lips() -> None:
    light = light_in(seen(front(0.3)))[..., 0]
    row, middle = light[light.shape[0] // 2], light.shape[1] // 2
    assert (
        (np.diff(row[:middle]) >= -1e-6).all() and (np.diff(row[middle:]) <= 1e-6).all() and row[0] < 0.7 * row[middle]
    )
    column = light[:, middle]
    assert column[light.shape[0] // 2] == light.max() == pytest.approx(1)
    assert (np.diff(column[2 : len(column) // 2]) >= -1e-6).all() and (
        np.diff(column[len(column) // 2 : -2]) <= 1e-6
    ).all()


def test_the_less_lips_part_the_less_light_falls_between_them() -> None:
    light = [float(light_in(seen(front(angle))).max()) for angle in (0.01, 0.02, 0.05, 0.3)]
    assert light[0] < light[1] < light[2] <= light[3] == pytest.approx(1)


def test_flesh_that_throws_nothing_back_leaves_what_is_seen_and_a_redder_one_warms_shadows_alone() -> None:
    """Eq. 10 by hand: at an albedo of 0.6 half the sight has (0.892 / 4 - 2.235 / 2 + 2.343) / 2 = 0.724 of the light."""
    face = seen(front(0.3))
    black, grey, warm = (light_in(face, albedo) for albedo in ((0.0,) * 3, (0.6,) * 3, (0.6, 0.4, 0.3)))
    half = np.argmin(np.abs(black[..., 0] - 0.5))
    assert grey[..., 0].ravel()[half] == pytest.approx(0.724, abs=0.02)
    assert (
        (grey >= black - 1e-6).all() and (warm[..., 0] >= warm[..., 1]).all() and (warm[..., 1] >= warm[..., 2]).all()
    )
    assert (np.ptp(warm, axis=-1)[black[..., 0] > 0.999] < 0.03).all()


@pytest.mark.parametrize("angle", [0.5 * BARING_JAW_RADIANS[0], 0.3 * BARING_JAW_RADIANS[1]])
def test_the_lower_lip_hides_the_lower_teeth_unless_the_jaw_drops(angle: float) -> None:
    at = resting_mouth(front(0.0), front(0.0))
    edge = np.array([at.middle, at.edge - OVERBITE_EYE_DISTANCES, at.depth + OVERJET_EYE_DISTANCES])
    for raised in (0.0, 0.04, 0.08):
        face = front(angle)
        face[14, 1] -= raised
        assert jaw_behind_lips(at, face).moved(edge)[1] >= min(face[14, 1], edge[1]) - 1e-3


def test_a_soft_picture_has_a_soft_mouth() -> None:
    face, rest = seen(front(0.3)), front(0.0)
    colours = mouth_colours(picture((190, 150, 130)), seen(rest))
    steepest = []
    for softness in (0.0, 0.02, 0.04):
        frame = np.full((*SHAPE, 3), 120, np.uint8)
        ModelledMouth(resting_mouth(rest, rest), colours, True, softness=softness).draw(frame, face, 0)
        deep = np.zeros(SHAPE, np.uint8)
        cv2.fillPoly(deep, [np.rint(face[list(LIPS_INNER)]).astype(np.int32)], 1)
        slope = np.hypot(*np.gradient(frame.mean(axis=-1)))
        steepest.append(float(slope[cv2.erode(deep, np.ones((11, 11), np.uint8)) > 0].max()))
    assert steepest[0] > 1.3 * steepest[1] > 1.3**2 * steepest[2]


def test_what_is_behind_the_tongue_is_dark_and_red_and_never_black() -> None:
    skin = (190, 150, 130)
    colours = mouth_colours(picture(skin), seen(front(0.0)))
    for ramp in (colours.bag, colours.tongue):
        light = ramp.astype(float).mean(axis=-1)
        assert light.min() > 0.2 * np.mean(skin) and (ramp[..., 0] > 1.4 * ramp[..., 2]).all()
    assert (np.diff(colours.bag.astype(int), axis=0) >= 0).all(), "lighter towards the floor"
    assert (np.diff(colours.bag.astype(int), axis=1) <= 0).all(), "darker into the depth"


def test_rounded_lips_cover_the_lower_teeth_too_however_far_the_jaw_drops() -> None:
    at = resting_mouth(front(0.0), front(0.0))
    edge = np.array([at.middle, at.edge - OVERBITE_EYE_DISTANCES, at.depth + OVERJET_EYE_DISTANCES])
    lips = [*LIPS_INNER, *LIPS_OUTER]
    above = []
    for width in (1.0, 0.85, 0.7):
        face = front(1.2 * BARING_JAW_RADIANS[1])
        face[lips, 0] = at.middle + width * (face[lips, 0] - at.middle)
        above.append(face[14, 1] - jaw_behind_lips(at, face).moved(edge)[1])
    assert above[0] > 0 > above[1] > above[2]


def test_rounded_lips_cover_the_upper_teeth(mouth: ModelledMouth) -> None:
    at = resting_mouth(front(0.0), front(0.0))
    lips = [*LIPS_INNER, *LIPS_OUTER]
    heights, covered = [], []
    for width in (1.2, 1.0, 0.96, 0.85, 0.7):
        face = front(0.3)
        face[lips, 0] = at.middle + width * (face[lips, 0] - at.middle)
        face[[82, 13, 312], 1] -= 0.05
        covered.append(covered_crown(at, face))
        upper = mouth.places(seen(face))[: len(modelled_teeth(at, True).vertices), 1]
        heights.append(float(upper.max()) / EYES)
    assert covered[:3] == [0, 0, 0] and 0 < covered[3] < covered[4]
    np.testing.assert_allclose(heights[1], heights[2], atol=1e-3)
    assert heights[0] > heights[2] > heights[3] > heights[4]


def test_a_smile_bares_whole_crowns_and_an_open_mouth_their_edges(mouth: ModelledMouth) -> None:
    """However far the upper lip is drawn up: a jaw that drops stretches it down over its teeth."""
    at = resting_mouth(front(0.0), front(0.0))
    row, lips = len(modelled_teeth(at, True).vertices), [*LIPS_INNER, *LIPS_OUTER]
    bared = []
    for width in (1.0, 1.07, 1.15, 1.3):
        face = front(0.3)
        face[lips, 0] = at.middle + width * (face[lips, 0] - at.middle)
        face[13, 1] -= 0.3
        bared.append((mouth.places(seen(face))[:row, 1].max() - seen(face)[13, 1]) / EYES)
    assert bared[0] < bared[1] < bared[2] == pytest.approx(bared[3], abs=2e-3)
    assert bared[2] - bared[0] == pytest.approx(MAX_CROWN_EYE_DISTANCES[1] - MAX_CROWN_EYE_DISTANCES[0], abs=5e-3)


@pytest.mark.parametrize("skin", [(190, 150, 130), (90, 65, 50)])
def test_teeth_are_seen_lighter_than_the_skin(skin: tuple[int, int, int]) -> None:
    """Those of smiling portraits have 1.3 to 1.7 times its light: that is what is left of theirs after all shades."""
    rest = front(0.0)
    colours = mouth_colours(picture(skin), seen(rest))
    frame = picture(skin)
    face = seen(front(0.06))
    ModelledMouth(resting_mouth(rest, rest), colours, True).draw(frame, face, 0)
    inside = np.zeros(SHAPE, np.uint8)
    cv2.fillPoly(inside, [face[list(LIPS_INNER)].round().astype(np.int32)], 1)
    weights = np.array([0.299, 0.587, 0.114])
    lightest = np.quantile(frame[cv2.erode(inside, np.ones((3, 3))) > 0] @ weights, 0.75)
    assert lightest > 1.15 * (np.array(skin) @ weights)


def test_teeth_of_a_mouth_in_the_shade_are_as_light_as_the_face_asks_for() -> None:
    """Its face is lit from above: teeth are no greyer than the light places, and keep within what a shaded mouth bears."""
    face, weights = seen(front(0.0)), np.array([0.299, 0.587, 0.114])
    rgb = picture((140, 110, 96))
    rgb[: int(face[2, 1])] = (200, 158, 137)
    ring, light = np.array([140, 110, 96]) @ weights, np.array([200, 158, 137]) @ weights
    upper = mouth_colours(rgb, face).upper.astype(float)[8, -1] @ weights
    assert 1.15 * light < upper < 1.8 * ring


def test_teeth_are_no_lighter_than_the_whites_of_eyes_that_are_seen() -> None:
    """The same pale face, once with white eyes and once with dim ones: of these, teeth are no lighter."""
    mesh, weights = placed(90, (160, 120)), np.array([0.299, 0.587, 0.114])
    rgb = painted(mesh, (320, 340))
    white = np.abs(rgb.astype(int) - WHITE).max(axis=2) < 12
    dim = np.array(WHITE) * 0.8
    light = []
    for eyes in (np.array(WHITE), dim):
        rgb[white] = eyes
        light.append(mouth_colours(rgb, mesh).upper.astype(float)[8, -1] @ weights)
    highlights = np.percentile(face_luminance(rgb, mesh), FACE_HIGHLIGHT_PERCENTILE)
    assert (
        light[1] <= light[0] and light[1] <= max(dim @ weights, MAX_TEETH_TO_HIGHLIGHT_RATIO * highlights) + 2
    )  # that crown is 0.7% lighter than the row


def test_crowns_are_told_apart_by_their_shade(mouth: ModelledMouth) -> None:
    """Along a line through the middle of the incisors there is a dark place between each two."""
    rest, face = front(0.0), seen(front(0.25))
    frame = np.full((*SHAPE, 3), WALL, np.uint8)
    mouth.draw(frame, face, 0)
    crown = mouth.places(face)[: len(modelled_teeth(resting_mouth(rest, rest), True).vertices), 1]
    line = frame[int(crown.max()) - 3, int(face[13, 0]) - 16 : int(face[13, 0]) + 17].astype(int).sum(axis=1)
    dips = [k for k in range(1, len(line) - 1) if line[k] < line[k - 1] - 2 and line[k] <= line[k + 1]]
    assert any(abs(k - 16) <= 2 for k in dips), "between the two in the middle"


def test_a_row_of_teeth_is_round_and_no_bar(mouth: ModelledMouth) -> None:
    """Towards the corners it loses a quarter of its light and more, and between teeth beside the incisors there are gaps, too."""
    rest, face = front(0.0), seen(front(0.25))
    frame = np.full((*SHAPE, 3), WALL, np.uint8)
    mouth.draw(frame, face, 0)
    crown = mouth.places(face)[: len(modelled_teeth(resting_mouth(rest, rest), True).vertices), 1]
    line = frame[int(crown.max()) - 5].astype(float).sum(axis=1)
    middle, half = float(face[13, 0]), float(np.ptp(face[list(LIPS_INNER), 0])) / 2
    for side in (-1, 1):
        near, aside = (
            line[np.rint(middle + side * half * np.linspace(*shares, 20)).astype(int)].max()
            for shares in ((0.3, 0.5), (0.72, 0.85))
        )
        assert aside < 0.78 * near
    x = np.arange(int(middle - 0.9 * half), int(middle + 0.9 * half))
    gaps = (line[x] < line[x - 1]) & (line[x] <= line[x + 1]) & (line[x] < 0.9 * (line[x - 2] + line[x + 2]) / 2)
    assert (np.abs(x[gaps] - middle) > 0.4 * half).sum() >= 3


def test_a_tongue_is_arched_and_ends_in_the_dark() -> None:
    """The middle of its back is higher than what is halfway to its sides; and there it is as dark as the bag behind."""
    part = tongue(resting_mouth(front(0.0), front(0.0)))
    back = (part.uv[:, 0] > 0.35) & (part.uv[:, 0] < 0.65)
    middle, aside = (
        part.vertices[back & (part.uv[:, 1] > low) & (part.uv[:, 1] < low + 0.2), 1] for low in (-0.1, 0.6)
    )
    assert middle.min() < aside.min() - 0.06, "y is down"
    colours = mouth_colours(picture((200, 150, 130)), seen(front(0.0)))
    along = colours.tongue[0].astype(float).sum(axis=-1)
    assert along[-1] < 0.35 * along[0] and abs(along[-1] - colours.bag[8, -1].astype(float).sum()) < 30


def test_a_tongue_is_dark_where_its_arch_is_highest_and_nothing_cuts_it_off() -> None:
    """What is seen of it from before ends at the top of its arch, with the dark of the bag behind."""
    part = tongue(resting_mouth(front(0.0), front(0.0)))
    middle = part.uv[:, 1] < 0.2
    crest = float(part.uv[middle][part.vertices[middle, 1].argmin(), 0])
    colours = mouth_colours(picture((200, 150, 130)), seen(front(0.0)))
    along = colours.tongue[0].astype(float).sum(axis=-1)
    behind = colours.bag[8, 32:].astype(float).sum(axis=-1).mean()
    left = (along[round(crest * 63)] - behind) / (along[0] - behind)
    assert 0.2 < left < 0.6, "a tongue, but no block of one"
    below_edges = part.vertices[:, 1].min() - (front(0.0)[13, 1] - OVERBITE_EYE_DISTANCES)
    assert below_edges > -0.02, "and lies behind the lower teeth, not above them"


def test_a_row_of_teeth_is_seen_as_crowns_or_not_at_all(mouth: ModelledMouth) -> None:
    """A lip that leaves a few pixels of them covers these; one that is drawn up further covers none."""
    row = len(modelled_teeth(resting_mouth(front(0.0), front(0.0)), True).vertices)
    lowest = []
    for down in (0.02, 0.035, 0.045, 0.06, 0.08):  # so little is seen below a lip that hangs lower
        face = front(0.3)
        face[13, 1] += 0.06 - down
        lowest.append((mouth.places(seen(face))[:row, 1].max() - seen(face)[13, 1]) / EYES)
    assert max(lowest[:2]) < 0
    assert lowest[1] < lowest[2] < lowest[3]
    np.testing.assert_allclose(np.diff(lowest[3:]), 0.02, atol=2e-3)
    assert stubs(STUB_EYE_DISTANCES[1]) == 0 == stubs(1.0)


def test_a_palate_comes_down_to_the_throat_and_grows_dark_there() -> None:
    """Behind an opening its roof is seen, and not a wall of one dark colour; and the bag has room however near the lips are."""
    for angle in (0.0, 0.3, 0.6):
        lips = front(angle)[list(LIPS_INNER)]
        rings = mouth_bag(lips)[:-1].reshape(-1, *lips.shape)
        roof, floor = rings[:, 1:10, 1].min(axis=1), rings[:, 11:, 1].max(axis=1)
        assert roof[-2] < roof[0] < roof[-1], "above the upper lip, and from there down into the opening"
        assert (floor[1:] > roof[1:] + 0.1).all()
    depth = bag_surface()[1][:, 0].reshape(-1)[[(len(BAG_RINGS) - 2) * len(LIPS_INNER), -len(LIPS_INNER) - 1]]
    ramp = mouth_colours(picture((200, 150, 130)), seen(front(0.0))).bag[0].astype(float).sum(axis=-1)
    before, behind = ramp[np.rint(63 * depth).astype(int)]
    assert before > 1.7 * behind


def test_rounded_lips_narrow_the_opening_alone() -> None:
    """The bag behind them is as wide as the mouth, so that its walls do not cut off the tongue."""
    lips = front(0.3)[list(LIPS_INNER)]
    rounded = lips * (0.5, 1, 1)
    width = float(np.ptp(lips[:, 0]))
    bag = mouth_bag(rounded, width=width)
    np.testing.assert_allclose(bag[: len(lips)], rounded, atol=1e-12)
    assert np.ptp(bag[len(lips) : 2 * len(lips), 0]) >= width


def test_the_further_lips_part_the_more_light_falls_behind_them() -> None:
    """Between lips that hardly do is no plug as light as a tongue in a wide mouth."""
    light = [inside_light(seen(front(angle))) for angle in (0.0, 0.05, 0.15, 0.6)]
    assert light == sorted(light) and light[0] < 0.4 and light[-1] > 0.95


def test_of_the_lower_row_only_the_front_is_there() -> None:
    """Molars beside the tongue would be specks in the dark."""
    rows = [modelled_teeth(resting_mouth(front(0.0), front(0.0)), upper).vertices for upper in (True, False)]
    upper, lower = (float(np.ptp(row[:, 2])) for row in rows)
    assert lower < 0.3 < upper


def test_no_more_of_the_rows_is_seen_than_the_driver_shows(mouth: ModelledMouth) -> None:
    at = resting_mouth(front(0.0), front(0.0))
    face = seen(front(0.3))
    upper = len(modelled_teeth(at, True).vertices)
    whole, less = (mouth.places(face, shown)[:upper, 1].max() - face[13, 1] for shown in ((1.0, 1.0), (0.1, 1.0)))
    assert whole > 4 and less <= 0.1 * (face[14, 1] - face[13, 1])
    lowered = front(0.3)
    lowered[14, 1] += 0.2
    some, none = (jaw_behind_lips(at, lowered, shown).angle for shown in (1.0, 0.0))
    assert none > some + 0.01
