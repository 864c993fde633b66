"""Bundle adjustment finds the cameras again from which the pixels were made."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_orbit import SIZE, observed, orbit
from scipy.spatial.transform import Rotation

from engine.geometry.multiview.bundle import Bundle, Observations, reprojection_errors, undistorted
from engine.geometry.multiview.bundle_adjustment import Freedom, adjust
from engine.geometry.multiview.schur_complement import linearise
from engine.geometry.registration.rigid import Similarity, fit_similarity


def shaken(bundle: Bundle, turn: float, shift: float, focal: float = 1.0, seed: int = 5) -> Bundle:
    """Cameras turned by about so many radians and shifted by so many metres, points shifted, the focal length scaled."""
    random = np.random.default_rng(seed)
    turns = Rotation.from_rotvec(turn * random.standard_normal((len(bundle.rotations), 3))).as_matrix()
    return replace(
        bundle,
        rotations=turns @ bundle.rotations,
        translations=bundle.translations + shift * random.standard_normal(bundle.translations.shape),
        points=bundle.points + shift * random.standard_normal(bundle.points.shape),
        lenses=bundle.lenses * [focal, 0, 0],
    )


def eye_errors(found: Bundle, truth: Bundle) -> np.ndarray:
    """(C,) metres between eyes, once the found ones lie on the true ones as well as a similarity can make them."""
    return np.linalg.norm(fit_similarity(found.eyes, truth.eyes)(found.eyes) - truth.eyes, axis=1)


def test_errors_are_distances_from_where_a_camera_sees_points() -> None:
    bundle = orbit(3, 20)
    seen = observed(bundle)
    assert reprojection_errors(bundle, seen) == pytest.approx(0, abs=1e-9)
    moved = Observations(seen.camera, seen.point, seen.pixels + np.array([3.0, 4.0]))
    assert reprojection_errors(bundle, moved) == pytest.approx(5.0)
    behind = replace(bundle, points=-1e3 * bundle.rotations[:, 2][seen.camera[:1]])
    assert (
        reprojection_errors(behind, Observations(seen.camera[:1], np.zeros(1, np.intp), seen.pixels[:1]))[0] == np.inf
    )


def test_undistorted_pixels_lie_on_the_plane_at_distance_one() -> None:
    bundle = orbit(3, 20)
    camera = bundle.camera(1, SIZE)
    pixels = camera.project(bundle.points[:20], np.float64)[:, :2]
    inside = bundle.points[:20] @ bundle.rotations[1].T + bundle.translations[1]
    flat = undistorted(pixels, bundle.lenses[0], bundle.centres[0])
    np.testing.assert_allclose(flat, inside[:, :2] / inside[:, 2:], atol=1e-9)


def test_a_bundle_in_another_frame_shows_the_same_pictures() -> None:
    bundle = orbit(4, 30)
    turn = Rotation.from_rotvec([0.3, -0.8, 0.2]).as_matrix()
    moved = bundle.moved(Similarity(2.5 * turn, np.array([1.0, -2.0, 0.5])))
    assert reprojection_errors(moved, observed(bundle)) == pytest.approx(0, abs=1e-8)


def test_jacobians_are_the_slopes_of_residuals() -> None:
    bundle = orbit(2, 5)
    turn, shift, lens, point = bundle.rotations[1], bundle.translations[1], bundle.lenses[0], bundle.points[2]
    offset, jacobian, residual, step = np.array([3.0, -2.0]), np.zeros((2, 12)), np.zeros(2), 1e-6
    assert linearise(turn, shift, lens, point, offset, jacobian, residual)
    for k in range(12):
        ends = []
        for sign in (1, -1):
            change = np.zeros(12)
            change[k] = sign * step
            small = Rotation.from_rotvec(change[:3]).as_matrix()
            there, unused = np.zeros(2), np.zeros((2, 12))
            linearise(
                *(small @ turn, small @ shift + change[3:6], lens + change[6:9], point + change[9:], offset),
                *(unused, there),
            )
            ends.append(there)
        assert jacobian[:, k] == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=1e-5, abs=1e-4)


def test_without_noise_cameras_and_lens_are_found_exactly() -> None:
    truth = orbit()
    start = shaken(truth, 0.01, 0.02, focal=1.1)
    result = adjust(start, observed(truth), Freedom(np.ones(12, np.bool_), (True, True, True)), 1e3, 200, 1e-14)
    assert reprojection_errors(result.bundle, observed(truth)).max() < 1e-4
    assert eye_errors(result.bundle, truth).max() < 1e-6
    np.testing.assert_allclose(result.bundle.lenses, truth.lenses, rtol=1e-5)


def test_noise_of_a_pixel_moves_cameras_as_far_as_its_covariance_says() -> None:
    """The errors, measured by their own covariance, are normal: their mean square is 1. With two cameras fixed at the
    truth the frame is determined; the covariance is the inverse of the dense normal matrix, slopes by differences."""
    truth = orbit(6, 40)
    exact, sigma = observed(truth), 0.2
    free = np.arange(6) >= 2
    squares = []
    inverse = np.linalg.inv(dense_normal_matrix(truth, exact, free))[: 6 * 4, : 6 * 4] * sigma**2
    for seed in range(6):
        noisy = observed(truth, sigma, seed)
        found = adjust(truth, noisy, Freedom(free), 100.0, 30, 1e-12).bundle
        turns = found.rotations[free] @ truth.rotations[free].transpose(0, 2, 1)
        shifts = found.translations[free] - np.einsum("cij,cj->ci", turns, truth.translations[free])
        error = np.concatenate([Rotation.from_matrix(turns).as_rotvec(), shifts], axis=1).ravel()
        squares.append(error @ np.linalg.solve(inverse, error) / len(error))
    assert np.mean(squares) == pytest.approx(1, abs=0.4)  # 144 squares of unit normals: 0.12 is one sigma


def dense_normal_matrix(bundle: Bundle, seen: Observations, free: np.ndarray) -> np.ndarray:
    """J'J over the free cameras' six parameters, then all points' three."""
    slots = np.cumsum(free) - 1
    first = 6 * int(free.sum())
    rows = np.zeros((2 * len(seen), first + 3 * len(bundle.points)))
    jacobian, residual = np.zeros((2, 12)), np.zeros(2)
    for o, (c, p) in enumerate(zip(seen.camera, seen.point, strict=True)):
        linearise(
            *(bundle.rotations[c], bundle.translations[c], bundle.lenses[0], bundle.points[p], np.zeros(2)),
            *(jacobian, residual),
        )
        if free[c]:
            rows[2 * o : 2 * o + 2, 6 * slots[c] : 6 * slots[c] + 6] = jacobian[:, :6]
        rows[2 * o : 2 * o + 2, first + 3 * p : first + 3 * p + 3] = jacobian[:, 9:]
    used = np.r_[np.ones(first, np.bool_), np.repeat(np.isin(np.arange(len(bundle.points)), seen.point), 3)]
    return (rows.T @ rows)[np.ix_(used, used)]


