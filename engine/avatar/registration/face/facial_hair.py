"""Moustaches and beards: how far hair stands off the face on which it grows.

The skin's own fit leaves hair out: it is another surface before the skin, to which lips and jaw would be drawn. What the head's cloud
has there becomes a relief, as far before the fitted skin as it lies.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree

from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.template_skin.skin import Skin, grown
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import vertex_areas, vertex_normals
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.media.colour_conversion.tone_mapping import srgb_light

MAX_HAIR_METRES = 0.025
"""Metres from the skin up to which a point can be of hair that grows there."""
HAIR_DARKNESS = 1.1
"""Natural logarithm of how many times less light comes from hair than from the cheeks, at least: a third, as a beard is told by."""
HAIR_LIGHT_OFFSET = 1e-3
"""Share of white's light that is added before logarithms are taken."""
HAIR_POINT_REACH_METRES = 0.003
"""Metres from a vertex, along the skin, within which points tell what is there."""
MIN_HAIR_POINTS = 4
"""Dark points that tell of a vertex, at least."""
HAIR_EDGE_SHARES = (0.25, 0.75)
"""Share of the points about a vertex that are dark, where hair begins to stand off, and where it does wholly."""
HAIR_QUANTILE = 0.75
"""Of the points' distances from the skin: stereo rounds hair off, of which the median is 2 mm too low."""
UNTOLD_WEIGHT = 1e-6
"""What a vertex weighs that no point tells of and others of the hair enclose."""
LIP_TAPER_RINGS = 3
"""Rings of vertices from where the lips meet over which hair comes up to its height."""
MIN_HAIR_HEIGHT_METRES = 0.002
"""Metres by which hair stands off in the mean, at least; less is stubble, or a shadow."""
MIN_HAIR_SQUARE_METRES = 2e-4
"""Square metres of skin on which hair stands off, at least."""
BEARD_START_METRES = 0.03
"""Metres from the lips within which a beard or a moustache begins: what does not is a collar, a strap or long hair."""
STIFF_HAIR_METRES, HAIR_MOTION_ROUNDS = 0.005, 12
"""Metres of height from which hair moves as one with what is around it, and rounds in which its motion becomes its neighbours' mean."""


def facial_hair(skin: Skin, fitted: NDArray[np.float64], cloud: PointCloud) -> NDArray[np.float64]:
    """(S,) metres by which hair on the lower face stands off the `fitted` skin (S, 3), along its normals; zero where there is none.

    `cloud`, of the head's clip, in the same world. What is dark there beside the cheeks, and lies before the skin, is hair; fair hair
    is not told from skin.
    """
    grows = _where_hair_grows(skin, fitted)
    feet, heights, light = _before_skin(skin, fitted, cloud)
    own = cKDTree(fitted).query(feet)[1]
    cheeks = _cheeks(skin, fitted)[own]
    if not cheeks.any():
        return np.zeros(len(fitted))
    dark = np.median(light[cheeks]) - light > HAIR_DARKNESS
    height, share = _heights(fitted, np.flatnonzero(grows), feet, heights, dark)
    relief = _relief(skin, grows, height) * _rise(share)
    return np.where(_beard(skin, fitted, relief), np.maximum(relief, 0) * _lip_taper(skin), 0.0)


def with_facial_hair(skin: Skin, person: FittedTemplate, relief: NDArray[np.float64]) -> FittedTemplate:
    """The `person`, whose skin has no hair, with a `relief` (S,) of it, metres, in both poses.

    Expressions move hair as they move the skin below, but stiffly where it is thick: it is not drawn out as a cheek is.
    """
    if not relief.any():
        return person
    vertices, rest = person.vertices.copy(), person.rest.copy()
    off = relief[:, None] * vertex_normals(vertices[skin.vertices], skin.triangles)
    turns = np.einsum("sk,skab->sab", skin.weights, person.rotations[skin.bones])
    vertices[skin.vertices] += off
    rest[skin.vertices] += np.einsum("sab,sa->sb", turns, off).astype(np.float32)
    hair = np.flatnonzero(relief > 0)
    stiff = np.minimum(relief[hair] / STIFF_HAIR_METRES, 1)[:, None]
    beside = neighbours(skin.triangles, len(relief))[hair][:, hair] + sp.eye_array(len(hair))
    mean = sp.diags_array(1 / np.asarray(beside.sum(1)).ravel()) @ beside
    expressions = {}
    for name, displacements in person.expressions.items():
        moved = displacements.copy()
        smooth = own = moved[skin.vertices[hair]].astype(np.float64)
        for _ in range(HAIR_MOTION_ROUNDS):
            smooth = mean @ smooth
        moved[skin.vertices[hair]] = own + stiff * (smooth - own)
        expressions[name] = moved
    return replace(person, vertices=vertices, rest=rest, expressions=expressions)


def _up(face: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3,) the unit vector up a face (68, 3), across its eyes and in the plane of eyes and chin."""
    across = face[45] - face[36]
    up = np.cross(np.cross(across, face[27] - face[8]), across)
    return np.asarray(up / np.linalg.norm(up))


def _where_hair_grows(skin: Skin, fitted: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(S,) the skin below the nose and before the ends of the jaw."""
    face = fitted[skin.face_points]
    ahead = np.cross(face[45] - face[36], _up(face))
    below = (fitted - face[33]) @ _up(face) < 0
    before = (fitted - face[[0, 16]].mean(0)) @ ahead > 0
    return np.asarray(skin.regions["head"] & ~skin.regions["inner"] & below & before)


