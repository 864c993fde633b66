"""The template's skin, which is what gets laid on points, and which of it is what."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from engine.avatar.registration.template_skin.face_landmarks import landmark_vertices
from engine.avatar.registration.template_skin.lid_rims import lid_rim
from engine.avatar.registration.template_skin.lip_contact import lip_contact
from engine.body.body_space import BodySpace
from engine.body.cache import cached_arrays
from engine.body.lip_sides import lip_rims, lip_sides
from engine.body.rig import Rig
from engine.body.template import Template, mouth_faces, vertex_mask
from engine.geometry.camera import Camera
from engine.geometry.mesh.adjacency import edge_table, edges, neighbours
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.render.rasterisation.rasteriser import rasterise

FACE_RADII = np.array([0.085, 0.106, 0.106])
"""Metres about the tip of the nose, x, y and z, within which the head is face."""
HEAD_VIEW_COUNT, HEAD_VIEW_DISTANCE_METRES, HEAD_VIEW_PIXELS = 120, 0.6, 700
"""From how many sides, from how far away (metres), and how large (pixels), a head is looked at to find what is seen of it."""
LIP_UNITS = ("mouthRollLower", "mouthRollUpper", "mouthFunnel", "mouthPucker", "mouthPressLeft", "mouthPressRight")
"""Face units that move lips and the skin above and below, where a moustache or a beard grows."""
LID_UNITS = ("eyeBlinkLeft", "eyeBlinkRight")
EYE_PARTS = ("left_eye", "right_eye")
CLOSE_LID_RINGS = 3
"""Rings of vertices about the rims of lids that are close to them."""
MIN_UNIT_MOTION_METRES = 0.002
"""Metres by which a face unit moves skin, at least, for that to be moved by it."""
NIPPLE_BOX_METRES = np.array([[-0.25, 1.0, 0.03], [0.25, 1.6, 1.0]])
FINE_EDGE_METRES = 0.009
"""Vertices of the trunk whose edges are shorter in the mean, metres, are nipples (or the navel), which no clothes show."""

MIN_WHOLE_HAND_WEIGHT = 0.99
"""What joints of a hand share at least in a vertex that the forearm does not bend."""
LOWER_FOOT_LENGTH_SHARE = 0.2
"""Of a foot's length: so far above the ground it is the lower foot."""


@dataclass(frozen=True)
class Skin:
    """The part `body` of the template by itself: one closed surface of S vertices.

    vertices : (S,) which of the template's vertices these are, ascending.
    triangles : (T, 3) into them, counter-clockwise from outside.
    visible : (T,) seen from outside; the mouth's inside and the eyes' sockets are not.
    bones, weights : (S, K) the joints that move each, and by how much, summing to one.
    regions : masks (S,) by name: `head`, `face`, `lips` (with the skin around), `upper_lip` and `lower_lip` (outside and
        within: `engine.body.lip_sides`), `lids`, `hands`, `whole_hands` (those that no forearm moves), `feet`, `lower_feet` (what a shoe covers at least), `inner` (part of no visible
        triangle), `hidden_by_cloth` (nipples, navel). `left_eye_rim` and `right_eye_rim` are where lids end before the
        eyeball (`engine.avatar.registration.template_skin.lid_rims`), `left_eye_lids` and `right_eye_lids` what is
        close to there. `left_ear` and `right_ear` are the person's own.
    face_points : (68,) the face landmarks, all of them vertices that are seen from the front.
    lip_contact : (C, S) the lips' contact (`engine.avatar.registration.template_skin.lip_contact`).
    """

    vertices: NDArray[np.intp]
    triangles: NDArray[np.int32]
    visible: NDArray[np.bool_]
    bones: NDArray[np.uint8]
    weights: NDArray[np.float32]
    regions: Mapping[str, NDArray[np.bool_]]
    face_points: NDArray[np.intp]
    lip_contact: sp.csr_array

    def index_of(self, template_vertices: NDArray[np.integer]) -> NDArray[np.intp]:
        """The numbers here of vertices of the template, which are all of the skin."""
        return np.searchsorted(self.vertices, template_vertices).astype(np.intp)


def load_skin(template: Template, space: BodySpace, rig: Rig) -> Skin:
    """The skin; the first time, looked at from all sides (some seconds)."""
    vertices = template.vertices_of("body").astype(np.intp)
    quads = np.searchsorted(vertices, template.quads[template.faces("body")])
    triangles = triangulate(quads)
    visible = cached_arrays("visible-skin", lambda: {"visible": _visible(template, space, vertices[triangles])})
    seen = visible["visible"]
    seen = seen | seen[_mirrored(template.vertices[vertices], triangles)]
    inside = np.tile(mouth_faces(template), 2)
    seen = _largest_piece(triangles, seen & ~inside)
    strongest = np.array(rig.names)[rig.bones[vertices, 0]]
    head = np.isin(strongest, ["Head", "Jaw", "LeftEye", "RightEye"])
    seen = seen | ~head[triangles].all(1)  # what lies between fingers or under arms does show, if not in every pose
    mean = space.mean[vertices].astype(np.float64)
    regions = _regions(template, space.mean[vertices], vertices, triangles, strongest)
    regions["head"] = head
    of_hands = np.char.find(np.array(rig.names), "Hand") >= 0
    regions["whole_hands"] = (rig.weights[vertices] * of_hands[rig.bones[vertices]]).sum(1) > MIN_WHOLE_HAND_WEIGHT
    shown = np.zeros(len(vertices), np.bool_)
    shown[triangles[seen]] = True
    regions["inner"] = ~shown
    for part in EYE_PARTS:
        rim = np.isin(vertices, lid_rim(template, part))
        regions[f"{part}_rim"] = rim
        regions[f"{part}_lids"] = grown(rim, triangles, CLOSE_LID_RINGS) & shown
        regions["lids"] |= regions[f"{part}_lids"]
    ears = vertex_mask(template, "ears")[vertices] > 0.5
    regions["left_ear"], regions["right_ear"] = ears & (mean[:, 0] > 0), ears & (mean[:, 0] < 0)
    upper, lower = lip_sides(mean, triangles, *lip_rims(mean, triangles, inside))
    regions["upper_lip"], regions["lower_lip"] = upper, lower
    contact = lip_contact(mean, triangles, regions["lips"] & shown & (upper | lower), lower)
    touching = np.unique(contact.indices[contact.data == 1])
    lips = touching[~lower[touching]], touching[lower[touching]]
    points = landmark_vertices(template, space, vertices, triangles, shown, lips)
    regions["face"] = head & (np.linalg.norm((mean - mean[points[30]]) / FACE_RADII, axis=1) < 1)
    return Skin(vertices, triangles, seen, rig.bones[vertices], rig.weights[vertices], regions, points, contact)


