"""Gaps between arms and trunk, which whoever cuts people out fills."""

from __future__ import annotations

import cv2
import numpy as np

from engine.character.gaps import gaps

WALL, SHIRT, SKIN, JEANS = (200, 90, 150), (40, 60, 160), (225, 180, 150), (30, 30, 60)
JOINTS = {
    **{"LeftShoulder": (250, 110), "LeftElbow": (310, 200), "LeftWrist": (262, 290), "LeftHip": (235, 290)},
    **{"RightShoulder": (150, 110), "RightElbow": (130, 200), "RightWrist": (125, 290), "RightHip": (165, 290)},
    **{"LeftKnee": (235, 400), "LeftAnkle": (235, 500), "RightKnee": (165, 400), "RightAnkle": (165, 500)},
}


def person(behind: tuple[int, int, int] = WALL) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Somebody with one hand on the hip before a wall: the picture, a mask without gaps, and the gap beside that arm."""
    rgb = np.full((560, 400, 3), behind, np.uint8)
    mask = np.zeros((560, 400), np.uint8)
    at = {name: np.array(place) for name, place in JOINTS.items()}
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


def found(rgb: np.ndarray, mask: np.ndarray, belief: float = 0.6) -> np.ndarray:
    return gaps(rgb, mask, np.float32(belief) * mask, lambda name: np.array(JOINTS[name], np.float32))


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
