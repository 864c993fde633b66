"""The template's visible parts as a surface to be textured, and which of its triangles are what."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.eye_charts import avatar_uv
from engine.avatar.mesh import AVATAR_PARTS
from engine.avatar.registration.eyes.tucked_lids import LidColumns
from engine.avatar.registration.template_skin.lid_rims import behind_rims, lid_rim, upper_lid_columns
from engine.avatar.registration.template_skin.skin import EYE_PARTS
from engine.avatar.texture.lid_folds import in_lid_fold
from engine.avatar.texture.views import ChartedSurface
from engine.avatar.worn import Attachments
from engine.body.rig import Rig
from engine.body.template import Template, mouth_faces
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.joint_names import SIDE_NAMES, Side
from engine.geometry.texture_charts.texture_atlas import TextureAtlas, atlas_from_uv

HAND_DRIFT_METRES = 0.025
"""Metres from a hand within which frames may show it in place of what is there."""
FINGER_GAP_METRES = 0.06
"""Metres from a hand within which frames may show the room in place of what is there: masks have it between fingers."""
OWN_HAND_REACH_METRES = 0.12
"""Metres from a hand within which, in the template, what is there is the hand itself, or its arm."""
ATTACHED_PART = len(AVATAR_PARTS)
"""The part of triangles that stand off the body."""


@dataclass(frozen=True)
class TemplateSurface:
    """The triangles of `AVATAR_PARTS`, the same for everybody, and how they lie on the texture.

    triangles : (T, 3) into the template's vertices, and those of what is worn.
    atlas : how they lie on the texture.
    part : (T,) int: which of `AVATAR_PARTS` each is of, or `ATTACHED_PART`.
    mouth : (T,) bool: the bag behind the lips.
    hands : of each side in `SIDE_NAMES`, (T,) bool.
    rest : (V, 3) the template's vertices, in whose shape it is known where everything is.
    sockets : (T,) bool: the skin behind the lids.
    lid_rims : of each eyeball, the loop of vertices in which its lids end.
    lid_columns : of each eyeball, columns of vertices up from the rim of its upper lid, (C, K).
    """

    triangles: NDArray[np.int32]
    atlas: TextureAtlas
    part: NDArray[np.intp]
    mouth: NDArray[np.bool_]
    hands: Mapping[Side, NDArray[np.bool_]]
    rest: NDArray[np.float64]
    sockets: NDArray[np.bool_]
    lid_rims: Mapping[str, NDArray[np.intp]]
    lid_columns: Mapping[str, NDArray[np.intp]]

    def fitted(self, vertices: NDArray[np.floating]) -> ChartedSurface:
        """The surface of the person whose template vertices are (V, 3), metres. Stitched from frames are all of the
        body's skin but the mouth's bag, and what stands off it. Not stitched are what a hand lies on, and what lies in
        the lids' folds."""
        places = np.asarray(vertices, np.float64)
        stitched = (
            np.isin(self.part, [AVATAR_PARTS.index("body"), ATTACHED_PART])
            & ~self.mouth
            & ~self._beside_hands(places, HAND_DRIFT_METRES)
        )
        for folded in self.lid_folds(places).values():
            stitched &= ~folded
        stitched &= ~self.sockets
        return ChartedSurface(
            places, self.triangles, self.atlas, stitched, self._beside_hands(places, FINGER_GAP_METRES)
        )

    def lid_folds(self, vertices: NDArray[np.floating]) -> dict[str, NDArray[np.bool_]]:
        """Of each eyeball, (T,) the skin in the folds of its lids where the template's vertices are (V, 3)."""
        places = np.asarray(vertices, np.float64)
        skin = self.of("body") & ~self.mouth & ~self.sockets
        found = {}
        for part, rim in self.lid_rims.items():
            folded = in_lid_fold(places, self.triangles, rim, np.unique(self.triangles[self.of(part)]))
            found[part] = skin & (folded | self.tucked(part, places)[0])
        return found

    def tucked(self, part: str, vertices: NDArray[np.floating]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """(T,) and (T,) the skin of the upper lid about an eyeball that lies tucked at its rim where the template's vertices are (V, 3),
        and what of it is partly in the tuck."""
        columns = self.lid_columns[part]
        within, known = np.zeros(len(vertices), np.bool_), np.zeros(len(vertices), np.bool_)
        within[columns] = LidColumns.of(vertices[columns], vertices[self.lid_rims[part]]).in_tuck()
        known[columns] = True
        whole = np.asarray(within[self.triangles].all(1))
        return whole, np.asarray(within[self.triangles].any(1) & known[self.triangles].all(1) & ~whole)

    def lid_skin(self, part: str, vertices: NDArray[np.floating]) -> NDArray[np.float64]:
        """(V, 2) of the template's `vertices` (V, 3), metres, with lids tucked: widths of the eye along the skin from the rim of the upper
        lid about an eyeball, and how far up the lid's own skin that is, 1 at its fold; 0 where they are of no column."""
        columns = self.lid_columns[part]
        found = LidColumns.of(vertices[columns], vertices[self.lid_rims[part]])
        out = np.zeros((len(vertices), 2))
        out[columns] = np.stack([found.lengths, found.up()], 2)
        return out

    def _beside_hands(self, vertices: NDArray[np.float64], reach: float) -> NDArray[np.bool_]:
        """(T,) what is within `reach` of a hand, metres, in the pose of the vertices (V, 3), and not by growth: frames show the hand
        there, too, as it drifts."""
        hand = np.unique(self.triangles[np.any(list(self.hands.values()), axis=0)])
        posed, rest = (
            cKDTree(places[hand]).query(places[self.triangles].mean(1), distance_upper_bound=within)[0]
            for places, within in ((vertices, reach), (self.rest, OWN_HAND_REACH_METRES))
        )
        return np.isfinite(posed) & ~np.isfinite(rest)

    def wearing(self, worn: Attachments) -> TemplateSurface:
        """The surface with what stands off the body, whose vertices and places on the texture come after its own."""
        count = len(worn.triangles)
        own = self.atlas
        atlas = TextureAtlas(
            np.concatenate([own.uv, worn.atlas.uv]),
            np.concatenate([own.corners, worn.atlas.corners + np.int32(len(own.uv))]),
            np.concatenate([own.charts, worn.atlas.charts + np.int32(own.charts.max() + 1)]),
        )
        none = np.zeros(count, np.bool_)
        return TemplateSurface(
            triangles=np.concatenate([self.triangles, worn.triangles + np.int32(len(self.rest))]),
            atlas=atlas,
            part=np.concatenate([self.part, np.full(count, ATTACHED_PART, np.intp)]),
            mouth=np.concatenate([self.mouth, none]),
            hands={side: np.concatenate([hand, none]) for side, hand in self.hands.items()},
            rest=np.concatenate([self.rest, worn.vertices]),
            sockets=np.concatenate([self.sockets, none]),
            lid_rims=self.lid_rims,
            lid_columns=self.lid_columns,
        )

    def of(self, *parts: str) -> NDArray[np.bool_]:
        """(T,) the triangles of the named parts."""
        return np.isin(self.part, [AVATAR_PARTS.index(part) for part in parts])


def template_surface(template: Template, rig: Rig) -> TemplateSurface:
    """The surface of an avatar; `rig` is `engine.body.rig.HUMAN_RIG`'s, or another with Mixamo's names of hands."""
    faces = template.faces(*AVATAR_PARTS)
    triangles = triangulate(template.quads[faces])
    atlas = atlas_from_uv(avatar_uv(template), triangulate(template.uv_quads[faces]))
    sizes = [template.parts[part][1] - template.parts[part][0] for part in AVATAR_PARTS]
    part = np.tile(np.arange(len(sizes)).repeat(sizes), 2)  # quads are halved: first halves, then second halves
    rest = template.vertices.astype(np.float64)
    body = part == AVATAR_PARTS.index("body")
    bones = np.array(rig.names)[rig.bones[:, 0]]
    of_hand = {side: np.array([name.startswith(f"{side}Hand") for name in bones.tolist()]) for side in SIDE_NAMES}
    hands = {side: body & _charts(atlas, np.all(moved[triangles], axis=1), body) for side, moved in of_hand.items()}
    mouth = np.zeros(len(faces), np.bool_)
    mouth[: sizes[AVATAR_PARTS.index("body")]] = mouth_faces(template)
    rims = {name: lid_rim(template, name) for name in EYE_PARTS}
    sockets = np.zeros(len(triangles), np.bool_)
    sockets[body] = behind_rims(triangles[body], rims.values())
    columns = {name: upper_lid_columns(template, name) for name in EYE_PARTS}
    return TemplateSurface(triangles, atlas, part, np.tile(mouth, 2), hands, rest, sockets, rims, columns)


def _charts(atlas: TextureAtlas, inside: NDArray[np.bool_], among: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(T,) the charts of which most of the triangles `among` all are `inside`."""
    count = int(atlas.charts.max()) + 1
    number = np.bincount(atlas.charts[among], minlength=count)
    within = np.bincount(atlas.charts[among & inside], minlength=count)
    return (2 * within > number)[atlas.charts]