def grown(region: NDArray[np.bool_], triangles: NDArray[np.integer], rings: int) -> NDArray[np.bool_]:
    """A region (S,) and so many rings of vertices around it."""
    beside = neighbours(triangles, len(region))
    for _ in range(rings):
        region = region | ((beside @ region.astype(np.float64)) > 0)
    return region


def _regions(
    template: Template,
    mean: NDArray[np.float32],
    vertices: NDArray[np.intp],
    triangles: NDArray[np.int32],
    strongest: NDArray[np.str_],
) -> dict[str, NDArray[np.bool_]]:
    def moved_by(units: tuple[str, ...]) -> NDArray[np.bool_]:
        fields = template.face_units.dense(units)[:, vertices]
        return np.asarray(np.linalg.norm(fields, axis=2).max(0) > MIN_UNIT_MOTION_METRES)

    joined = edges(triangles)
    lengths = np.linalg.norm(mean[joined[:, 0]] - mean[joined[:, 1]], axis=1).repeat(2)
    edge = np.bincount(joined.ravel(), lengths) / np.bincount(joined.ravel())
    trunk = ((mean > NIPPLE_BOX_METRES[0]) & (mean < NIPPLE_BOX_METRES[1])).all(1)
    trunk &= np.isin(
        strongest, ["Spine", "Spine1", "Spine2", "LeftShoulder", "RightShoulder", "LeftArm", "RightArm", "Hips"]
    )
    feet = np.isin(strongest, [f"{side}{bone}" for side in SIDE_NAMES for bone in ("Foot", "ToeBase")])
    return {
        "lips": moved_by(LIP_UNITS) | (vertex_mask(template, "lips")[vertices] > 0.5),
        "lids": moved_by(LID_UNITS),
        "hands": np.char.find(strongest, "Hand") >= 0,
        "feet": feet,
        "lower_feet": feet & (mean[:, 1] < mean[feet, 1].min() + LOWER_FOOT_LENGTH_SHARE * np.ptp(mean[feet, 2])),
        "hidden_by_cloth": grown(trunk & (edge < FINE_EDGE_METRES), triangles, 2),
    }


def _mirrored(vertices: NDArray[np.float32], triangles: NDArray[np.int32]) -> NDArray[np.intp]:
    """(T,) of each triangle, which lies over the other side where it lies over its own."""
    middles = vertices[triangles].mean(1)
    return np.asarray(cKDTree(middles).query(middles * np.array([-1, 1, 1]))[1], np.intp)


def _largest_piece(triangles: NDArray[np.int32], chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(T,) those of the `chosen` triangles that hang together by edges with most others: specks of the mouth's inside are seen
    through the slit between the template's lips."""
    numbers = np.flatnonzero(chosen)
    table = edge_table(
        np.ascontiguousarray(triangles[numbers], np.int32), np.arange(int(triangles.max()) + 1, dtype=np.int32)
    )
    pairs = table[table[:, 3] >= 0, 2:]
    links = sp.csr_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(numbers), len(numbers)))
    piece = connected_components(links, directed=False)[1]
    out = np.zeros(len(chosen), np.bool_)
    out[numbers[piece == np.bincount(piece).argmax()]] = True
    return out


def _visible(template: Template, space: BodySpace, triangles: NDArray[np.integer]) -> NDArray[np.bool_]:
    """(T,) which triangles of the skin are seen from some side of the head, with the eyes in their places."""
    eyes = triangulate(template.quads[template.faces("left_eye", "right_eye")])
    everything = np.concatenate([triangles, eyes]).astype(np.int32)
    middle = space.mean[template.vertices_of("left_eye")].mean(0).astype(np.float64) * [0, 1, 1]
    half = (HEAD_VIEW_PIXELS - 1) / 2
    lens = Camera((0.0, 0.0, 0.0), HEAD_VIEW_PIXELS * 1.6, (half, half), (HEAD_VIEW_PIXELS, HEAD_VIEW_PIXELS))
    seen = np.zeros(len(everything), np.bool_)
    for k in range(HEAD_VIEW_COUNT):  # along a spiral of equal areas
        rise = 0.98 * (1 - (2 * k + 1) / HEAD_VIEW_COUNT)
        turn = k * np.pi * (3 - np.sqrt(5))
        level = np.sqrt(1 - rise**2)
        aside = np.array([level * np.sin(turn), rise, level * np.cos(turn)])
        camera = lens.aimed(middle + HEAD_VIEW_DISTANCE_METRES * aside, middle)
        found = rasterise(camera.project(space.mean), everything, camera.size, perspective=True).triangle
        seen[found[found >= 0]] = True
    return seen[: len(triangles)]
