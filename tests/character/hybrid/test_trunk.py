"""The relief's trunk, of a template that stands for the person: what is before it hides it, and a head that is apart is none of it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import load_human
from engine.character.fit.template_maps import side_maps
from engine.character.hybrid.trunk import before_the_trunk, trunk_region
from engine.character.parts.label_map import Labels
from engine.imaging.masks.mask_distance import dilate_mask
from tests.character.parts.test_overlapping_legs import LEFT_ARM, SIZE, standing

HEAD, TRUNK = BODY_PARTS.index("head"), BODY_PARTS.index("torso")


@pytest.fixture(scope="module")
def template() -> PosedTemplate:
    return standing({})


@pytest.fixture(scope="module")
def part(template: PosedTemplate) -> NDArray[np.intp]:
    """Of the corners (T, 3) of its triangles."""
    return vertex_parts(load_human().rig)[template.triangles]


@pytest.fixture(scope="module")
def labels(template: PosedTemplate, part: NDArray[np.intp]) -> Labels:
    seen = side_maps(template.vertices, template.triangles, SIZE, "front")
    found = np.where(seen.mask, part[seen.raster.triangle, 0], -1).astype(np.int8)
    nowhere = np.zeros(SIZE, np.bool_)
    return Labels(found, nowhere, np.zeros(0, np.int8), nowhere, np.full(SIZE, -1, np.int8))


def test_behind_a_staff_that_is_held_across_it_the_trunk_goes_on(template: PosedTemplate, labels: Labels) -> None:
    trunk = labels.labels == TRUNK
    rows = np.flatnonzero(trunk.any(1))
    staff = np.zeros(SIZE, np.bool_)
    staff[int(np.mean(rows)) - 5 : int(np.mean(rows)) + 5] = True
    holding = Labels(
        np.where(staff, -1, labels.labels).astype(np.int8),
        *(labels.occlusion, labels.apart, labels.parting, labels.hidden),
        held=np.where(staff, LEFT_ARM, -1).astype(np.int8),
    )
    assert before_the_trunk(holding)[staff].all()
    whole = trunk_region(holding, template, load_human().rig).mask
    assert whole[staff & trunk].mean() > 0.95
    above, below = (trunk & (np.arange(SIZE[0])[:, None] < rows.mean()) == side for side in (True, False))
    assert all(whole[piece & trunk & ~staff].mean() > 0.95 for piece in (above, below)), "in one piece"


@pytest.mark.parametrize(("holder", "goes_on"), [(LEFT_ARM, True), (HEAD, False)], ids=["a bag", "hair"])
def test_behind_hair_no_shoulder_goes_up(template: PosedTemplate, labels: Labels, holder: int, goes_on: bool) -> None:
    """Hair has a surface of its own, and what stands up behind it is seen from aside."""
    found = np.where(labels.labels == HEAD, -1, labels.labels)
    trunk = found == TRUNK
    above = dilate_mask(trunk, 2) & (found < 0) & (np.arange(SIZE[0])[:, None] < np.flatnonzero(trunk.any(1))[0] + 20)
    held = np.where(dilate_mask(above, 1) & (found < 0), holder, -1).astype(np.int8)
    shown = Labels(found.astype(np.int8), labels.occlusion, labels.apart, labels.parting, labels.hidden, held=held)
    whole = trunk_region(shown, template, load_human().rig).mask
    assert above.sum() > 20
    assert (whole[above].mean() > 0.8) == goes_on and (whole[above].mean() < 0.4) != goes_on


@pytest.mark.parametrize("apart", [False, True])
def test_a_head_is_the_trunks_unless_it_is_apart(
    template: PosedTemplate, labels: Labels, part: NDArray[np.intp], apart: bool
) -> None:
    found = np.where(labels.labels == HEAD, -1, labels.labels) if apart else labels.labels
    shown = Labels(found.astype(np.int8), labels.occlusion, labels.apart, labels.parting, labels.hidden)
    own = trunk_region(shown, template, load_human().rig).triangles
    assert own[(part == TRUNK).all(1)].all()
    assert own[(part == HEAD).all(1)].any() != apart
