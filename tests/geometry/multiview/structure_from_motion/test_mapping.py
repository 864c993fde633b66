"""Cameras out of matches: those from which the pixels were made come back, whatever the focal length was taken to be."""

from __future__ import annotations

import numpy as np
import pytest
from made_orbit import SIZE, observed, orbit

from engine.geometry.multiview.bundle import Bundle
from engine.geometry.multiview.structure_from_motion.mapping import Lens, Reconstruction, reconstruct
from engine.geometry.multiview.structure_from_motion.poses import relative_pose, resection
from engine.geometry.multiview.structure_from_motion.tracks import PairMatches, join_tracks
from engine.geometry.multiview.structure_from_motion.triangulation import triangulate
from engine.geometry.registration.rigid import fit_similarity

CENTRE = np.array([SIZE[1] / 2 - 0.5, SIZE[0] / 2 - 0.5])


def test_tracks_are_what_matches_connect() -> None:
    """By hand: 0-1 and 1-2 join three pictures; the last match would give the second track two features of picture 0."""
    pairs = [
        PairMatches(0, 1, np.array([[0, 5], [1, 6]])),
        PairMatches(1, 2, np.array([[5, 7], [6, 8]])),
        PairMatches(0, 2, np.array([[2, 8]])),
    ]
    tracks = join_tracks(pairs, [10, 10, 10])
    found = sorted(zip(tracks.track.tolist(), tracks.image.tolist(), tracks.feature.tolist(), strict=True))
    assert tracks.count == 2
    assert found == [(0, 0, 0), (0, 1, 5), (0, 2, 7), (1, 0, 1), (1, 1, 6), (1, 2, 8)]
    assert join_tracks([], [3, 3]).count == 0


def matched(bundle: Bundle, noise: float, wrong: float, reach: int = 4) -> tuple[list, list[PairMatches]]:
    """Features of each camera's picture and matches to the next `reach` around the circle, a share of them wrong."""
    seen, count = observed(bundle, noise), len(bundle.rotations)
    random = np.random.default_rng(11)
    features = [seen.pixels[seen.camera == c] for c in range(count)]
    names = [seen.point[seen.camera == c] for c in range(count)]
    pairs = []
    for a in range(count):
        for b in {(a + step) % count for step in range(1, reach + 1)} - {a}:
            _, i, j = np.intersect1d(names[a], names[b], return_indices=True)
            astray = random.random(len(i)) < wrong
            j = np.where(astray, random.permutation(j), j)
            pairs.append(PairMatches(a, b, np.stack([i, j], axis=1)))
    return features, pairs


def eye_errors(found: Reconstruction, truth: Bundle) -> np.ndarray:
    eyes, true = found.bundle.eyes[found.registered], truth.eyes[found.registered]
    return np.linalg.norm(fit_similarity(eyes, true)(eyes) - true, axis=1)


@pytest.mark.parametrize("guess", [380.0, 520.0, 768.0])
def test_an_orbit_is_found_with_its_lens(guess: float) -> None:
    """768 is 1.2 times the longer side, the usual guess; with 0.3 pixels of noise and 1% of the matches wrong."""
    truth = orbit(24, 150)
    features, pairs = matched(truth, 0.3, 0.01)
    found = reconstruct(features, pairs, Lens(np.array([guess, 0, 0]), CENTRE))
    assert found is not None and found.registered.all()
    assert eye_errors(found, truth).max() < 0.003
    assert found.bundle.lenses[0, 0] == pytest.approx(520, rel=0.005)


def test_without_noise_all_is_exact() -> None:
    truth = orbit(16, 100)
    features, pairs = matched(truth, 0.0, 0.0)
    found = reconstruct(features, pairs, Lens(truth.lenses[0], truth.centres[0], known=True))
    assert found is not None and found.registered.all()
    assert np.array_equal(found.bundle.lenses, truth.lenses)
    assert eye_errors(found, truth).max() < 1e-4


def test_half_an_orbit_does() -> None:
    truth = orbit(12, 150, turn=np.pi)
    features, pairs = matched(truth, 0.3, 0.02)
    pairs = [pair for pair in pairs if abs(pair.first - pair.second) < 5]
    found = reconstruct(features, pairs, Lens(np.array([768.0, 0, 0]), CENTRE))
    assert found is not None and found.registered.all()
    assert eye_errors(found, truth).max() < 0.02


def test_a_picture_of_something_else_is_left_out() -> None:
    truth = orbit(10, 150)
    features, pairs = matched(truth, 0.3, 0.0)
    features.append(np.random.default_rng(0).uniform(0, 360, (80, 2)))
    pairs.append(PairMatches(0, 10, np.stack([np.arange(40), np.arange(40)], axis=1)))
    found = reconstruct(features, pairs, Lens(truth.lenses[0], CENTRE, known=True))
    assert found is not None
    assert found.registered.tolist() == [True] * 10 + [False]


def test_pictures_without_anything_in_common_give_nothing() -> None:
    nowhere = np.zeros((5, 2))
    assert reconstruct([nowhere, nowhere], [], Lens(np.array([500.0, 0, 0]), CENTRE)) is None


def test_poses_are_found_among_wrong_matches() -> None:
    truth = orbit(8, 200)
    random = np.random.default_rng(2)
    flat = []
    for c in (0, 1):
        at = truth.points[:200] @ truth.rotations[c].T + truth.translations[c]
        flat.append(at[:, :2] / at[:, 2:])
    flat[1][:40] = random.uniform(-0.3, 0.3, (40, 2))
    pose = relative_pose(flat[0], flat[1], 1e-3)
    turn = truth.rotations[1] @ truth.rotations[0].T
    shift = truth.translations[1] - turn @ truth.translations[0]
    assert pose is not None and pose.agreed[40:].all() and pose.agreed[:40].sum() < 4
    np.testing.assert_allclose(pose.rotation, turn, atol=1e-4)
    np.testing.assert_allclose(pose.translation, shift / np.linalg.norm(shift), atol=1e-3)
    placed = resection(truth.points[:200], flat[1], 1e-3)
    assert placed is not None and placed.agreed[40:].all() and not placed.agreed[:40].any()
    np.testing.assert_allclose(placed.rotation, truth.rotations[1], atol=1e-6)
    np.testing.assert_allclose(placed.translation, truth.translations[1], atol=1e-6)
    assert resection(truth.points[:5], flat[0][:5], 1e-3) is None


def test_a_point_is_what_most_rays_agree_on() -> None:
    """Five views, one of which looks elsewhere; and a track under too small an angle gives no point."""
    truth = orbit(24, 10)
    views = np.array([0, 1, 2, 3, 4])
    at = np.einsum("cij,j->ci", truth.rotations[views], truth.points[3]) + truth.translations[views]
    flat = at[:, :2] / at[:, 2:]
    flat[2] += 0.1
    poses = truth.rotations, truth.translations
    found = triangulate(poses, views, flat, np.array([0, 5]), 1e-3, np.radians(2))
    np.testing.assert_allclose(found.points[0], truth.points[3], atol=1e-9)
    assert found.agreed.tolist() == [True, True, False, True, True]
    narrow = triangulate(poses, views[:2], flat[:2], np.array([0, 2]), 1e-3, np.radians(40))
    assert np.isnan(narrow.points).all() and not narrow.agreed.any()
