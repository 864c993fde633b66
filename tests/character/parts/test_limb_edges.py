"""A limb's edge is where the picture has it, between the pixels of the grid."""

from __future__ import annotations

import numpy as np

from engine.character.parts.limb_edges import border, soft_limbs
from engine.character.surface.front_and_back import Layer, stitch_front_and_back
from engine.character.surface.part_surface import Surface

FINER, EDGE = 4, 50.875


def picture() -> tuple[np.ndarray, np.ndarray]:
    """A dark sleeve before a light shirt, which it leaves at `EDGE` pixels of the grid; the labels go half a pixel further."""
    rgb = np.full((400 * FINER, 100 * FINER, 3), 220, np.uint8)
    rgb[:, : round((EDGE + 0.5) * FINER)] = 40
    labels = np.zeros((400, 100), np.bool_)
    labels[100:300, 20:52] = True
    return labels, rgb


def test_a_limb_is_known_up_to_the_edge_of_its_colours() -> None:
    labels, rgb = picture()
    soft = soft_limbs(labels, rgb)
    row = soft[200 * FINER]
    ends = np.flatnonzero((row[:-1] > 0.5) & (row[1:] <= 0.5))
    assert abs((ends[-1] + 1) / FINER - 0.5 - EDGE) < 0.3
    assert soft[50 * FINER].max() == 0, "it ends where the label does"


def test_the_border_of_a_limb_s_surface_goes_there_and_the_body_s_does_not() -> None:
    labels, _ = picture()
    x = np.arange(100)
    soft = np.where(labels.any(1)[:, None], np.clip(EDGE + 0.5 - x, 0, 1), 0).astype(np.float32)
    weights = np.ones((400, 100, 1), np.float32)
    flat = np.where(labels, 0, np.nan).astype(np.float32)
    sides = Surface(flat + 2, weights), Surface(flat - 2, weights)
    whole = np.ones(labels.shape, np.float32)
    for limb, at in ((3, EDGE), (-1, 51.0)):
        mesh = stitch_front_and_back([Layer(labels, *sides, limb=limb)], whole, {3: soft})
        edge = mesh.rim & (mesh.vertices[:, 0] > 40) & (np.abs(mesh.vertices[:, 1] - 200) < 80)
        np.testing.assert_allclose(mesh.vertices[edge, 0], at, atol=0.1)


def test_where_only_the_background_is_beside_it_a_limb_s_border_is_the_mask_s() -> None:
    labels, rgb = picture()
    shirt = np.zeros_like(labels)
    shirt[100:300, 52:90] = True
    found = border(labels, labels | shirt, rgb)
    assert (found[110:290, :46] == 1).all()
    assert 0 < found[200, 51] < 1 and found[200, 54] == 0
