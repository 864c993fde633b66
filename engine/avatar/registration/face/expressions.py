"""Face units of the fitted face: section 3.4, "we map all blendshapes by deformation transfer"."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.eyes.blinking import BLINKS, before_the_eye, meeting_rims
from engine.avatar.registration.template_skin.skin import Skin
from engine.body.template import FACE_UNITS, Template
from engine.geometry.deformation.deformation_transfer import DeformationTransfer
from engine.geometry.registration.rigid import fit_similarity
from engine.geometry.surface import triangle_areas

RIGID_PARTS = (
    *("left_eye", "right_eye", "upper_teeth", "lower_teeth", "tongue"),
    *("left_upper_lashes", "left_lower_lashes", "right_upper_lashes", "right_lower_lashes"),
)
"""Parts that are no skin, each moved as a whole from the template to the person."""
MARGIN_RINGS = 2
"""Rings of triangles about what any unit moves; the outermost vertices stay."""


def transferred_units(template: Template, skin: Skin, rest: NDArray[np.floating]) -> dict[str, NDArray[np.float32]]:
    """The face units of a person, by name: displacements (V, 3) float32 metres of the template's vertices, whose places in
    T-pose are `rest` (V, 3).

    The skin's by deformation transfer from the template's own, and in a blink with the upper lid's rim on the lower's; those of
    `RIGID_PARTS` turned and scaled as the parts are.
    """
    dense = template.face_units.dense(FACE_UNITS)
    own = np.asarray(rest, np.float64)
    moving = np.linalg.norm(dense, axis=2).max(0) > 0
    patch = _Patch(template, skin, own, moving)
    parts = {part: template.vertices_of(part) for part in RIGID_PARTS}
    placed = {part: fit_similarity(template.vertices[at].astype(np.float64), own[at]) for part, at in parts.items()}
    found = {}
    for name, offsets in zip(FACE_UNITS, dense, strict=True):
        moved = np.zeros_like(offsets)
        for part, vertices in parts.items():
            moved[vertices] = placed[part].offsets(offsets[vertices])
        if name in BLINKS:
            _blink(template, skin, own, moving, name, moved)
        else:
            moved[patch.vertices] = patch(offsets)
        found[name] = moved.astype(np.float32)
    return found


def _blink(
    template: Template,
    skin: Skin,
    rest: NDArray[np.float64],
    moving: NDArray[np.bool_],
    name: str,
    out: NDArray[np.floating],
) -> None:
    """Put the skin's displacements of a blink into `out` (V, 3)."""
    rims = meeting_rims(template, skin, name)
    eyeball = rest[template.vertices_of(BLINKS[name])]
    patch = _Patch(template, skin, rest, moving, rims.vertices)
    moved = patch(template.face_units.dense((name,))[0], rims.met(eyeball, rest))
    lids = skin.vertices[skin.regions["lids"] & ~skin.regions["inner"]]
    own = np.isin(patch.vertices, lids)
    near = own & (np.linalg.norm(moved, axis=1) > 0)
    moved[near] = before_the_eye(eyeball, rest[patch.vertices[near]], moved[near])
    out[patch.vertices] = moved


class _Patch:
    """The part of the skin that units move; of `told` vertices it is said where they go."""

    def __init__(
        self,
        template: Template,
        skin: Skin,
        rest: NDArray[np.float64],
        moved: NDArray[np.bool_],
        told: NDArray[np.intp] | None = None,
    ):
        triangles = skin.vertices[skin.triangles]
        chosen = moved[triangles].any(1)
        for _ in range(MARGIN_RINGS):
            reached = np.zeros(len(moved), np.bool_)
            reached[triangles[chosen]] = True
            chosen = reached[triangles].any(1)
        sound = triangle_areas(rest, triangles) > 0
        self.vertices, inside = np.unique(triangles[chosen & sound], return_inverse=True)
        faces = inside.reshape(-1, 3)
        outside = np.unique(triangles[~chosen])
        self._stay = np.flatnonzero(np.isin(self.vertices, outside))
        told = np.zeros(0, np.intp) if told is None else np.searchsorted(self.vertices, told)
        held = np.concatenate([self._stay, told])
        self._source = template.vertices[self.vertices].astype(np.float64)
        self._rest = rest[self.vertices]
        self._transfer = DeformationTransfer(self._source, faces, self._rest, faces, held=held)

    def __call__(
        self, offsets: NDArray[np.floating], told_to: NDArray[np.floating] | None = None
    ) -> NDArray[np.float64]:
        """The displacements (M, 3) of the patch for a unit's (V, 3) on the template; `told_to` (U, 3): where those vertices go."""
        held_at = self._rest[self._stay] if told_to is None else np.concatenate([self._rest[self._stay], told_to])
        return np.asarray(self._transfer(self._source + offsets[self.vertices], held_at) - self._rest)
