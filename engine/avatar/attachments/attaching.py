"""From the fitted template, the cloud and the silhouettes to what is worn: pieces beside the skin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.influences import influences
from engine.avatar.attachments.piece_mesh import Mesh, piece_meshes, seen_area, seen_part, simplified
from engine.avatar.attachments.seen_around import seen_around
from engine.avatar.attachments.silhouettes import Silhouettes, silhouettes_beside
from engine.avatar.attachments.skirt.leg_influences import leg_influences
from engine.avatar.attachments.skirt.legs import legs_of
from engine.avatar.attachments.skirt.skirt import skirt_around
from engine.avatar.attachments.skirt.skirt_mesh import skirt_mesh
from engine.avatar.attachments.solid import solid
from engine.avatar.attachments.standing_off import points_standing_off, standing_volume
from engine.avatar.eye_charts import avatar_uv
from engine.avatar.mesh import AVATAR_PARTS
from engine.avatar.options import MAX_ATTACHED_TRIANGLES
from engine.avatar.registration.head_in_outlines import HEAD_JOINT_NAMES
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.skin import grown
from engine.avatar.worn import Attachments, no_attachments
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import triangle_areas, triangulate
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.texture_charts.atlas_room import cells_of, placed_between
from engine.geometry.texture_charts.texture_atlas import TextureAtlas, atlas_from_uv, unwrap

MAX_PIECES = 6
"""Pieces, the largest first."""
MIN_SEEN_SQUARE_METRES = 0.005
"""Square metres of a part's surface that the skin does not hide, at least."""
MIN_TRIANGLE_SQUARE_METRES = 3e-5
"""Square metres of a triangle, where that makes no more of them."""
UNWRAPPED_SIZE_TEXELS = 1024
"""Texels of the texture for which pieces are unfolded, before they are placed."""
FREE_ABOVE_BROWS_METRES = 0.015
"""Metres above the brows up to which a face is free of what does not clearly stand off: hats sit higher."""
FREE_BEHIND_JAWS_METRES = 0.03
"""Metres behind the jaws' ends up to which a head is free of what does not clearly stand off: there are ears, and hair lies
behind them."""
OWN_RINGS = 8
"""Rings of vertices around hands and feet, which have models of their own, on which nothing is worn: ankles, and wrists as all of the arms."""


def body_surface(human: HumanModels, vertices: NDArray[np.float64]) -> BodySurface:
    """The skin of a person whose template vertices are (V, 3), metres."""
    skin = human.skin
    own = vertices[skin.vertices]
    brows = own[skin.face_points[17:27], 1].max()
    jaws = own[skin.face_points[[0, 16]]].mean(0)
    forwards = (own[skin.face_points[30]] - jaws) * [1, 0, 1]
    front = (own - jaws) @ forwards > -FREE_BEHIND_JAWS_METRES * np.linalg.norm(forwards)
    face = (skin.regions["face"] | (skin.regions["head"] & front)) & (own[:, 1] < brows + FREE_ABOVE_BROWS_METRES)
    arms = [human.rig.index(f"{side}{bone}") for side in SIDE_NAMES for bone in ("Arm", "ForeArm")]
    modelled = grown(skin.regions["hands"] | skin.regions["feet"], skin.triangles, OWN_RINGS)
    modelled |= np.isin(skin.bones[:, 0], arms)  # silhouettes fill the gap between a bent arm and the trunk
    return BodySurface(own, skin.triangles, modelled, face, skin.regions["head"])


@dataclass(frozen=True)
class Sighting:
    """What was seen of a person.

    cloud : points that enough views saw, metres.
    masks : (H, W) bool, where each view has the person.
    cameras : the views', each of its mask's size.
    near : how many views, the last ones, are of the clip of the head.
    """

    cloud: PointCloud
    masks: Sequence[NDArray[np.bool_]]
    cameras: Sequence[Camera]
    near: int = 0


def standing_points(human: HumanModels, vertices: NDArray[np.float64], seen: Sighting) -> NDArray[np.floating]:
    """(M, 3) the points of all that stands off the body of the person whose template vertices are (V, 3), metres."""
    body = body_surface(human, vertices)
    silhouettes = _silhouettes(body, seen)
    skirt = skirt_around(body, legs_of(human, body.vertices), silhouettes, seen.cloud)
    points = seen.cloud.points
    if skirt is None:
        return points_standing_off(points, body, standing_volume(body, silhouettes).pieces[:MAX_PIECES])
    cloth = skirt.is_cloth(points)
    pieces = standing_volume(body, silhouettes, skirt.within).pieces[:MAX_PIECES]
    return np.concatenate([points[cloth], points_standing_off(points[~cloth], body, pieces)])


