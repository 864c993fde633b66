"""The contour tells what landmarks do not: how stout somebody is."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from engine.body import load_template
from engine.body.body_space import load_body_space
from engine.body.fitting.body_fitting import Fit, fit_body
from engine.body.fitting.contour import SEARCH_INSIDE_SHARE, Contour, match_contour, skin_points, trace_contour
from engine.body.fitting.first_guess import first_guess
from engine.body.fitting.observation import DIRECTED_LIMBS, Observation
from engine.body.fitting.posing import FITTED_JOINTS, POSED_SHAPE_COEFFICIENTS, BodyPoser, forward, rotation_matrices
from engine.body.fitting.residuals import ContourMatches, project, residuals
from engine.body.landmarks import landmark_model
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.skinning import bone_transforms, skin

TEMPLATE, SPACE, BONES = load_template(), load_body_space(), load_rig(HUMAN_RIG)
MARKS, SKIN = landmark_model(TEMPLATE, SPACE, BONES), skin_points(TEMPLATE, SPACE, BONES)
FOCAL, CENTRE, SIZE = 1400.0, (320.0, 400.0), (820, 640)
CAMERA = Camera((0, 0, 0), FOCAL, CENTRE, SIZE)
REST_PARAMETERS = np.concatenate([[0, 0, -4.5], np.zeros(3 * len(FITTED_JOINTS) + POSED_SHAPE_COEFFICIENTS)])


def parameters(coefficients: dict[int, float], **turns: tuple[float, float, float]) -> np.ndarray:
    """Somebody with these coefficients, arms half lowered unless said otherwise."""
    given = {"LeftArm": (0, 0, -0.8), "RightArm": (0, 0, 0.8)} | turns
    found = REST_PARAMETERS.copy()
    for name, turn in given.items():
        found[3 + 3 * FITTED_JOINTS.index(name) :][:3] = turn
    for number, value in coefficients.items():
        found[len(found) - POSED_SHAPE_COEFFICIENTS + number] = value
    return found


def seen_of(truth: np.ndarray) -> tuple[Observation, dict[str, np.ndarray]]:
    """Exact landmarks."""
    joints, points = forward(SPACE, MARKS, truth)
    pixels = points[:, :2] * [FOCAL, -FOCAL] / -points[:, 2:] + CENTRE
    place = dict(zip(SPACE.names, joints, strict=True))
    limbs = np.stack([place[b] - place[a] for a, b in DIRECTED_LIMBS])
    limbs /= np.linalg.norm(limbs, axis=1, keepdims=True)
    sure = np.ones(len(pixels), np.float32), np.ones(len(DIRECTED_LIMBS), np.float32)
    return Observation(pixels.astype(np.float32), sure[0], limbs.astype(np.float32), sure[1], CAMERA), place


def mask_of(truth: np.ndarray) -> np.ndarray:
    """The body as the camera sees it."""
    turns, coefficients = truth[3:-POSED_SHAPE_COEFFICIENTS].reshape(-1, 3), truth[-POSED_SHAPE_COEFFICIENTS:]
    rotations = np.broadcast_to(np.eye(3), (len(SPACE.names), 3, 3)).copy()
    rotations[[SPACE.names.index(name) for name in FITTED_JOINTS]] = rotation_matrices(turns)
    heads = SPACE.joints(coefficients)
    transforms = bone_transforms(
        BONES.parents, heads, rotations.astype(np.float32), (truth[:3] - heads[0]).astype(np.float32)
    )
    at = skin(SPACE.vertices(coefficients), BONES.bones, BONES.weights, transforms)
    pixels = at[:, :2] * [FOCAL, -FOCAL] / -at[:, 2:] + CENTRE
    mask = np.zeros(SIZE, np.uint8)
    for corners in np.rint(pixels[triangulate(TEMPLATE.quads[TEMPLATE.faces("body")])] * 16).astype(np.int32):
        cv2.fillConvexPoly(mask, corners, (1,), shift=4)
    return mask > 0


def test_who_stands_out_of_a_contour_is_further_off_than_who_stays_behind_it() -> None:
    """By as many pixels: clothes are worn over bodies, not under them."""
    truth = parameters({})
    seen, _ = seen_of(truth)
    poser = BodyPoser(SPACE)
    some = SKIN.subset(np.arange(0, len(SKIN.joints), 50))
    pixels = project(poser(truth[None]).carry(some), CAMERA)[0]
    normals = np.tile([1.0, 0.0], (len(pixels), 1))

    def off(pixels_out: float) -> float:
        matches = ContourMatches(some, pixels - pixels_out * normals, normals)
        return float((residuals(poser, MARKS, [seen], [matches], truth[None]) ** 2).sum())

    assert off(0) < off(-1) < off(1)


def fitted(truth: np.ndarray, contour: Contour | None) -> Fit:
    seen, place = seen_of(truth)
    seen = replace(seen, contour=contour)
    return fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place), SKIN)


def waist(coefficients: np.ndarray) -> float:
    """Its width in metres."""
    body = SPACE.vertices(coefficients)
    hips = SPACE.joints(coefficients)[SPACE.names.index("Spine")]
    around = body[(np.abs(body[:, 1] - hips[1]) < 0.03) & (np.abs(body[:, 0]) < 0.35)]
    return float(np.ptp(around[:, 0]))


def test_the_outline_of_a_disk_is_its_circle() -> None:
    y, x = np.mgrid[:200, :240]
    contour = trace_contour((x - 120) ** 2 + (y - 90) ** 2 < 60**2)
    away = contour.points - [120, 90]
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), 60, atol=1.5)
    np.testing.assert_allclose(contour.normals, away / np.linalg.norm(away, axis=1, keepdims=True), atol=0.15)


def test_what_the_picture_cuts_is_no_outline() -> None:
    mask = np.zeros((100, 80), np.bool_)
    mask[40:, 20:60] = True
    contour = trace_contour(mask)
    assert len(contour.points) and contour.points[:, 1].max() < 98


def test_an_outline_meets_what_faces_the_same_way_outermost() -> None:
    contour = Contour(np.array([[50.0, 50.0]]), np.array([[1.0, 0.0]]))
    pixels = np.array([[46.0, 50.0], [48.0, 50.5], [51.0, 50.0], [49.0, 58.0]])
    right, left = [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]
    which, at = match_contour(
        contour, pixels, np.array([right, right, left, right]), np.full(4, SEARCH_INSIDE_SHARE), 100
    )  # the third faces back, the last is far
    assert which.tolist() == [0] and at.tolist() == [1]


def test_the_outline_draws_the_body_to_the_mask() -> None:
    """Landmarks are exact here: what they leave open is a body's girth."""

    def overlap(fit: Fit, mask: np.ndarray) -> float:
        body = mask_of(fit.parameters)
        return float((body & mask).sum() / (body | mask).sum())

    bare, better = [], []
    for number, value in ((2, 1.5), (4, -1.5), (5, -1.5), (6, 1.5)):
        truth = parameters({number: value})
        mask = mask_of(truth)
        bare.append(overlap(fitted(truth, None), mask))
        better.append(overlap(fitted(truth, trace_contour(mask)), mask))
    assert np.mean(better) > np.mean(bare) + 0.002
    assert min(better) > 0.97  # in the third decimal it differs between processors


