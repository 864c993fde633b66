"""Gains of frames, from what they show along the same edges."""

from __future__ import annotations

import numpy as np

from engine.avatar.texture.exposure import exposure_gains
from engine.avatar.texture.view_samples import SAMPLES_PER_SEAM_EDGE, ViewSamples


def test_what_some_edges_show_of_something_else_is_no_exposure() -> None:
    """A shadow lies on a fifth of the edges, in one frame of six; otherwise all are exposed alike."""
    edges, frames = 300, 6
    random = np.random.default_rng(2)
    own = random.uniform(80, 200, (edges, 1, 1, 3))
    colours = np.repeat(np.repeat(own, frames, 1), SAMPLES_PER_SEAM_EDGE, 2)
    colours[: edges // 5, 0] *= 0.5
    samples = ViewSamples(
        cosine=np.ones((edges + 1, frames), np.float32),
        density=np.ones((edges + 1, frames), np.float32),
        pairs=np.stack([np.arange(edges), np.arange(edges) + 1], 1),
        lengths=np.ones(edges),
        colours=np.rint(colours).astype(np.uint8),
    )
    np.testing.assert_allclose(exposure_gains(samples), 1, atol=0.01)
