"""The loops of edges that are lids' rims."""

from __future__ import annotations

import numpy as np
import pytest

from engine.avatar.registration.eyeballs import sphere
from engine.avatar.registration.lid_rims import lid_rim
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.skin import EYE_PARTS


@pytest.mark.parametrize("part", EYE_PARTS)
def test_a_rim_is_a_closed_loop_of_edges_close_to_the_eyeball(models: HumanModels, part: str) -> None:
    template = models.template
    rim = lid_rim(template, part)
    quads = template.quads[template.faces("body")].astype(np.int64)
    edges = {frozenset(edge) for k in range(4) for edge in np.stack([quads[:, k], quads[:, (k + 1) % 4]], 1).tolist()}
    assert all(frozenset(edge) in edges for edge in zip(rim.tolist(), np.roll(rim, -1).tolist(), strict=True))
    middle, radius = sphere(template.vertices[template.vertices_of(part)])
    away = np.linalg.norm(template.vertices[rim] - middle, axis=1)
    assert away.min() > radius
    assert away.max() < 1.1 * radius


def test_both_rims_are_alike(models: HumanModels) -> None:
    left, right = (models.template.vertices[lid_rim(models.template, part)] for part in EYE_PARTS)
    assert len(left) == len(right)
    apart = np.linalg.norm(left[:, None] - right * [-1, 1, 1], axis=2)
    assert apart.min(1).max() < 1e-4
