"""The skin's own shape: the fine fit of section 3.4, equation 1."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.avatar.registration.template_skin.lip_contact import closed_mouth
from engine.avatar.registration.template_skin.skin import Skin
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.point_clouds.point_cloud import PointCloud
from engine.geometry.registration.nonrigid_registration import (
    ElasticSurface,
    SurfaceLandmarks,
    geometric_steps,
    lay_on_points,
)

BODY_STEPS = geometric_steps(7, (1e-5, 1e-10), (1.0, 1e-2), (0.08, 0.03))
"""In metres the paper's weights, 1 to 1e-7, would leave the body as it is. A power of ten less than this crumples it."""
HEAD_STEPS = geometric_steps(5, (1e-7, 1e-10), (0.3, 1e-3), (0.02, 0.008))
"""Where the body's fit is what is bent."""
INNER_STIFFNESS = 100.0
"""Of what no point tells of: the mouth's inside and the sockets."""
BODY_FACE_STIFFNESS = 30.0
"""Of the face while only the body's cloud is there: else lips turn inside out under a moustache."""
LIP_STIFFNESS = 30.0
"""Of lips in the head's cloud."""
LID_STIFFNESS = 10.0
"""Of lids in the head's cloud."""
COARSE_FIT_WEIGHT = 0.003
"""What the coarse fit's place of the skin counts beside the points': nothing where there are some, all where there are none."""
POINT_NOISE_METRES = 0.0015
"""Metres by which points scatter in a good cloud. In a bad one, of plain clothes in a small film, it is five times that: sleeves and
trousers that followed it would be crumpled paper. A face is believed whatever it is: it is stiff, and filmed from near."""
FIRST_INNER_FACE_POINT = 17
"""Face landmarks before it lie on the jaw's outline, at another place of it in every view."""
LID_RIM_FACE_POINTS = (37, 38, 40, 41, 43, 44, 46, 47)
"""Face landmarks on the rims of upper and lower lids, between the corners of the eyes."""
LID_LANDMARK_WEIGHT = 3000.0
"""What landmarks of the lids' rims count in the head's own fit, where nothing else tells how far eyes are open."""
FINE_LANDMARK_SIGMA_METRES = 0.008
"""Metres from the fit before at which a landmark counts a quarter (Geman-McClure): a moustache moves those of the mouth."""
MAX_FACE_DISTANCE_METRES = 0.03
"""Metres from the coarse fit beyond which, in the median, face landmarks are of a visor or a mask and not used."""


def fit_body(
    skin: Skin, coarse: NDArray[np.float64], cloud: PointCloud, face: NDArray[np.floating]
) -> NDArray[np.float64]:
    """The skin (S, 3) laid on the body's cloud from the `coarse` fit (S, 3); `face` (68, 3), NaN where unknown."""
    stiffness = _stiffness(skin, {"face": BODY_FACE_STIFFNESS, "inner": INNER_STIFFNESS})
    surface = _elastic(skin, without_details(skin, coarse), stiffness)
    drawn = face_landmarks(skin, coarse, face)
    return lay_on_points(surface, cloud.points, cloud.normals, BODY_STEPS, drawn)


def fit_head(
    skin: Skin, body: NDArray[np.float64], cloud: PointCloud, face: NDArray[np.floating]
) -> NDArray[np.float64]:
    """The skin (S, 3), as the body's fit has it and the head may have been given another shape, laid on a cloud of head and
    body. Both are one system: a head that is fitted alone drags its neck."""
    stiffness = _stiffness(skin, {"lips": LIP_STIFFNESS, "lids": LID_STIFFNESS, "inner": INNER_STIFFNESS})
    surface = _elastic(skin, body, stiffness)
    drawn = face_landmarks(skin, body, face, LID_LANDMARK_WEIGHT)
    return lay_on_points(surface, cloud.points, cloud.normals, HEAD_STEPS, drawn)


