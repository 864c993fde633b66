"""The floor between legs, which all masks let in alike, is told by what it looks like."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.foot_masks import FootFrame
from engine.avatar.capture.leg_gaps import without_gaps
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import rasterise
from tests.avatar.capture.standing_scene import BOX, FACES, LEG, floor_colours

LEGS = SpatialLandmarks(
    {
        f"{side}{name}": np.array([at, height, 0.0])
        for side, at in (("Left", 0.11), ("Right", -0.11))
        for name, height in (("Hip", 0.75), ("Knee", 0.4), ("Ankle", 0.05))
    }
)
APART = np.array([0.11, 0.0, 0.0])


def frame(turn: float, seed: int, legs: tuple[int, int, int] = LEG) -> tuple[FootFrame, NDArray[np.bool_]]:
    """Two legs without any feet on a patterned floor; a mask that has all that lies between them, and the true one."""
    lens = Camera((0.0, 0.0, 0.0), 220.0, (79.5, 89.5), (180, 160))
    camera = lens.aimed([2 * np.sin(turn), 1.5, 2 * np.cos(turn)], (0.0, 0.35, 0.0))
    y, x = np.indices(camera.size, float)
    rays = camera.rays(np.stack([x, y], -1).reshape(-1, 2))
    at = np.array(camera.eye) - (1.5 / rays[:, 1])[:, None] * rays
    image = floor_colours(at[:, 0], at[:, 2]).reshape(*camera.size, 3)
    leg = BOX * [1.2, 9.5, 0.45]
    both = np.concatenate([leg + APART, leg - APART])
    faces = np.concatenate([FACES, FACES + len(BOX)])
    true = rasterise(camera.project(both), faces, camera.size, perspective=True).triangle >= 0
    across = BOX * [3.6, 9.5, 0.45]
    mask = true | (rasterise(camera.project(across), FACES, camera.size, perspective=True).triangle >= 0)
    image[true] = legs
    image += np.random.default_rng(seed).normal(0, 3, image.shape)
    return FootFrame(image.clip(0, 255).astype(np.uint8), mask, camera, camera), true


def shown(legs: tuple[int, int, int] = LEG) -> list[tuple[FootFrame, NDArray[np.bool_]]]:
    return [frame(turn, seed, legs) for seed, turn in enumerate(np.arange(16) * np.pi / 8)]


def test_the_floor_between_legs_is_taken_out_of_masks_and_legs_are_not() -> None:
    frames = shown()
    let_in = sum(np.count_nonzero(one.mask & ~true) for one, true in frames)
    masks = without_gaps([one for one, _ in frames], LEGS)
    left = sum(np.count_nonzero(mask & ~true) for mask, (_, true) in zip(masks, frames, strict=True))
    lost = sum(np.count_nonzero(~mask & true) for mask, (_, true) in zip(masks, frames, strict=True))
    assert let_in > 2000
    assert left < 0.35 * let_in  # above hips and below ankles nothing is looked for
    assert lost < 0.02 * sum(np.count_nonzero(true) for _, true in frames)


def test_masks_stay_without_landmarks_of_legs() -> None:
    frames = [one for one, _ in shown()]
    lacking = SpatialLandmarks({name: at for name, at in LEGS.body.items() if name != "LeftKnee"})
    for mask, one in zip(without_gaps(frames, lacking), frames, strict=True):
        np.testing.assert_array_equal(mask, one.mask)


def test_nothing_is_taken_away_about_a_hand() -> None:
    frames = [one for one, _ in shown()]
    knuckles = {"LeftIndex": np.array([0.01, 0.4, 0.0]), "LeftPinky": np.array([-0.01, 0.4, 0.0])}
    masks = without_gaps(frames, SpatialLandmarks(LEGS.body | knuckles))
    plain = without_gaps(frames, LEGS)
    hand = np.array([[0.0, 0.4, 0.0]])
    saved = 0
    for one, mask, without in zip(frames, masks, plain, strict=True):
        at, reach = one.person.project(hand)[0, :2], 0.1 * one.person.focal / one.person.depth(hand)[0]
        y, x = np.indices(mask.shape)
        near = np.hypot(x - at[0], y - at[1]) < reach
        np.testing.assert_array_equal(mask[near], one.mask[near])
        saved += np.count_nonzero(near & one.mask & ~without)
    assert saved > 200