def _cheeks(skin: Skin, fitted: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(S,) the face between the eyes and the end of the nose, which no beard covers."""
    face = fitted[skin.face_points]
    low, high = (face[33] @ _up(face), face[[36, 45]].mean(0) @ _up(face))
    height = fitted @ _up(face)
    return np.asarray(skin.regions["face"] & ~skin.regions["lids"] & (height > low) & (height < high))


def _before_skin(
    skin: Skin, fitted: NDArray[np.float64], cloud: PointCloud
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Of the M points about the head: where on the skin they lie (M, 3), how far before it (M,), and their light's logarithm (M,)."""
    near = cKDTree(fitted[skin.regions["head"]]).query(cloud.points, distance_upper_bound=2 * MAX_HAIR_METRES)[0]
    cloud = cloud[np.isfinite(near)]
    shown = skin.triangles[skin.visible]
    found = closest_points(cloud.points, fitted, shown)
    feet = found.interpolated(fitted, shown)
    across = found.interpolated(vertex_normals(fitted, skin.triangles), shown)
    heights = np.einsum("nd,nd->n", cloud.points - feet, across)
    used = np.abs(heights) < MAX_HAIR_METRES
    light = srgb_light(cloud.colours[used].astype(np.float32) / 255) @ LUMINANCE_WEIGHTS
    return feet[used], heights[used], np.log(light + HAIR_LIGHT_OFFSET)


def _heights(
    fitted: NDArray[np.float64],
    grows: NDArray[np.intp],
    feet: NDArray[np.float64],
    heights: NDArray[np.float64],
    dark: NDArray[np.bool_],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of all vertices (S,), how far dark points lie before the skin, metres, NaN where there are few or it is not one of those
    numbered `grows`; and which share of the points there is dark, 1 where nothing is known."""
    height, share = np.full(len(fitted), np.nan), np.ones(len(fitted))
    about = cKDTree(feet).query_ball_point(fitted[grows], HAIR_POINT_REACH_METRES)
    for vertex, found in zip(grows, about, strict=True):
        beside = np.asarray(found, np.intp)
        if len(beside) < MIN_HAIR_POINTS:
            continue
        of_hair = dark[beside]
        share[vertex] = of_hair.mean()
        if of_hair.sum() >= MIN_HAIR_POINTS and share[vertex] > HAIR_EDGE_SHARES[0]:
            height[vertex] = np.quantile(heights[beside][of_hair], HAIR_QUANTILE)
    return height, share


def _rise(share: NDArray[np.float64]) -> NDArray[np.float64]:
    """(S,) from 0 to 1 as the `share` of dark points goes from one of `HAIR_EDGE_SHARES` to the other."""
    low, high = HAIR_EDGE_SHARES
    return np.clip((share - low) / (high - low), 0, 1)


def _relief(skin: Skin, grows: NDArray[np.bool_], height: NDArray[np.float64]) -> NDArray[np.float64]:
    """(S,) the heights that are known, smoothly, and between them without holes and notches; zero elsewhere."""
    known = np.isfinite(height)
    own = grows & ~grown(~grown(known, skin.triangles, 1), skin.triangles, 1)
    out = np.zeros(len(grows))
    if own.any():
        weight = np.where(known, 1.0, UNTOLD_WEIGHT)
        beside = neighbours(skin.triangles, len(grows))[own][:, own]
        laplacian = sp.diags_array(np.asarray(beside.sum(1)).ravel()) - beside
        told = np.where(known, height, 0.0)[own]
        out[own] = spsolve(sp.csc_array(sp.diags_array(weight[own]) + laplacian), weight[own] * told)
    return out


def _beard(skin: Skin, fitted: NDArray[np.float64], relief: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(S,) those connected parts of a relief that begin at the mouth, are large, and clearly stand off."""
    own = np.flatnonzero(relief != 0)
    part = connected_components(neighbours(skin.triangles, len(relief))[own][:, own], directed=False)[1]
    areas = vertex_areas(fitted, skin.triangles)[own]
    mouth = cKDTree(fitted[skin.face_points[48:60]]).query(fitted[own])[0] < BEARD_START_METRES
    area = np.bincount(part, areas)
    height = np.bincount(part, areas * relief[own]) / np.maximum(area, 1e-12)
    stands = (area > MIN_HAIR_SQUARE_METRES) & (height > MIN_HAIR_HEIGHT_METRES) & (np.bincount(part, mouth) > 0)
    out = np.zeros(len(relief), np.bool_)
    out[own] = stands[part]
    return out


def _lip_taper(skin: Skin) -> NDArray[np.float64]:
    """(S,) 0 where the lips meet, rising to 1 over `LIP_TAPER_RINGS` rings of vertices."""
    region = np.zeros(len(skin.vertices), np.bool_)
    region[np.unique(skin.lip_contact.indices)] = True
    out = np.ones(len(region))
    for ring in range(LIP_TAPER_RINGS):
        out[region & (out == 1)] = ring / LIP_TAPER_RINGS
        region = grown(region, skin.triangles, 1)
    return out
