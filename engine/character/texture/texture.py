"""The character's colours: one texture of the picture's own pixels, of what is hidden, and of the back.

The paper's section 5. The front is made by projection, and its regions behind limbs are filled by PatchMatch. The back
is a mirrored copy of the front, on which the face gives way to what surrounds it (hair, a hat). Beyond it, what only
fronts have gives way, too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.figure.face_region import within_oval
from engine.character.figure.silhouette import OPAQUE_ALPHA
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS, complete_labels
from engine.character.parts.limb_edges import soft_limbs
from engine.character.surface.front_and_back import ClosedMesh
from engine.character.texture.head_texture import back_of_the_head
from engine.character.texture.limb_texture import LimbSurfaces, behind_another, filled, own_of_limbs, paint_limbs
from engine.character.texture.rings import rings
from engine.character.texture.sides import places_on_the_picture
from engine.character.texture.trunk_back import with_trunk_back
from engine.imaging.filling.inpaint import inpaint
from engine.imaging.filling.nearest import continued_colours
from engine.imaging.filling.poisson import poisson_blend
from engine.imaging.masks.mask_distance import distance_inside, distance_to
from engine.imaging.masks.usual_colours import usual_colours
from engine.imaging.resample import enlarged_mask

BackTexture = Literal["see_through", "mirror", "inpaint"]

MIN_NOT_BACKGROUND_ALPHA = 0.05
"""Alpha from which a pixel's colour is not the background's alone."""
MIN_PART_HALF_WIDTH_PIXELS = 4.0
"""Pixels from the edge of a part to its middle, below which it has no middle of its own."""
SIDE_REACH_SHARE = 0.4
"""How far the sides of a part reach in, as a share of the way to its middle."""
MAX_LEVEL_DIFFERENCE = 8.0
"""Levels by which front and back differ where they are not the same."""
INNER_FACE_FACTORS = np.array([1, 1, 0.7, 0.7, 1], np.float32)
"""Factors of a face's oval within which it shows skin."""
SEAM_START_PIXELS, SEAM_END_PIXELS = 2.0, 8.0
"""Pixels of the grid from the outline up to which the back is the front, and from which on it is itself."""
HEAD_SEAM_START_PIXELS, HEAD_SEAM_END_PIXELS = 1.8, 4.9
"""Pixels of a head up to which the back is the front, and from which on it is itself. The back's colours begin on the
front, a pixel and a half within the outline. Hair begins where ears and temples end, which is about where the outline
is."""
MIXED_LIMB_EDGE_PIXELS = 1.5
"""Pixels of the grid within a limb's edge in which its colours are mixed with others."""
LIMB_NEIGHBOURHOOD_SHARE = 0.04
"""How far from a limb the body is looked at for what it is made of behind it, as a share of the person's height: what is
printed on a shirt's middle is not on its sides, too."""
MAX_TILE_HEIGHT_PIXELS, MAX_TEXTURE_WIDTH_PIXELS = 2048, 4096
"""Pixels of height of a tile, and of width of the whole texture, at most: what every graphics card takes."""
TILE_COUNT = 3


@dataclass(frozen=True)
class Tiles:
    """Pictures of one size that cover the grid on which the mesh was made.

    limbs : (h, w, 3) those that are apart.
    body : (h, w, 3) what is left without them before it.
    back : (h, w, 3) its back.
    head : (h, w) where its head is.
    scale : their pixels for each of the grid's.
    shift : (2,) by how many of them x and y are further, so that pixels fall on pixels of the picture.
    behind : a limb that goes on behind another: which that is, an index of `BODY_PARTS`, and its colours (h, w, 3).
    """

    limbs: NDArray[np.uint8]
    body: NDArray[np.uint8]
    back: NDArray[np.uint8]
    head: NDArray[np.bool_]
    scale: float
    shift: NDArray[np.float64]
    behind: tuple[int, NDArray[np.uint8]] | None = None


@dataclass(frozen=True)
class PictureOnGrid:
    """A picture of somebody, and where it lies on the grid."""

    rgb: NDArray[np.uint8]
    """(H, W, 3)."""
    alpha: NDArray[np.float32]
    """(H, W) the person's mask."""
    to_grid: NDArray[np.float64]
    """(2, 3) from the picture's pixels to those of the grid."""