def test_wide_clothes_do_not_make_stout_people() -> None:
    """A coat around the same body: the fit stays nearer to the body than to the coat."""
    truth = parameters({})
    coat = cv2.dilate(mask_of(truth).astype(np.uint8), np.ones((61, 61), np.uint8)) > 0
    found = fitted(truth, trace_contour(coat))
    assert waist(found.coefficients) - waist(truth[-POSED_SHAPE_COEFFICIENTS:]) < 0.04


def test_a_gap_in_the_mask_has_an_outline_too_that_faces_into_it() -> None:
    y, x = np.mgrid[:200, :240]
    away = np.hypot(x - 120, y - 90)
    contour = trace_contour((away < 70) & (away > 30))
    inner = contour.points - [120, 90]
    inner_normals = contour.normals[np.hypot(*inner.T) < 50]
    inner = inner[np.hypot(*inner.T) < 50]
    assert len(inner) > 0.3 * len(contour.points) * 30 / 70
    np.testing.assert_allclose(inner_normals, -inner / np.linalg.norm(inner, axis=1, keepdims=True), atol=0.2)


def test_legs_end_where_their_outline_ends() -> None:
    """Both feet are seen 4% of the height too high, all of their landmarks alike."""
    truth = parameters({3: 1.0})
    seen, place = seen_of(truth)
    low = [k for k, name in enumerate(MARKS.names) if name.endswith(("Ankle", "Heel", "FootIndex"))]
    points = seen.points.copy()
    points[low, 1] -= 0.04 * seen.height
    seen = replace(seen, points=points, contour=trace_contour(mask_of(truth)))
    found = fit_body(SPACE, MARKS, seen, first_guess(SPACE, MARKS, seen, place), SKIN)
    rows = [np.flatnonzero(mask_of(each).any(1)).max() for each in (truth, found.parameters)]
    assert abs(rows[0] - rows[1]) < 0.012 * seen.height
