"""The loops of edges that are lids' rims."""

from __future__ import annotations

import numpy as np
import pytest

from engine.avatar.registration.eyes.eyeballs import sphere
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lid_rims import behind_rims, lid_rim
from engine.avatar.registration.template_skin.skin import EYE_PARTS


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


def test_sockets_are_what_rims_cut_off(models: HumanModels) -> None:
    skin = models.skin
    rims = [skin.index_of(lid_rim(models.template, part)) for part in EYE_PARTS]
    cut_off = behind_rims(skin.triangles, rims)
    behind = np.unique(skin.triangles[cut_off])
    own = np.setdiff1d(behind, np.concatenate(rims))
    balls = [sphere(models.template.vertices[models.template.vertices_of(part)]) for part in EYE_PARTS]
    places = models.template.vertices[skin.vertices[own]]
    away = np.min([np.linalg.norm(places - middle, axis=1) / radius for middle, radius in balls], axis=0)
    assert away.min() > 0.8 and away.max() < 1.2
    assert cut_off.sum() > 400
