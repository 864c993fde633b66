"""The membrane is held against a direct solve of the same equations."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg

from engine.imaging.filling.poisson import membrane, poisson_blend

HEIGHT, WIDTH = 80, 120


def direct_solution(values: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """Laplace's equation in the mask by a sparse direct solver; free at the array's border."""
    number = np.full(mask.shape, -1)
    ys, xs = np.nonzero(mask)
    number[ys, xs] = np.arange(len(ys))
    matrix = scipy.sparse.lil_matrix((len(ys), len(ys)))
    right = np.zeros((len(ys), values.shape[2]))
    for i, (y, x) in enumerate(zip(ys, xs, strict=True)):
        for ny, nx in ((y - 1, x), (y + 1, x), (y, x - 1), (y, x + 1)):
            if not (0 <= ny < mask.shape[0] and 0 <= nx < mask.shape[1]):
                continue
            matrix[i, i] += 1
            if mask[ny, nx]:
                matrix[i, number[ny, nx]] -= 1
            else:
                right[i] += values[ny, nx]
    solution = np.zeros(values.shape)
    solution[ys, xs] = scipy.sparse.linalg.spsolve(matrix.tocsc(), right).reshape(len(ys), -1)
    return solution


def lips() -> np.ndarray:
    outline = [[5, 40], [30, 20], [55, 26], [60, 28], [65, 26], [90, 20], [115, 40], [90, 55], [60, 66], [30, 55]]
    return cv2.fillPoly(np.zeros((HEIGHT, WIDTH), np.uint8), [np.array(outline)], 1) > 0


def thin_lips() -> np.ndarray:
    outline = [[5, 40], [30, 37], [90, 37], [115, 40], [90, 43], [30, 43]]
    return cv2.fillPoly(np.zeros((HEIGHT, WIDTH), np.uint8), [np.array(outline)], 1) > 0


def blots(rng: np.random.Generator) -> np.ndarray:
    noise = cv2.GaussianBlur(rng.normal(size=(HEIGHT, WIDTH)), (0, 0), 5)
    mask = noise > np.percentile(noise, 40)
    mask[[0, -1]] = mask[:, [0, -1]] = False
    return mask


def smooth_values(rng: np.random.Generator, scale: float = 8) -> np.ndarray:
    """Differences of 15 grey levels in the mean that change over `scale` pixels."""
    noise = cv2.GaussianBlur(rng.normal(size=(HEIGHT, WIDTH, 3)), (0, 0), scale)
    return (20 + 15 * noise / noise.std()).astype(np.float32)


@pytest.mark.parametrize("shape", ["lips", "thin_lips", "blots", "rectangle"])
def test_membrane_is_within_a_grey_level_of_the_direct_solution(shape: str) -> None:
    rng = np.random.default_rng(3)
    rectangle = np.zeros((HEIGHT, WIDTH), bool)
    rectangle[2:-2, 2:-2] = True
    mask = {"lips": lips, "thin_lips": thin_lips, "rectangle": lambda: rectangle}.get(shape, lambda: blots(rng))()
    values = smooth_values(rng)
    truth = direct_solution(values, mask)
    found = membrane(values, mask)
    assert np.abs(found - truth)[mask].max() < 0.2
    assert not found[~mask].any()
    better = membrane(values, mask, cycles=6)
    assert np.abs(better - truth)[mask].max() < 0.01


def test_mask_may_touch_the_border_where_the_membrane_is_free() -> None:
    mask = np.zeros((40, 60), bool)
    mask[:20, 10:50] = True
    values = np.broadcast_to(np.linspace(0, 59, 60, dtype=np.float32)[None, :, None], (40, 60, 1))
    found = membrane(values, mask, cycles=12)
    # a ramp along the border is harmonic and has no flow across it
    np.testing.assert_allclose(found[mask], values[mask], atol=0.05)


def test_constant_difference_gives_a_constant_membrane() -> None:
    mask = lips()
    found = membrane(np.full((HEIGHT, WIDTH, 3), 17.5, np.float32), mask)
    np.testing.assert_allclose(found[mask], 17.5, atol=1e-3)


def test_membrane_is_linear_and_keeps_between_the_extremes_of_its_edge() -> None:
    rng = np.random.default_rng(5)
    mask, first, second = lips(), smooth_values(rng), smooth_values(rng, 20)
    both = membrane(2 * first - second, mask, cycles=6)
    np.testing.assert_allclose(both, 2 * membrane(first, mask, cycles=6) - membrane(second, mask, cycles=6), atol=0.02)
    ring = (cv2.dilate(mask.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0) & ~mask
    found = membrane(first, mask, cycles=6)[mask]
    assert found.min() >= first[ring].min() - 0.01
    assert found.max() <= first[ring].max() + 0.01


def test_values_far_from_the_mask_do_not_matter() -> None:
    mask = lips()
    values = smooth_values(np.random.default_rng(6))
    far = cv2.dilate(mask.astype(np.uint8), np.ones((3, 3), np.uint8)) == 0
    spoiled = np.where(far[..., None], np.float32(1e6), values).astype(np.float32)
    np.testing.assert_array_equal(membrane(values, mask), membrane(spoiled, mask))


def test_empty_and_full_masks() -> None:
    values = smooth_values(np.random.default_rng(7))
    assert not membrane(values, np.zeros((HEIGHT, WIDTH), bool)).any()
    assert not membrane(values, np.ones((HEIGHT, WIDTH), bool)).any()  # nothing outside holds it


def test_blend_takes_texture_from_the_source_and_colour_from_the_target() -> None:
    rng = np.random.default_rng(8)
    mask = lips()
    target = smooth_values(rng, 25) + 80
    texture = rng.normal(0, 4, (HEIGHT, WIDTH, 1)).astype(np.float32)
    texture[~cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool)] = 0
    blended = poisson_blend(texture + 200, target, mask)
    np.testing.assert_array_equal(blended[~mask], target[~mask])
    # the same gradients as the source: the difference is harmonic, so equal to the membrane of the target
    smooth = direct_solution(target, mask)
    assert np.abs(blended - texture - smooth)[mask].max() < 0.3


def test_what_is_already_there_stays() -> None:
    target = smooth_values(np.random.default_rng(9))
    np.testing.assert_allclose(poisson_blend(target, target, lips()), target, atol=1e-4)
