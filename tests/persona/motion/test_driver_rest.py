"""A driver's face at rest, of the frames of its video that show it."""

from __future__ import annotations

import numpy as np

from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.persona.motion.driver_rest import rest_of_frames
from engine.persona.motion.mesh_units import load_mesh_units
from engine.persona.texture.expression_weights import expression_points

NOISE = 0.006
"""Eye distances, in each axis."""


def test_noise_of_single_frames_is_gone_and_expressions_are_left_out() -> None:
    rest = frontalise(canonical_face()[None].astype(np.float64))[0]
    units = load_mesh_units()
    smile = units.moved[units.names.index("mouthSmileLeft")] + units.moved[units.names.index("mouthSmileRight")]
    done = np.repeat([0.0, 1.0], (30, 60))
    noise = np.random.default_rng(1).normal(size=(90, 478, 3)) * NOISE
    front = rest + done[:, None, None] * smile + noise
    found = rest_of_frames(front, 4)
    assert np.abs(found - rest).mean() < 0.3 * np.abs(front[4] - rest).mean()
    assert np.abs(found - rest)[[61, 291]].max() < 0.01, "corners of the mouth, which most frames have raised"


def test_of_frames_that_differ_by_more_than_noise_none_counts() -> None:
    """Thrice a tracker's noise, in the root of the mean square over the points, is another expression; half of it is not."""
    rest = frontalise(canonical_face()[None].astype(np.float64))[0]
    smile = load_mesh_units().moved[load_mesh_units().names.index("mouthSmileLeft")]
    points = expression_points(np.array([rest, rest + smile]))
    smile = smile / np.sqrt(((points[1] - points[0]) ** 2).sum(-1).mean())
    found = rest_of_frames(np.array([rest, rest + 0.005 * smile, rest + 0.03 * smile]), 0)
    np.testing.assert_allclose(found, rest + 0.0025 * smile, atol=1e-9)


def test_a_frame_that_is_alone_is_its_own_mean() -> None:
    rest = frontalise(canonical_face()[None].astype(np.float64))[0]
    wider = rest * (1.2, 1, 1)
    np.testing.assert_allclose(rest_of_frames(np.array([wider, rest, rest]), 0), wider)