def paint_tiles(
    picture: PictureOnGrid,
    labels: Labels,
    surfaces: LimbSurfaces,
    face: NDArray[np.float32] | None,
    back: BackTexture,
    turned: float | None = 0.0,
) -> Tiles:
    """Paint the tiles.

    Parameters
    ----------
    labels : what each pixel of the grid shows.
    face : an ellipse around the face on the grid, as centre x, y, half axes and angle in degrees; None where there is no
        face.
    back : where the back's colours come from.
    turned : to which side the face looks, as `face_region.face_turn` says; None in profile: then both sides of the head are alike.
    """
    rgb, alpha, to_grid, along = picture.rgb, picture.alpha, picture.to_grid, surfaces.along
    limbs = own_of_limbs(np.isin(labels.labels, labels.apart), surfaces.shown)
    shape = limbs.shape
    tiles = TILE_COUNT + (labels.behind is not None)
    scale = min(
        1 / float(to_grid[0, 0]), MAX_TILE_HEIGHT_PIXELS / shape[0], MAX_TEXTURE_WIDTH_PIXELS // tiles / shape[1]
    )
    size = (round(shape[1] * scale), round(shape[0] * scale))
    matrix = to_grid * scale
    matrix[:, 2] += (scale - 1) / 2
    shift = np.rint(matrix[:, 2]) - matrix[:, 2]
    matrix[:, 2] += shift
    shrinks = matrix[0, 0] < 1
    flags = cv2.INTER_AREA if shrinks else cv2.INTER_CUBIC
    seen = np.asarray(cv2.warpAffine(rgb, matrix, size, flags=flags, borderMode=cv2.BORDER_REPLICATE), np.uint8)
    covered = np.asarray(cv2.warpAffine(alpha, matrix, size, flags=cv2.INTER_LINEAR))
    own = covered > OPAQUE_ALPHA
    bordered = seen
    around = soft_limbs(limbs, seen) > 0.5
    seen = continued_colours(seen, own)
    oval = None if face is None else face * np.array([*[scale] * 4, 1])
    deep = own & (distance_inside(around | ~own) > MIXED_LIMB_EDGE_PIXELS * scale) | own & ~around
    skin = None if oval is None else np.median(seen[within_oval(oval, own.shape) & own], axis=0)
    wanted = {int(limb) for limb in labels.apart}
    wanted |= set(LEG_LABELS) if wanted & set(LEG_LABELS) else set()
    round_them = rings(seen, labels.labels, deep, surfaces.heights, skin, wanted)
    body = _behind_the_limbs(seen, labels, around, own, oval, round_them) if limbs.any() else seen
    if along is not None:
        body = np.where((enlarged_mask(along & limbs, size) & own)[..., None], seen, body)
    behind = _behind(body, labels, surfaces, own, back, scale)
    head = enlarged_mask(labels.labels == BODY_PARTS.index("head"), size) & own
    beside = body
    if oval is not None and turned is not None and head.any():
        behind, beside = back_of_the_head(
            behind, bordered, covered > MIN_NOT_BACKGROUND_ALPHA, own, head, oval, turned, scale
        )
    apart = paint_limbs(seen, own, around, labels, replace(surfaces, shown=limbs), oval, scale, round_them)
    hidden = None
    if labels.behind is not None:
        hidden = labels.behind.limb, behind_another(apart, labels, labels.behind, seen, own, oval)
    back_tile = joined_at_the_outline(beside, behind, own, head, scale)
    return Tiles(apart, body, back_tile, head, scale, shift, hidden)


def atlas(tiles: Tiles, mesh: ClosedMesh, body_layer: int) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """One texture (h, 3 w, 3), two tiles wide where no limb hides anything, four where one hides another; and each vertex' place
    on it (V, 2)."""
    limbs_apart = bool((mesh.layer != body_layer).any())
    pictures = [tiles.limbs, tiles.body, tiles.back] if limbs_apart else [tiles.body, tiles.back]
    if limbs_apart and tiles.behind is not None:
        pictures.insert(1, tiles.behind[1])
    tile = np.where(mesh.layer == body_layer, np.where(mesh.front, len(pictures) - 2, len(pictures) - 1), 0)
    if limbs_apart and tiles.behind is not None:
        tile[mesh.limb == tiles.behind[0]] = 1
    height, width = tiles.body.shape[:2]
    apart = np.abs(cv2.subtract(tiles.body, tiles.back, dtype=cv2.CV_16S)).max(-1) > MAX_LEVEL_DIFFERENCE
    grid = (round(width / tiles.scale), round(height / tiles.scale))
    barred = cv2.resize((apart | tiles.head).astype(np.float32), grid, interpolation=cv2.INTER_AREA) > 0.25
    place = ((places_on_the_picture(mesh, barred, body_layer) + 0.5) * tiles.scale + tiles.shift) / [width, height]
    place[:, 0] = (np.clip(place[:, 0], 0, 1) + tile) / len(pictures)
    return np.concatenate(pictures, 1), place.astype(np.float32)


