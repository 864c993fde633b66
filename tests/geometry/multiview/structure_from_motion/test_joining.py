"""Two reconstructions of the same points, one of them in a frame of its own, from near, with poorly known distances or lens."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_orbit import SIZE, observed, orbit
from scipy.spatial.transform import Rotation

from engine.geometry.multiview.bundle import Bundle, Observations
from engine.geometry.multiview.bundle_adjustment import Freedom, adjust
from engine.geometry.multiview.structure_from_motion.joining import adjust_together, join_by_pixels
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.multiview.structure_from_motion.tracks import Tracks
from engine.geometry.registration.rigid import Similarity, fit_similarity

OWN_FRAME = Similarity(0.6 * Rotation.from_rotvec([0.3, -1.1, 0.4]).as_matrix(), np.array([0.4, -2.0, 1.0]))


def reconstruction(bundle: Bundle, seen: Observations) -> Reconstruction:
    order = np.argsort(seen.point, kind="stable")
    seen = seen[order]
    tracks = Tracks(seen.point, seen.camera, np.arange(len(seen)), len(bundle.points))
    everywhere = np.ones(len(bundle.rotations), np.bool_), np.ones(len(seen), np.bool_)
    return Reconstruction(bundle, everywhere[0], tracks, seen, everywhere[1])


@pytest.fixture(scope="module")
def films() -> tuple[Reconstruction, Reconstruction]:
    """A whole orbit, and a quarter of another, a third of a pixel of noise in both; the second's points are badly known along the
    sight of its cameras."""
    far = orbit(12)
    near = replace(orbit(6, seed=3, turn=np.pi / 2, focal=700.0), points=far.points)
    random = np.random.default_rng(5)
    sight = near.points - near.eyes.mean(0)
    off = near.points + 0.08 * random.standard_normal((len(sight), 1)) * sight
    seen_far, seen_near = observed(far, 0.3), observed(near, 0.3, seed=2)
    return reconstruction(far, seen_far), reconstruction(replace(near, points=off).moved(OWN_FRAME), seen_near)


def common(first: Reconstruction, second: Reconstruction) -> np.ndarray:
    """(M, 2) points that both see."""
    both = np.intersect1d(first.seen.point, second.seen.point)
    return np.stack([both, both], axis=1)


def scale_error(change: Similarity) -> float:
    return abs(change.scale / OWN_FRAME.inverse().scale - 1)


def test_scale_turn_and_place_come_from_what_all_cameras_see(films: tuple[Reconstruction, Reconstruction]) -> None:
    first, second = films
    pairs = common(first, second)
    random = np.random.default_rng(1)
    wrong = np.arange(0, len(pairs), 5)
    pairs[wrong, 1] = random.permutation(pairs[wrong, 1])
    wrong = wrong[pairs[wrong, 0] != pairs[wrong, 1]]
    assert len(pairs) > 100 and len(wrong) > 20
    start = fit_similarity(second.bundle.points[pairs[:, 1]], first.bundle.points[pairs[:, 0]])
    right = np.setdiff1d(np.arange(len(pairs)), wrong)
    by_places = fit_similarity(second.bundle.points[pairs[right, 1]], first.bundle.points[pairs[right, 0]])
    joined = join_by_pixels(first, second, pairs, by_places, max(SIZE))
    assert scale_error(by_places) > 0.003 and scale_error(start) > scale_error(by_places)
    assert scale_error(joined.change) < 0.001
    assert np.abs(joined.change.rotation @ OWN_FRAME.rotation - np.eye(3)).max() < 0.001
    eyes = joined.change(second.bundle.eyes)
    truth = OWN_FRAME.inverse()(second.bundle.eyes)
    assert np.linalg.norm(eyes - truth, axis=1).max() < 0.004
    assert joined.agreed[right].mean() > 0.95 and joined.agreed[wrong].mean() < 0.05


def test_adjusted_together_a_wrong_lens_is_mended_by_the_other(films: tuple[Reconstruction, Reconstruction]) -> None:
    """The first is taken to have a focal length 2% too long: its cameras, and the second's scale, are as wrong."""
    first, second = films
    wrong = first.bundle.lenses * [1.02, 1, 1]
    free = Freedom(np.ones(len(first.registered), np.bool_))
    bent = replace(first, bundle=adjust(replace(first.bundle, lenses=wrong), first.seen, free).bundle)
    pairs = common(first, second)
    start = fit_similarity(second.bundle.points[pairs[:, 1]], bent.bundle.points[pairs[:, 0]])
    joined = join_by_pixels(bent, second, pairs, start, max(SIZE))
    one, other = adjust_together(bent, second, pairs, joined.change)
    focal = first.bundle.lenses[0, 0]
    assert abs(one.bundle.lenses[0, 0] / focal - 1) < 0.003

    def far_off(a: Reconstruction, b: Reconstruction) -> float:
        """How much larger the second film is beside the first than in truth."""
        here = fit_similarity(a.bundle.eyes, first.bundle.eyes).scale
        there = fit_similarity(b.bundle.eyes, OWN_FRAME.inverse()(second.bundle.eyes)).scale
        return abs(here / there - 1)

    moved = replace(second, bundle=second.bundle.moved(joined.change))
    assert far_off(bent, moved) > 0.01 > 0.004 > far_off(one, other)
