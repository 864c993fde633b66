"""Face units of the fitted face: section 3.4, "we map all blendshapes by deformation transfer"."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.eyes.blinking import EYE_OF_BLINK_UNIT, meeting_rims
from engine.avatar.registration.eyes.eyeballs import sphere
from engine.avatar.registration.eyes.shut_lids import drawn_back, shut_lid
from engine.avatar.registration.face.face_parts import head_change
from engine.avatar.registration.template_skin.lid_rims import lid_rim, upper_lid_columns
from engine.avatar.registration.template_skin.skin import Skin
from engine.body.template import FACE_UNITS, Template
from engine.face_animation.smoothstep import smoothstep
from engine.geometry.deformation.deformation_transfer import DeformationTransfer
from engine.geometry.mesh.surface import triangle_areas
from engine.geometry.registration.rigid import fit_rigid, fit_similarity

RIGID_PARTS = (
    *("left_eye", "right_eye", "upper_teeth", "lower_teeth", "tongue"),
    *("left_upper_lashes", "left_lower_lashes", "right_upper_lashes", "right_lower_lashes"),
)
"""Parts that are no skin, each moved as a whole from the template to the person."""
MARGIN_RINGS = 2
"""Rings of triangles about what any unit moves; the outermost vertices stay."""
BEHIND_RIM_EYE_WIDTHS = 0.2
"""Widths of an eye from the rim of its upper lid within which what is behind it goes along in a blink."""
RIM_NEIGHBOURS = 3
"""Vertices of a rim whose motion, weighted by nearness, the lid goes along with."""
SCREENING_METRES = 0.015
"""Metres over which triangles say how the face moves; farther apart, vertices go as far as the template's do. By triangles alone
what a narrow mouth's corners lose in width pulls the whole lip along, and upper teeth never show."""


def transferred_units(template: Template, skin: Skin, rest: NDArray[np.floating]) -> dict[str, NDArray[np.float32]]:
    """The face units of a person, by name: displacements (V, 3) float32 metres of the template's vertices, whose places in
    T-pose are `rest` (V, 3).

    The skin's by deformation transfer from the template's own, and in a blink with the upper lid's rim on the lower's; those of
    `RIGID_PARTS` turned and scaled as the parts are. A tongue lies in the lower jaw and goes where that goes. Where it
    moves by itself it rises to its place in the template.
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
        tongue, jaw = parts["tongue"], parts["lower_teeth"]
        if moved[jaw].any():
            moved[tongue] = fit_rigid(own[jaw], own[jaw] + moved[jaw])(own[tongue]) - own[tongue]
        elif moved[tongue].any():
            moved[tongue] += (placed["lower_teeth"](template.vertices[tongue]) - own[tongue]).mean(0)
        if name in EYE_OF_BLINK_UNIT:
            _blink(template, skin, own, name, moved)
        else:
            moved[patch.vertices] = patch(offsets)
        found[name] = moved.astype(np.float32)
    return found


def _blink(template: Template, skin: Skin, rest: NDArray[np.float64], name: str, out: NDArray[np.floating]) -> None:
    """Put the displacements of a blink into `out` (V, 3): the upper lid's skin comes out of its fold over the eyeball, which draws back
    from it, down to the lower lid. What lies beyond the fold stays: the template's own blink moves as much as it has of skin below
    its brows, and a person's brows may be there. What is behind the upper rim goes along with it, beneath the lid."""
    part = EYE_OF_BLINK_UNIT[name]
    rims, columns, ball = (
        meeting_rims(template, skin, name),
        upper_lid_columns(template, part),
        template.vertices_of(part),
    )
    loop, eyeball = rest[lid_rim(template, part)], rest[ball]
    ends = np.zeros_like(rest)
    ends[rims.upper] = rims.lower(rest)
    moved = np.zeros_like(rest)
    moved[columns] = shut_lid(rest[columns], loop, ends[columns[:, 0]], eyeball) - rest[columns]
    behind = skin.vertices[skin.regions["inner"]]
    moved[behind] = _behind_lid(rest, behind, rims.upper, moved, eyeball)
    out[skin.vertices] = moved[skin.vertices]
    ahead = loop.mean(0) - eyeball.mean(0)
    ahead /= np.linalg.norm(ahead)
    out[ball] -= drawn_back(eyeball, rest[columns.ravel()], moved[columns.ravel()], ahead) * ahead


def _behind_lid(
    rest: NDArray[np.float64],
    behind: NDArray[np.intp],
    rim: NDArray[np.intp],
    moved: NDArray[np.float64],
    eyeball: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(N, 3) the displacements of skin `behind` an upper lid's `rim` (U,), the less the farther from it, and into the eyeball (E, 3)."""
    width = float(np.ptp(rest[rim], axis=0).max())
    found = cKDTree(rest[rim]).query(rest[behind], k=RIM_NEIGHBOURS)
    away, near = np.asarray(found[0]), np.asarray(found[1])
    shares = 1 / np.maximum(away, 1e-6) ** 2
    shares /= shares.sum(1, keepdims=True)
    share = 1 - smoothstep(away[:, 0] / width, 0, BEHIND_RIM_EYE_WIDTHS)
    along = share[:, None] * np.einsum("sk,skc->sc", shares, moved[rim[near]])
    middle, radius = sphere(eyeball)
    offset = rest[behind] + along - middle
    distance = np.linalg.norm(offset, axis=1, keepdims=True)
    inside = middle + offset * np.minimum(1, radius / np.maximum(distance, 1e-9))
    return np.asarray(np.where(share[:, None] > 0, inside - rest[behind], 0))


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
        self._transfer = DeformationTransfer(
            self._source, faces, self._rest, faces, held=held, screening=SCREENING_METRES
        )
        self._head = head_change(skin, template.vertices[skin.vertices].astype(np.float64), rest[skin.vertices])

    def __call__(
        self, offsets: NDArray[np.floating], told_to: NDArray[np.floating] | None = None
    ) -> NDArray[np.float64]:
        """The displacements (M, 3) of the patch for a unit's (V, 3) on the template; `told_to` (U, 3): where those vertices go."""
        held_at = self._rest[self._stay] if told_to is None else np.concatenate([self._rest[self._stay], told_to])
        own = offsets[self.vertices]
        drawn_to = self._rest + self._head.offsets(own)
        return np.asarray(self._transfer(self._source + own, held_at, drawn_to) - self._rest)