def attachments(human: HumanModels, vertices: NDArray[np.float64], seen: Sighting) -> Attachments:
    """What the person wears whose template vertices are (V, 3), metres."""
    body = body_surface(human, vertices)
    silhouettes = _silhouettes(body, seen)
    skirt = skirt_around(body, legs_of(human, body.vertices), silhouettes, seen.cloud)
    volume = standing_volume(body, silhouettes, None if skirt is None else skirt.within)
    around = seen_around(body, volume.hull, seen.cloud, seen.cameras, seen.near)
    meshes = []
    for piece in volume.pieces[:MAX_PIECES]:
        meshes += piece_meshes(*solid(piece, body, silhouettes, around, seen.cloud))
    meshes = [mesh for mesh in meshes if seen_area(mesh, body) > MIN_SEEN_SQUARE_METRES]
    bare = body.without_own()
    ring = None if skirt is None else seen_part(skirt_mesh(skirt), bare)
    free = MAX_ATTACHED_TRIANGLES - (0 if ring is None else len(ring[1]))
    areas = [seen_area(mesh, body) for mesh in meshes]
    density = min(1 / MIN_TRIANGLE_SQUARE_METRES, free / max(sum(areas), MIN_SEEN_SQUARE_METRES))
    meshes = [simplified(mesh, body, int(area * density)) for mesh, area in zip(meshes, areas, strict=True)]
    joint_weights = _joint_weights(human)
    moved = [influences(*mesh, body, joint_weights, _head(human)) for mesh in meshes]
    if skirt is not None and ring is not None:
        meshes.append(ring)
        moved.append(leg_influences(*ring, bare, skirt.legs, joint_weights))
    if not meshes:
        return no_attachments()
    whole = _joined(meshes)
    return Attachments(
        *whole,
        _placed(human, vertices, whole),
        np.concatenate([bones for bones, _ in moved]),
        np.concatenate([weights for _, weights in moved]),
    )


def _silhouettes(body: BodySurface, seen: Sighting) -> Silhouettes:
    return silhouettes_beside(body, seen.masks, seen.cameras, seen.near)


def _joint_weights(human: HumanModels) -> NDArray[np.float32]:
    """(S, J) what each joint does to each vertex of the skin."""
    skin = human.skin
    out = np.zeros((len(skin.vertices), len(human.rig.names)), np.float32)
    np.add.at(out, (np.arange(len(out))[:, None], skin.bones), skin.weights)
    return out


def _head(human: HumanModels) -> NDArray[np.bool_]:
    """(J,) the joints of the head; that of all of it comes first of them."""
    return np.isin(human.rig.names, HEAD_JOINT_NAMES)


def _joined(meshes: Sequence[Mesh]) -> Mesh:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    triangles = [triangles + start for (_, triangles), start in zip(meshes, starts, strict=False)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(triangles).astype(np.int32)


def _placed(human: HumanModels, vertices: NDArray[np.float64], mesh: Mesh) -> TextureAtlas:
    """The atlas of pieces on the avatar's texture, as fine as the skin is there, or as its free room lets it be."""
    template = human.template
    faces = template.faces(*AVATAR_PARTS)
    taken = atlas_from_uv(avatar_uv(template), triangulate(template.uv_quads[faces]))
    skin = template.faces("body")
    own, _ = unwrap(*mesh, UNWRAPPED_SIZE_TEXELS)
    skin_uv = atlas_from_uv(avatar_uv(template), triangulate(template.uv_quads[skin]))
    fineness = _fineness(skin_uv, vertices, triangulate(template.quads[skin])) / _fineness(own, *mesh)
    return placed_between(cells_of(taken), own, fineness)


def _fineness(atlas: TextureAtlas, vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> float:
    """The side of the texture is so many metres' inverse: how long a metre is on it, in the mean over the surface."""
    first, second, third = (atlas.uv[atlas.corners[:, k]].astype(np.float64) for k in range(3))
    along, across = second - first, third - first
    flat = np.abs(along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]).sum() / 2
    return float(np.sqrt(flat / triangle_areas(vertices, triangles).sum()))
