"""Sources see the same side, from beside, and not all from one."""

import numpy as np
from textured_sphere import CENTRE, RADIUS, ring

from engine.geometry.multiview.view_selection import BEST_ANGLE_DEGREES, chosen_sources, shared_sight

CAMERAS = ring(36)  # ten degrees apart


def sphere() -> tuple[np.ndarray, np.ndarray]:
    away = np.random.default_rng(6).normal(size=(500, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    return CENTRE + RADIUS * away, away


def test_views_at_the_best_angle_share_most_and_those_from_behind_nothing() -> None:
    score = shared_sight(CAMERAS, *sphere())
    assert score[0, 0] == 0
    assert int(np.argmax(score[0])) in {
        round(BEST_ANGLE_DEGREES / 10),
        36 - round(BEST_ANGLE_DEGREES / 10),
        2,
        3,
        33,
        34,
    }
    assert score[0, 18] < 0.01
    assert score.max() <= 1


def test_sources_are_taken_from_both_sides() -> None:
    chosen = chosen_sources(shared_sight(CAMERAS, *sphere()), CAMERAS, CENTRE, 4)
    for view, own in enumerate(chosen):
        steps = [(source - view + 18) % 36 - 18 for source in own]
        assert len(set(steps)) == 4
        assert sum(step > 0 for step in steps) == 2
        assert max(map(abs, steps)) <= 6


def test_a_view_that_shares_sight_with_none_has_no_sources() -> None:
    cameras = [CAMERAS[0], CAMERAS[18]]
    narrow = sphere()[0][:1], np.array([[0.0, 0.0, 1.0]])
    assert chosen_sources(shared_sight(cameras, *narrow), cameras, CENTRE, 2)[1] == []
