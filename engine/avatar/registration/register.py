"""From clouds and landmarks to a person: section 3.4 from beginning to end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.registration.coarse import CoarseFit, fit_to_landmarks, fit_to_points
from engine.avatar.registration.ears_seen import with_ears_seen
from engine.avatar.registration.eyes.fitted_eyes import with_eyes, with_sockets
from engine.avatar.registration.eyes.tucked_lids import with_tucked_lids
from engine.avatar.registration.face.expressions import transferred_units
from engine.avatar.registration.face.face_parts import head_change, place_parts
from engine.avatar.registration.face.facial_hair import facial_hair, with_facial_hair
from engine.avatar.registration.face.inner_mouth import inner_skin
from engine.avatar.registration.feet.standing_feet import with_feet
from engine.avatar.registration.fine import fit_body, fit_head
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.footwear import seen_barefoot
from engine.avatar.registration.hand_pose import CoarseBody, with_hands
from engine.avatar.registration.head_cloud import head_to_body, one_cloud
from engine.avatar.registration.head_in_outlines import with_head_in_outlines
from engine.avatar.registration.head_shape import head_shape
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.part_outlines import Silhouette
from engine.avatar.registration.resting_shoulders import with_resting_shoulders
from engine.avatar.registration.rigging import Pose, on_the_ground, rest_joints, unposed
from engine.body.face.visemes import viseme_displacements
from engine.errors import InputError, Notice
from engine.geometry.deformation.cage_coordinates import cage_coordinates
from engine.geometry.point_clouds.point_cloud import PointCloud, thinned
from engine.geometry.registration.rigid import Similarity
from engine.geometry.rigging.joint_names import SIDE_NAMES

BODY_SPACING_METRES = 0.0035
"""Metres between points of the body's cloud that are used: twice the template's density, about 150,000 in all."""
HEAD_SPACING_METRES = 0.0012
"""Metres between points of the head's cloud that are used."""
MAX_SHAPE_DEVIATIONS = 5.0
"""Standard deviations of the space of bodies beyond which proportions are unusual, and said to be."""
MIN_CLOUD_POINTS = 2000
"""Of a cloud that says anything of a body."""

EYES_NOT_MEASURED = Notice(
    "eyes_not_measured",
    "No three frames show the eyes open and from the front: lids are where the face was fitted, and irises are as large as most.",
)


@dataclass(frozen=True)
class Scan:
    """What one clip gave: a cloud in its own world, metres, and the landmarks there. Of a head's it says whether it is
    `sized` as the body's is, or its scale is to be found; of a body's, the person's `silhouettes`."""

    cloud: PointCloud
    landmarks: SpatialLandmarks
    sized: bool = False
    silhouettes: tuple[Silhouette, ...] = ()


def register(
    models: HumanModels,
    body: Scan,
    head: Scan | None = None,
    check: Callable[[], None] = lambda: None,
    faced: bool = True,
) -> FittedTemplate:
    """The person of a body's and a head's scan.

    The body's world has y up, the ground at y = 0 about. Without a head's scan, or where it has hardly a point or no
    face, the face is as good as the body's cloud. Where no face holds the head (not `faced`), as under a helmet, the body's silhouettes
    do. `check` is called between steps, and may raise.

    Raises `InputError`: `landmarks_needed` where landmarks are missing or contradict each other; `cloud_too_thin` where there
    are too few points.
    """
    if len(body.cloud) < MIN_CLOUD_POINTS:
        raise InputError(
            "cloud_too_thin",
            "Too little of the person was reconstructed: film again in even light, slowly, with the whole body in view.",
        )
    cloud = thinned(body.cloud, BODY_SPACING_METRES)
    by_landmarks = fit_to_landmarks(models.body, models.landmarks, body.landmarks)
    believed = body.landmarks.without(by_landmarks.dropped)
    check()
    parameters = fit_to_points(models.body, models.landmarks, believed, cloud, by_landmarks.parameters)
    check()
    coefficients = parameters[-models.body.coefficients :]
    body_fit = with_hands(models, parameters, believed, cloud)
    shoes = not seen_barefoot(models.feet, body_fit.vertices, cloud, believed.face)
    body_fit = with_feet(models, body_fit, coefficients, believed, cloud, shoes, body.silhouettes)
    if not faced:
        body_fit = with_head_in_outlines(models, body_fit, body.silhouettes)
    face = body.landmarks.face if faced else np.full_like(body.landmarks.face, np.nan)
    fitted = fit_body(models.skin, body_fit.vertices, cloud, face)
    check()
    placed: Similarity | None = None
    hair = np.zeros(len(fitted))
    if head is not None and len(head.cloud) >= MIN_CLOUD_POINTS:
        placed = head_to_body(models.skin, fitted, body.cloud, head.cloud, head.landmarks, head.sized)
        if placed is not None:
            fitted = _with_head(models, fitted, cloud, believed, head, placed)
            hair = facial_hair(models.skin, fitted, head.cloud.moved(placed)) if faced else hair
    check()
    person = _person(
        models,
        body_fit,
        coefficients,
        fitted,
        placed,
        body.landmarks.eyes if head is None or placed is None else placed(head.landmarks.eyes),
        _notices(by_landmarks, body_fit, coefficients, head is not None and placed is None),
    )
    return with_facial_hair(models.skin, person, hair)