def test_gross_errors_hardly_count() -> None:
    truth = orbit()
    seen = observed(truth, 0.3)
    random = np.random.default_rng(3)
    wrong = random.random(len(seen)) < 0.1
    pixels = np.where(wrong[:, None], seen.pixels + random.uniform(-60, 60, (len(seen), 2)), seen.pixels)
    result = adjust(
        shaken(truth, 0.002, 0.003), Observations(seen.camera, seen.point, pixels), Freedom(np.ones(12, np.bool_))
    )
    plain = adjust(shaken(truth, 0.002, 0.003), seen, Freedom(np.ones(12, np.bool_)))
    assert eye_errors(result.bundle, truth).mean() < 2 * eye_errors(plain.bundle, truth).mean()
    assert eye_errors(plain.bundle, truth).mean() < 0.003


def test_what_is_not_free_stays() -> None:
    truth = orbit()
    free = np.arange(12) >= 10
    start = shaken(truth, 0.005, 0.01)
    result = adjust(start, observed(truth), Freedom(free)).bundle
    assert np.array_equal(result.rotations[~free], start.rotations[~free])
    assert np.array_equal(result.lenses, start.lenses)
    assert not np.array_equal(result.rotations[free], start.rotations[free])


def test_nothing_observed_is_an_error() -> None:
    nothing = Observations(np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros((0, 2)))
    with pytest.raises(ValueError, match="nothing"):
        adjust(orbit(2, 5), nothing, Freedom(np.ones(2, np.bool_)))
