"""Skinning of many frames, against the formula."""

import numpy as np

from engine.geometry.rigging.skinning import skin


def test_frames_together_equal_frames_alone_and_the_formula() -> None:
    rng = np.random.default_rng(0)
    vertices, bones = rng.normal(size=(50, 3)), rng.integers(0, 3, (50, 4)).astype(np.uint8)
    weights = rng.dirichlet(np.ones(4), 50).astype(np.float32)
    transforms = np.tile(np.eye(4), (5, 3, 1, 1))
    transforms[..., :3, :] = rng.normal(size=(5, 3, 3, 4))
    together = skin(vertices, bones, weights, transforms)
    assert together.shape == (5, 50, 3)
    homogeneous = np.concatenate([vertices, np.ones((50, 1))], 1)
    expected = np.einsum("vk,fvkij,vj->fvi", weights, transforms[:, bones], homogeneous)[..., :3]
    np.testing.assert_allclose(together, expected, atol=1e-5)
    np.testing.assert_array_equal(together[3], skin(vertices, bones, weights, transforms[3]))
