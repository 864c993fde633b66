"""Legs that go on under cloth that hangs: the further up, the more they go with it, and do not come through where it swings.

Beyond the paper. What of a leg is under a skirt is seen by nobody; what moves it need not be the leg's joints.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.character.hybrid.limbs import Limbs, dense_weights, first_rows
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS, TRUNK_LABEL
from engine.character.shell.template_mesh import TemplateMesh
from engine.character.surface.front_and_back import Layer, strongest
from engine.character.surface.legs_beneath import LEG_UNDER_CLOTH_SHARE
from engine.imaging.filling.nearest import nearest_in
from engine.imaging.masks.mask_pieces import rows_apart

HELD_BY_CLOTH_SHARE = 0.7
"""Share of what of a leg is under cloth, from its hem up, over which it comes to go with the cloth alone."""


def going_with_the_cloth(
    mesh: TemplateMesh, pictured: NDArray[np.float64], limbs: Limbs, trunk: Layer, labels: Labels
) -> TemplateMesh:
    """The mesh whose legs, `pictured` (V, 3), are moved under cloth that hangs more and more as the `trunk` is there; as it was
    where none does. `labels`: of `trunk_labels`."""
    if labels.cloth is None or not labels.cloth.hangs or not trunk.mask.any():
        return mesh
    up = HELD_BY_CLOTH_SHARE * LEG_UNDER_CLOTH_SHARE * rows_apart(labels.labels >= 0)
    under = np.clip((first_rows(labels, limbs.limb) - pictured[:, 1]) / up, 0, 1)
    under = under * under * (3 - 2 * under)  # at the hem the leg is the leg
    under = np.where(np.isin(limbs.limb, LEG_LABELS), under, 0)[:, None]
    height, width = trunk.mask.shape
    x, y = np.clip(np.rint(pictured[:, :2]), 0, [width - 1, height - 1]).astype(int).T
    rows, columns = nearest_in(trunk.mask)
    cloth = trunk.front.weights[rows[y, x], columns[y, x]]
    own = dense_weights(mesh, cloth.shape[1])
    bones, weights = strongest((own + under * (cloth - own)).astype(np.float32))
    held = under[:, 0] > 0
    all_bones, all_weights = mesh.bones.copy(), mesh.weights.copy()
    all_bones[held], all_weights[held] = bones[held], weights[held]
    return replace(mesh, bones=all_bones, weights=all_weights)


def bare_under_cloth(labels: Labels) -> NDArray[np.bool_]:
    """The pixels (h, w) of cloth that hangs just above legs that come out from under it: these do not have its colours there, as it
    lifts. Further up they may have: where they touch it, nobody sees which is which. `labels`: of `trunk_labels`."""
    over = np.zeros(labels.labels.shape, np.bool_)
    if labels.cloth is None or not labels.cloth.hangs:
        return over
    up = round(HELD_BY_CLOTH_SHARE * LEG_UNDER_CLOTH_SHARE * rows_apart(labels.labels >= 0) / 2)
    for leg in LEG_LABELS:
        rows = np.flatnonzero((labels.labels == leg).any(1))
        if len(rows):
            over[max(rows[0] - up, 0) :] = True
    return np.asarray(over & (labels.labels == TRUNK_LABEL))
