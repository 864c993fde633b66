"""Morph targets: shapes of a mesh, mixed."""

import numpy as np
import pytest

from engine.geometry.rigging.morph_target import MorphTrack, morph_target, morphed


def test_a_mixture_is_the_weighted_sum_and_leaves_the_rest_as_it_is() -> None:
    random = np.random.default_rng(2)
    rest = random.normal(size=(20, 3)).astype(np.float32)
    fields = [np.where(random.random((20, 1)) < 0.5, random.normal(size=(20, 3)), 0) for _ in range(3)]
    morphs = [morph_target(f"shape {k}", field) for k, field in enumerate(fields)]
    before = rest.copy()
    mixed = morphed(rest, morphs, np.array([0.5, 0.0, 2.0]))
    assert mixed == pytest.approx(rest + 0.5 * fields[0] + 2 * fields[2], abs=1e-5)
    assert (rest == before).all()


def test_a_track_gives_the_weights_in_any_order_and_nothing_of_what_it_does_not_name() -> None:
    track = MorphTrack(("a", "b"), np.array([[0.1, 0.2], [0.3, 0.4]], np.float32))
    assert track.of(["b", "c", "a"]) == pytest.approx(np.array([[0.2, 0, 0.1], [0.4, 0, 0.3]]))


def test_a_track_with_other_weights_than_names_is_refused() -> None:
    with pytest.raises(ValueError, match="2 morph targets have weights"):
        MorphTrack(("a", "b"), np.zeros((4, 3), np.float32))