def without_details(skin: Skin, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """The skin (S, 3) smooth where clothes hide what it has: nipples would end as crumpled stars on a suit."""
    return _smooth_sheet(skin, vertices, skin.regions["hidden_by_cloth"])


def face_landmarks(
    skin: Skin, vertices: NDArray[np.float64], face: NDArray[np.floating], lids: float = 1.0
) -> SurfaceLandmarks | None:
    """The inner face landmarks that are known, or None where they are not those of this face. Each counts less the
    farther it is from the skin's `vertices` (S, 3), and those of the lids' rims `lids` times as much. They tell where a
    place is across the face: how deep it is the surface knows better, for landmarks of contours slide along as the view
    turns."""
    known = np.flatnonzero(np.isfinite(face).all(1))
    known = known[known >= FIRST_INNER_FACE_POINT]
    at = skin.face_points[known]
    off = np.linalg.norm(vertices[at] - face[known], axis=1)
    if len(known) < 10 or np.median(off) > MAX_FACE_DISTANCE_METRES:
        return None
    rows = sp.csr_array((np.ones(len(at)), (np.arange(len(at)), at)), (len(at), len(vertices)))
    ahead = _straight_ahead(vertices[skin.face_points])
    places = face[known] + ((vertices[at] - face[known]) @ ahead)[:, None] * ahead
    off = np.linalg.norm(vertices[at] - places, axis=1)
    believed = 1 / (1 + (off / FINE_LANDMARK_SIGMA_METRES) ** 2) ** 2
    weights = believed * np.where(np.isin(known, LID_RIM_FACE_POINTS), lids, 1.0)
    return SurfaceLandmarks(rows, np.asarray(places, np.float64), weights)


def _straight_ahead(face: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3,) the unit vector along which a face (68, 3) looks: across its eyes' outer corners, and from the chin to the nose's root."""
    ahead = np.cross(face[45] - face[36], face[27] - face[8])
    return np.asarray(ahead / np.linalg.norm(ahead))


def _smooth_sheet(skin: Skin, vertices: NDArray[np.float64], drawn: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The skin with the vertices of `drawn` (S,) as a smooth sheet between the others: where the bi-Laplacian, all edges
    alike, is least."""
    beside = neighbours(skin.triangles, len(vertices))
    laplacian = sp.csr_array(sp.eye_array(len(vertices)) - sp.diags_array(1 / beside.sum(1)) @ beside)
    bend = sp.csr_array(laplacian.T @ laplacian)[drawn]
    solved = vertices.copy()
    solved[drawn] = splu(sp.csc_array(bend[:, drawn])).solve(-(bend[:, ~drawn] @ vertices[~drawn]))
    return solved


def _elastic(skin: Skin, rest: NDArray[np.float64], stiffness: NDArray[np.float64]) -> ElasticSurface:
    """The skin (S, 3) at rest, its mouth closed, as what is laid on a cloud. Soles and toes stay where they are, and so
    do hands. What their joints and size say is all that a cloud of them tells, and no point draws skin off a finger's
    bone."""
    return ElasticSurface(
        closed_mouth(rest, skin.triangles, skin.lip_contact, skin.regions["lips"] | skin.regions["inner"]),
        skin.triangles,
        skin.visible,
        stiffness,
        _trust(skin),
        held=skin.regions["lower_feet"] | skin.regions["whole_hands"],
        point_sigma=np.where(skin.regions["face"], np.inf, POINT_NOISE_METRES),
        anchor=COARSE_FIT_WEIGHT,
        contact=skin.lip_contact,
    )


def _stiffness(skin: Skin, factors: dict[str, float]) -> NDArray[np.float64]:
    """(S,) the greatest of the factors of the regions to which each vertex belongs, else 1."""
    out = np.ones(len(skin.vertices))
    for region, factor in factors.items():
        out[skin.regions[region]] = np.maximum(out[skin.regions[region]], factor)
    return out


def _trust(skin: Skin) -> NDArray[np.float64]:
    """(S,) what points near each vertex count: none of lips, where hair grows, and of lids' rims, between which they are of the
    eye."""
    untold = skin.regions["lips"] | skin.regions["left_eye_lids"] | skin.regions["right_eye_lids"]
    return np.where(untold, 0.0, 1.0)
