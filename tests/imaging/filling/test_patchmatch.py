"""Patches that are alike, against every one of them compared."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.imaging.filling.patchmatch import (
    MAX_COLOUR_SHIFT_GREY_LEVELS,
    PATCH_RADIUS_PIXELS,
    PATCH_SIDE_PIXELS,
    SHIFT_COST,
    PatchField,
    colour_image,
    colour_planes,
    patch_distance,
    take_target,
    valid_centres,
)

HEIGHT, WIDTH = 24, 30


def noise(seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(40, 210, (HEIGHT, WIDTH, 3)).astype(np.float32)


def patch(image: np.ndarray, y: int, x: int) -> np.ndarray:
    return image[
        y - PATCH_RADIUS_PIXELS : y + PATCH_RADIUS_PIXELS + 1, x - PATCH_RADIUS_PIXELS : x + PATCH_RADIUS_PIXELS + 1
    ]


def distance(image: np.ndarray, weight: np.ndarray, one: tuple[int, int], other: tuple[int, int]) -> float:
    """The weighted mean squared difference; of a shift of the mean that is allowed only a share counts."""
    w = patch(weight, *one)[..., None]
    difference = patch(image, *one) - patch(image, *other)
    mean = (w * difference).sum((0, 1)) / w.sum()
    shifted = difference - np.clip(mean, -MAX_COLOUR_SHIFT_GREY_LEVELS, MAX_COLOUR_SHIFT_GREY_LEVELS)
    whole, left = ((w * d**2).sum() / w.sum() for d in (difference, shifted))
    return float(left + SHIFT_COST * (whole - left))


def halves() -> tuple[np.ndarray, np.ndarray]:
    """Centres of targets at the left, and of sources at the right."""
    inside, left = valid_centres(np.ones((HEIGHT, WIDTH), np.bool_)), np.zeros((HEIGHT, WIDTH), np.bool_)
    left[:, :10] = True
    return inside & left, valid_centres(~left)


def test_planes_are_the_image_and_back() -> None:
    np.testing.assert_array_equal(colour_image(colour_planes(noise())), noise())


def test_centres_are_those_whose_whole_patch_is_usable() -> None:
    usable = np.random.default_rng(1).random((HEIGHT, WIDTH)) < 0.98
    found = valid_centres(usable)
    for y in range(HEIGHT):
        for x in range(WIDTH):
            whole = (
                PATCH_RADIUS_PIXELS <= y < HEIGHT - PATCH_RADIUS_PIXELS
                and PATCH_RADIUS_PIXELS <= x < WIDTH - PATCH_RADIUS_PIXELS
            )
            assert found[y, x] == (whole and patch(usable, y, x).all())


@pytest.mark.parametrize("brighter", [0.0, 15.0, 60.0])
def test_a_distance_is_what_is_left_after_a_shift_of_colour_that_costs_some(brighter: float) -> None:
    image = noise()
    image[:, 15:] += brighter
    weight = np.random.default_rng(2).uniform(0.1, 1, (HEIGHT, WIDTH)).astype(np.float32)
    target = np.zeros((4, PATCH_SIDE_PIXELS, 8), np.float32)
    planes = colour_planes(image)
    for one, other in (((5, 6), (17, 24)), ((12, 4), (9, 22)), ((8, 8), (8, 9))):
        mass = take_target(planes, weight, *one, target)
        found = patch_distance(planes, target, mass, *other)
        assert found == pytest.approx(distance(image, weight, one, other), rel=1e-4)


def test_after_many_tries_nearly_all_have_the_best_there_is_and_never_a_better() -> None:
    image, weight = cv2.GaussianBlur(noise(3), (0, 0), 2), np.ones((HEIGHT, WIDTH), np.float32)
    targets, sources = halves()
    field = PatchField.start(targets, sources, seed=1)
    planes = colour_planes(image)
    field.match(planes, weight, sweeps=2, random_tries=1, seed=0)
    early = field.cost[targets].mean()
    field.match(planes, weight, sweeps=200, random_tries=8, seed=1)
    best = np.array([
        min(distance(image, weight, (y, x), (sy, sx)) for sy, sx in np.argwhere(sources))
        for y, x in np.argwhere(targets)
    ])  # fmt: skip
    found = field.cost[targets]
    assert (found >= best * (1 - 1e-3)).all() and found.mean() < early
    assert np.isclose(found, best, rtol=1e-3).mean() > 0.9
    for (y, x), (sy, sx), cost in zip(np.argwhere(targets), field.nearest[targets], found, strict=True):
        assert sources[sy, sx] and cost == pytest.approx(distance(image, weight, (y, x), (sy, sx)), rel=1e-4)


def test_a_field_begins_with_that_of_half_the_size_where_it_points_to_a_source() -> None:
    targets, sources = halves()
    nowhere = np.zeros((HEIGHT // 2, WIDTH // 2), np.bool_)
    nearest = np.zeros((HEIGHT // 2, WIDTH // 2, 2), np.int32)
    rows, columns = np.mgrid[: HEIGHT // 2, : WIDTH // 2]
    nearest[..., 0], nearest[..., 1] = rows, columns + 8  # sixteen pixels to the right at twice the size
    half = PatchField(nowhere, nowhere, nearest, np.zeros(nowhere.shape, np.float32))
    field = PatchField.start(targets, sources, 0, half)
    ys, xs = np.nonzero(targets)
    pointed = sources[ys, np.minimum(xs + 16, WIDTH - 1)]
    assert pointed.mean() > 0.9
    np.testing.assert_array_equal(field.nearest[ys, xs][pointed], np.stack([ys, xs + 16], 1)[pointed])
    assert sources[tuple(field.nearest[targets].T)].all()


def test_patches_that_agree_are_voted_for_and_what_is_no_hole_stays() -> None:
    """All patches over the hole point to their exact copies on the right: their votes are the copy."""
    image = noise(5)
    image[:, 15:25] = image[:, :10]
    planes, weight = colour_planes(image), np.ones((HEIGHT, WIDTH), np.float32)
    hole = np.zeros((HEIGHT, WIDTH), np.bool_)
    hole[10:14, 4:6] = True
    inside, _ = halves()
    sources = np.zeros_like(inside)
    sources[:, 18:22] = inside[:, 3:7]
    targets = np.zeros_like(inside)
    targets[:, 3:7] = inside[:, 3:7]
    field = PatchField.start(targets, sources, 0)
    rows, columns = np.nonzero(targets)
    field.nearest[rows, columns] = np.stack([rows, columns + 15], 1)
    field.match(planes, weight, sweeps=1, random_tries=0, seed=0)
    np.testing.assert_allclose(field.cost[targets], 0, atol=1e-3)
    for sharpness in (0.0, 10.0):
        np.testing.assert_allclose(field.vote(planes, weight, hole, sharpness), image, atol=0.02)
    spoiled = np.where(hole[..., None], np.float32(0), image)
    voted = field.vote(colour_planes(spoiled), weight * ~hole, hole, 10.0)
    np.testing.assert_allclose(voted, image, atol=0.02)
