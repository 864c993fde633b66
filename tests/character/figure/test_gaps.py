"""Gaps between arms and trunk, which whoever cuts people out fills."""

from __future__ import annotations

import cv2
import numpy as np

from engine.character.figure.gaps import gaps

WALL, SHIRT, SKIN, JEANS = (200, 90, 150), (40, 60, 160), (225, 180, 150), (30, 30, 60)
JOINTS = {
    **{"LeftShoulder": (250, 110), "LeftElbow": (310, 200), "LeftWrist": (262, 290), "LeftHip": (235, 290)},
    **{"RightShoulder": (150, 110), "RightElbow": (130, 200), "RightWrist": (125, 290), "RightHip": (165, 290)},
    **{"LeftIndex": (246, 296), "LeftPinky": (248, 304), "RightIndex": (121, 312), "RightPinky": (129, 312)},
    **{"LeftKnee": (235, 400), "LeftAnkle": (235, 500), "RightKnee": (165, 400), "RightAnkle": (165, 500)},
}


def person(
    behind: tuple[int, int, int] = WALL, joints: dict[str, tuple[int, int]] = JOINTS
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Somebody with one hand on the hip before a wall, or as their joints are: the picture, a mask without gaps, and the gap beside that arm."""
    rgb = np.full((560, 400, 3), behind, np.uint8)
    mask = np.zeros((560, 400), np.uint8)
    at = {name: np.array(place) for name, place in joints.items()}
    trunk = np.stack([at[name] for name in ("LeftShoulder", "RightShoulder", "RightHip", "LeftHip")]).astype(np.int32)
    arms = [
        np.stack([at[f"{s}{j}"] for j in ("Shoulder", "Elbow", "Wrist")]).astype(np.int32) for s in ("Left", "Right")
    ]
    legs = [np.stack([at[f"{s}{j}"] for j in ("Hip", "Knee", "Ankle")]).astype(np.int32) for s in ("Left", "Right")]
    for canvas, colours in ((rgb, (JEANS, SHIRT, SKIN)), (mask, ((1,), (1,), (1,)))):
        cv2.polylines(canvas, legs, False, colours[0], 44)
        cv2.fillPoly(canvas, [trunk], colours[1])
        cv2.polylines(canvas, [trunk], True, colours[1], 24)
        cv2.polylines(canvas, arms, False, colours[2], 26)
        cv2.circle(canvas, (200, 50), 32, colours[2], -1)
        cv2.line(canvas, (200, 60), (200, 110), colours[2], 24)
    beside = np.zeros(mask.shape, np.uint8)
    cv2.fillPoly(
        beside, [np.stack([at[f"Left{j}"] for j in ("Shoulder", "Elbow", "Wrist", "Hip")]).astype(np.int32)], (1,)
    )
    gap = (beside > 0) & (mask == 0)
    noise = np.random.default_rng(2).normal(0, 3, rgb.shape)
    return np.clip(rgb + noise, 0, 255).astype(np.uint8), np.asarray((mask > 0) | gap, np.float32), gap


def found(
    rgb: np.ndarray, mask: np.ndarray, belief: float = 0.6, joints: dict[str, tuple[int, int]] = JOINTS
) -> np.ndarray:
    return gaps(rgb, mask, np.float32(belief) * mask, lambda name: np.array(joints[name], np.float32))


def test_a_gap_is_found_to_its_edges_and_nothing_else() -> None:
    rgb, mask, gap = person()
    assert gap.sum() > 500
    share = found(rgb, mask)
    both = (share > 0.5) & gap
    assert both.sum() > 0.9 * ((share > 0.5) | gap).sum()
    assert share[~(cv2.dilate(gap.astype(np.uint8), np.ones((15, 15), np.uint8)) > 0)].max() == 0


def test_where_the_networks_are_sure_of_the_person_nothing_is_taken_away() -> None:
    rgb, mask, _ = person()
    assert found(rgb, mask, belief=1).max() == 0


def test_where_the_wall_is_like_the_shirt_nothing_is_taken_away() -> None:
    rgb, mask, _ = person(behind=SHIRT)
    assert found(rgb, mask).max() == 0


def test_what_shades_into_the_wall_s_colour_is_no_gap() -> None:
    dark, light = np.array((20, 20, 40)), np.array((70, 70, 90))
    rgb, mask, gap = person(behind=(20, 20, 40))
    away = cv2.distanceTransform(255 - gap.astype(np.uint8) * 255, cv2.DIST_L2, 5)[..., None]
    shaded = dark + (light - dark) * np.clip(away / 60, 0, 1)
    assert found(rgb, mask)[gap].mean() > 0.5
    assert found(np.where(mask[..., None] > 0, shaded, rgb).astype(np.uint8), mask).max() == 0


def test_a_mask_that_has_the_gap_or_nobody_stays_as_it_is() -> None:
    rgb, mask, gap = person()
    assert (found(rgb, np.where(gap, 0, mask).astype(np.float32)) * ~gap > 0.5).sum() == 0
    assert found(rgb, np.zeros_like(mask)).max() == 0


def test_a_gap_goes_on_where_the_joints_trunk_is_wider_than_the_person_s() -> None:
    rgb, mask, gap = person()
    wider = JOINTS | {"LeftHip": (255, 290), "LeftShoulder": (256, 110)}
    share = gaps(rgb, mask, np.float32(0.6) * mask, lambda name: np.array(wider[name], np.float32))
    assert ((share > 0.5) & gap).sum() > 0.9 * ((share > 0.5) | gap).sum()


def test_before_a_wall_nearly_as_white_as_the_shirt_a_gap_goes_to_its_edges() -> None:
    """What is found at first is its middle: the colours of wall and shirt say little. At the edges they change."""
    rgb, mask, gap = person(behind=(222, 222, 224))
    shirt = (np.abs(rgb.astype(int) - SHIRT).max(2) < 20) & ~gap
    noise = np.random.default_rng(3).normal(0, 6, rgb.shape)
    edge = shirt & (cv2.dilate((~shirt).astype(np.uint8), np.ones((5, 5), np.uint8)) > 0)
    for where, white in ((shirt, 236), (edge, 190)):
        rgb[where] = np.clip(white + noise, 0, 255)[where]
    share = found(rgb, mask)
    assert ((share > 0.5) & gap).sum() > 0.99 * ((share > 0.5) | gap).sum()


def test_in_a_gap_of_which_networks_waver_the_colours_close_by_have_to_say_less() -> None:
    """A wall that is lit beside one arm, nearly as light as the shirt, and dark elsewhere."""
    rgb, mask, gap = person(behind=(90, 100, 110))
    lit = gap.copy()
    lit[80:320, 250:] |= mask[80:320, 250:] == 0
    shirt = (np.abs(rgb.astype(int) - SHIRT).max(2) < 20) & ~gap
    noise = np.random.default_rng(4).normal(0, 6, rgb.shape)
    for where, white in ((lit, 230), (shirt, 236)):
        rgb[where] = np.clip(white + noise, 0, 255)[where]
    share = found(rgb, mask)
    assert ((share > 0.5) & gap).sum() > 0.95 * ((share > 0.5) | gap).sum()
    assert found(rgb, mask, belief=0.86).max() == 0


def test_a_hand_of_the_walls_colours_at_a_gaps_end_stays() -> None:
    lowered = {"LeftWrist": (300, 280), "LeftIndex": (297, 300), "LeftPinky": (303, 300), "LeftElbow": (312, 200)}
    rgb, mask, gap = person(joints=JOINTS | lowered)
    hand = cv2.line(np.zeros(mask.shape, np.uint8), (298, 296), (298, 322), (1,), 16) > 0
    rgb[hand] = WALL
    filled = np.maximum(mask, hand)
    filled[280:326, 255:300] = 1  # networks close the gap as far down as the hand reaches
    share = found(rgb, filled, joints=JOINTS | lowered)
    assert share[gap].mean() > 0.8 and share[290:320, 265:282].mean() > 0.8
    assert share[300:322, 296:301].mean() < 0.2