def _behind_the_limbs(
    seen: NDArray[np.uint8],
    labels: Labels,
    limbs: NDArray[np.bool_],
    own: NDArray[np.bool_],
    face: NDArray[np.floating] | None,
    round_them: Mapping[int, NDArray[np.float32]],
) -> NDArray[np.uint8]:
    """The body (h, w, 3) where `limbs` (h, w) hide it, filled from what is nearby. The head is filled from the head
    without its face, a leg behind the other from that leg, all else from all else. So no dress is made of hair."""
    size = (own.shape[1], own.shape[0])
    bare = np.where(np.isin(labels.labels, labels.apart), -1, labels.labels)
    beneath = complete_labels(labels.labels >= 0, bare)
    head = enlarged_mask(beneath == BODY_PARTS.index("head"), size)
    away = distance_to(limbs) / size[1]
    body = continued_colours(seen, own & ~limbs)
    shown = own & ~limbs & (away < LIMB_NEIGHBOURHOOD_SHARE)
    if face is not None:
        shown &= ~(head & within_oval(face, shown.shape))
    leg = enlarged_mask(np.isin(beneath, LEG_LABELS) & bool(np.isin(labels.apart, LEG_LABELS).any()), size)
    hidden = limbs & own
    if labels.cloth is not None and labels.cloth.legs is not None:
        hidden &= ~enlarged_mask(labels.cloth.legs >= 0, size)  # nothing is behind what comes out from under a hem
    for part in (head, ~head & ~leg):
        body = inpaint(body, hidden & part, usual_colours(seen, shown & part))
    for one in LEG_LABELS:
        part = leg & enlarged_mask(beneath == one, size)
        body = filled(body, hidden & part, usual_colours(seen, shown & part), round_them.get(one))
    return continued_colours(body, own)


def joined_at_the_outline(
    front: NDArray[np.uint8],
    back: NDArray[np.uint8],
    own: NDArray[np.bool_],
    head: NDArray[np.bool_],
    scale: float,
) -> NDArray[np.uint8]:
    """The back (h, w, 3) with the front's colours at the outline of `own` (h, w), and from there inward its own gradients (the
    paper's Poisson-blended seam); on the `head` (h, w) sooner. `scale`: pixels for each of the grid's."""
    begin, end = (
        np.where(head, HEAD_SEAM_START_PIXELS, SEAM_START_PIXELS),
        np.where(head, HEAD_SEAM_END_PIXELS, SEAM_END_PIXELS),
    )
    depth = distance_inside(own)
    band = (depth > begin * scale) & (depth < end * scale)
    held = np.where((depth <= begin * scale)[..., None], front, back).astype(np.float32)
    joined = poisson_blend(back.astype(np.float32), held, band)
    return np.asarray(np.clip(joined + 0.5, 0, 255), np.uint8)


def _behind(
    rgb: NDArray[np.uint8],
    labels: Labels,
    surfaces: LimbSurfaces,
    own: NDArray[np.bool_],
    back: BackTexture,
    scale: float,
) -> NDArray[np.uint8]:
    """What the body has at its back, but for the head: the front (h, w, 3), as it is or as `back` says."""
    if back == "mirror":
        return rgb
    if back == "inpaint":
        return _from_the_sides(rgb, labels, (own.shape[1], own.shape[0]), own)
    size = (own.shape[1], own.shape[0])
    torso, head = (BODY_PARTS.index(name) for name in ("torso", "head"))
    limbs = np.isin(labels.labels, labels.apart)
    held = np.zeros_like(limbs) if labels.held is None else labels.held >= 0
    of_somebody = (labels.labels >= 0) | held
    within = of_somebody if surfaces.body is None else surfaces.body & of_somebody
    beneath = complete_labels(within, np.where(limbs, -1, labels.labels))
    if surfaces.along is not None:
        within &= ~(surfaces.along & limbs)
    shown = np.isin(labels.labels, (torso, *LEG_LABELS))
    others = of_somebody & ~shown
    if surfaces.before is not None:
        others |= surfaces.before
    masks = within & (beneath == torso), shown, others, labels.labels == head
    trunk, shown, others, above = (enlarged_mask(one, size) & own for one in masks)
    return with_trunk_back(rgb, trunk, shown, others, above, scale)


def _from_the_sides(
    rgb: NDArray[np.uint8], labels: Labels, size: tuple[int, int], own: NDArray[np.bool_]
) -> NDArray[np.uint8]:
    """The middle of each part of the body filled with patches of its sides (the paper's second way to a back). What is
    printed, buttoned or worn in front is not on the back. At the outline front and back are one."""
    out = rgb
    for part, name in enumerate(BODY_PARTS):
        if name == "head":
            continue  # its middle is the face
        region = enlarged_mask(labels.labels == part, size) & own
        depth = distance_inside(region)
        if (thick := float(depth.max())) < MIN_PART_HALF_WIDTH_PIXELS:
            continue
        middle = depth > SIDE_REACH_SHARE * thick
        out = inpaint(out, middle, region & ~middle)
    return out
