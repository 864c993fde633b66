"""A hand's filmed colours and its painted ones made one: filmed where a frame shows it well, painted in their tone elsewhere.

What differs between the two is solved for over the hand's surface, whose charts are cut and the surface is not: near to what frames
show, and with the least gradient elsewhere (P. Perez, M. Gangnet, A. Blake, Poisson image editing, SIGGRAPH 2003), so that the painted
details stand in the filmed tones. The details themselves then pass from one to the other over a soft rim (P. J. Burt, E. H. Adelson,
A multiresolution spline with application to image mosaics, ACM TOG 2, 1983).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from engine.avatar.texture.template_texture.hand_colours import like_skin
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.geometry.adjacency import edge_table
from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.surface import triangle_areas
from engine.imaging.histogram_matching import to_lab

FINGER_WIDTH = 0.016
"""Metres: the width of a finger ..."""
FINGER_PIXELS = (5.0, 9.0)
"""... and the pixels across it of a frame that shows no detail of hands yet, and of one that shows all that a painted hand has."""
TONE_LENGTH = 0.008
"""Metres over which the difference of filmed and painted colours is a matter of tone, and not of detail."""
RIM_LENGTH = 0.004
"""Metres over which details pass from filmed to painted ones."""
UNTOLD = 1e-4
"""Of an area that frames do not show, against one that they do: what holds a tone where they show nothing."""


@dataclass(frozen=True)
class HandSurface:
    """A hand by itself: `triangles` (T, 3) into its `vertices` (V, 3), metres, and which of the whole surface's `faces` (T,) these
    are, ascending; `rim` (V,) bool: those at which the arm goes on."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.intp]
    faces: NDArray[np.intp]
    rim: NDArray[np.bool_]

    @staticmethod
    def of(vertices: NDArray[np.floating], triangles: NDArray[np.integer], part: NDArray[np.bool_]) -> HandSurface:
        """That of the triangles `part` (F,) of a surface's `triangles` (F, 3) into its `vertices` (N, 3)."""
        faces = np.flatnonzero(part)
        used, corners = np.unique(triangles[faces], return_inverse=True)
        others = np.isin(used, triangles[~part])
        return HandSurface(np.asarray(vertices, np.float64)[used], corners.reshape(-1, 3), faces, others)


def joined_hand(
    hand: HandSurface,
    texels: PartTexels,
    filmed: NDArray[np.floating],
    painted: NDArray[np.floating],
    resolution: NDArray[np.floating],
    tone: NDArray[np.floating],
) -> NDArray[np.float64]:
    """(N, 3) the colours of a hand's texels.

    Parameters
    ----------
    texels : N of them, of the whole surface's faces.
    filmed, painted : (N, 3) 0 to 255.
    resolution : (F,) pixels per metre at which the frame that each face of the whole surface took shows it; 0 where none does.
    tone : (3,) CIELAB, of the person's skin: what is shown of another colour is no hand, unless it comes out of the arm.
    """
    number = np.searchsorted(hand.faces, texels.triangles)
    shown = resolution[hand.faces] > 0
    skin = shown & like_skin(to_lab(_means(filmed, number, len(hand.faces))), tone)
    sleeve = _out_of_the_arm(hand, shown & ~skin)
    areas = triangle_areas(hand.vertices, hand.triangles)
    stiff = cotangent_laplacian(hand.vertices, hand.triangles)

    corners = hand.triangles[number]
    told = texels.shares * (skin * areas / np.maximum(np.bincount(number, minlength=len(areas)), 1))[number][:, None]
    off = np.asarray(filmed, np.float64) - painted
    size = len(hand.vertices)
    mass = np.bincount(corners.ravel(), told.ravel(), size)
    pulls = np.stack([np.bincount(corners.ravel(), (told * off[:, [k]]).ravel(), size) for k in range(3)], 1)
    whole = np.bincount(hand.triangles.ravel(), areas.repeat(3) / 3, size)
    change = _smooth(stiff, mass + UNTOLD * whole, pulls, TONE_LENGTH)

    trusted = _at_vertices(hand, areas, skin | sleeve)
    inner = np.clip(2 * _smooth(stiff, whole, whole * trusted, RIM_LENGTH) - 1, 0, 1)
    few, enough = FINGER_PIXELS
    sharp = np.clip((resolution[hand.faces] * FINGER_WIDTH - few) / (enough - few), 0, 1)
    detail = inner * _smooth(stiff, whole, whole * _at_vertices(hand, areas, np.where(sleeve, 1.0, sharp)), RIM_LENGTH)

    toned = painted + np.einsum("nk,nkc->nc", texels.shares, change[corners])
    share = np.einsum("nk,nk->n", texels.shares, detail[corners])
    share = np.where(sleeve[number], 1.0, np.where(skin[number], share, 0.0))[:, None]
    return np.asarray(toned + share * (filmed - toned))


def _means(colours: NDArray[np.floating], number: NDArray[np.intp], count: int) -> NDArray[np.float64]:
    """(T, 3) the mean of the colours (N, 3) of each of `count` faces, by their `number` (N,); black of those without."""
    total = np.maximum(np.bincount(number, minlength=count), 1)
    return np.stack([np.bincount(number, colours[:, k], count) / total for k in range(3)], 1)


def _out_of_the_arm(hand: HandSurface, other: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(T,) those of the faces that are `other` (T,) than skin which hang together with the arm's: of a sleeve, or a glove."""
    table = edge_table(np.ascontiguousarray(hand.triangles, np.int32), np.arange(len(hand.vertices), dtype=np.int32))
    pairs = table[table[:, 3] >= 0, 2:]
    pairs = pairs[other[pairs].all(1)]
    links = sp.csr_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(other), len(other)))
    piece = connected_components(links, directed=False)[1]
    beginning = other & hand.rim[hand.triangles].any(1)
    return other & np.isin(piece, piece[beginning])


def _at_vertices(hand: HandSurface, areas: NDArray[np.float64], values: NDArray[np.generic]) -> NDArray[np.float64]:
    """(V,) the means of what the faces (T,) around each vertex have, by their areas."""
    corners, size = hand.triangles.ravel(), len(hand.vertices)
    total = np.bincount(corners, areas.repeat(3), size)
    return np.bincount(corners, (areas * values).repeat(3), size) / np.maximum(total, 1e-12)


def _smooth(
    laplacian: sp.csr_array, mass: NDArray[np.float64], pulls: NDArray[np.float64], length: float
) -> NDArray[np.float64]:
    """(V,) or (V, C): what is near to `pulls` over `mass` (V,), square metres, and smooth over a `length` in metres."""
    return np.asarray(splu(sp.csc_array(sp.diags_array(mass) + length**2 * laplacian)).solve(pulls))