def _with_head(
    models: HumanModels,
    fitted: NDArray[np.float64],
    cloud: PointCloud,
    landmarks: SpatialLandmarks,
    head: Scan,
    placed: Similarity,
) -> NDArray[np.float64]:
    """The skin (S, 3) of the body's fit, of whose `landmarks` the ears' are used, with the head laid on its own cloud."""
    near = thinned(head.cloud.moved(placed), HEAD_SPACING_METRES)
    face = placed(head.landmarks.face)
    both = one_cloud(models.skin, fitted, cloud, near)
    shaped = head_shape(models.skin, models.heads, fitted, near, face)
    turned = head_change(models.skin, models.template.vertices[models.skin.vertices].astype(np.float64), shaped)
    shaped = with_ears_seen(models.skin, shaped, landmarks.body, turned.rotation[:, 2])
    return fit_head(models.skin, shaped, both, face)


def _person(
    models: HumanModels,
    coarse: CoarseBody,
    coefficients: NDArray[np.float64],
    fitted: NDArray[np.float64],
    placed: Similarity | None,
    seen: NDArray[np.float64],
    notices: tuple[Notice, ...],
) -> FittedTemplate:
    """The fitted skin with eyes, as frames have `seen` them (2, 21, 3), teeth and joints, in its pose and in T-pose, with
    expressions."""
    template, skin, rig = models.template, models.skin, models.rig
    vertices = place_parts(template, skin, coarse.whole, fitted)
    head = head_change(skin, coarse.vertices, fitted)
    eyes = with_eyes(template, skin, coarse.whole, vertices, head, seen)
    vertices = with_tucked_lids(template, eyes.vertices)
    vertices[skin.vertices] = inner_skin(skin, coarse.vertices, vertices[skin.vertices])
    vertices = with_sockets(template, skin, vertices)
    rotations = coarse.rotations
    joints = cage_coordinates(coarse.joints, coarse.vertices, skin.triangles) @ vertices[skin.vertices]
    for joint, part in (("LeftEye", "left_eye"), ("RightEye", "right_eye")):
        joints[rig.index(joint)] = vertices[template.vertices_of(part)].mean(0)
    pose = Pose(joints, rotations)
    at_rest = rest_joints(pose, rig.parents)
    flat = unposed(vertices, rig.bones, rig.weights, pose, at_rest)
    flat = with_resting_shoulders(models, flat, coefficients)
    rest, skeleton = on_the_ground(flat, at_rest, skin.vertices, rig.names, rig.parents)
    units = transferred_units(template, skin, rest)
    return FittedTemplate(
        vertices=vertices,
        rest=rest,
        skeleton=skeleton,
        joints=joints,
        rotations=rotations,
        expressions=units | viseme_displacements(units, len(rest)),
        iris=eyes.iris,
        head_to_body=placed,
        coefficients=coefficients,
        notices=notices if eyes.measured else (*notices, EYES_NOT_MEASURED),
    )


def _notices(
    coarse: CoarseFit, body: CoarseBody, coefficients: NDArray[np.float64], head_lost: bool
) -> tuple[Notice, ...]:
    found = []
    if lost := [side.lower() for side in SIDE_NAMES if side not in body.hands]:
        found.append(
            Notice(
                "hand_not_measured",
                f"Frames do not show, or do not agree, how the {' and the '.join(lost)} hand is held: it is held as usual.",
            )
        )
    if head_lost:
        found.append(
            Notice(
                "head_not_reconstructed",
                "Too little of the head's clip was reconstructed, or it shows no face: the face is the body clip's.",
            )
        )
    if coarse.dropped:
        names = ", ".join(sorted(coarse.dropped))
        found.append(
            Notice("landmarks_dropped", f"These landmarks contradicted the others and were not used: {names}.")
        )
    if np.abs(coefficients).max() > MAX_SHAPE_DEVIATIONS:
        found.append(
            Notice(
                "unusual_proportions", "The body's proportions are unlike those of people: look at the shape closely."
            )
        )
    return tuple(found)
