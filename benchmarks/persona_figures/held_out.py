"""How like a photograph that was held out the texture for its expression is, against simpler ways of mixing photographs.

Of each collection, duplicates left out, a tenth at a time is held out and the persona learnt of the rest. Each
photograph held out is laid on the frame by its own mesh, and asks for its own expression. What is compared is the band
finer than four pixels of a frame 194 wide, over the bare skin that the photograph shows, beside the lips' inside. The
tone of its greys is fitted first, and a smooth flow leads it to the photograph (the paper's warp to the reference):
SSIM of that band.

The ways are these. The average of all, laid on one another pixel by pixel, or by the paper's thin-plate spline of 51
points alone (lambda 10). The weighted average of photographs laid on one another by a similarity alone. Photographs
laid on one another pixel by pixel, but mixed in one band. And so mixed by expression alone. "Ahead" is the mean of the
differences, photograph by photograph, and its standard error; "energy" that of the band over the photograph's own,
which hairs and spectacles raise, too.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator

from benchmarks.presentation.tables import table
from benchmarks.shared_media import media
from engine.geometry.registration.rigid import fit_similarity
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.media.limits import Limits
from engine.perception.expression.features import frontalise
from engine.perception.face.landmarks import LIPS_INNER, RIGID_VERTICES, fiducials
from engine.perception.identity.backend import descriptor_distances, descriptor_name
from engine.persona.collection.photos import Photos, read_photos
from engine.persona.collection.sorting import Choice
from engine.persona.learning import learn_persona
from engine.persona.motion.performance import FRAME_SIZE
from engine.persona.persona import Persona
from engine.persona.stages import SortedFaces, find_faces_of_photos, sort_faces
from engine.persona.texture.aligned_photos import align_photos
from engine.persona.texture.bare_skin import bared
from engine.persona.texture.expression_weights import (
    FIRST_INNER_FIDUCIAL,
    expression_points,
    expression_weights,
)
from engine.persona.texture.white_balance import balanced

BAND_SIGMA_PIXELS = 4.0
"""Pixels: what is coarser is light, not detail."""
FLOW_SIGMA_PIXELS = 4.0
SSIM_SIGMA, SSIM_C1, SSIM_C2 = 1.5, (0.01 * 255) ** 2, (0.03 * 255) ** 2
"""Z. Wang et al., Image quality assessment, 2004."""
SPLINE_LAMBDA = 10.0
"""Section 6."""
UNCOMPARED_RIM_PIXELS = 9
"""Pixels of the face's rim that are not compared."""
OWN_METHOD = "ours"


@dataclass(frozen=True)
class Score:
    """Of one texture against one photograph: SSIM of the fine band, and its energy over the photograph's."""

    likeness: float
    energy: float


def held_out(names: Sequence[str], folds: int) -> None:
    """Print a table for each collection of the test media whose name has one of `names` in it."""
    folders = sorted(path for path in media("collections").iterdir() if path.is_dir())
    for folder in folders:
        if not names or any(name in folder.name for name in names):
            print(_table(folder.name, held_out_scores(folder, folds)), flush=True)


def held_out_scores(folder: Path, folds: int) -> dict[str, list[Score]]:
    """For each way of mixing, the scores of all photographs of a collection, each held out once."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    photos = read_photos(files, Limits())
    found = find_faces_of_photos(photos, descriptor_name(os.environ), lambda fraction: None)
    chosen = sort_faces(found, descriptor_distances(os.environ), Choice(), None)
    order = np.random.default_rng(1).permutation(len(chosen.kept))
    scores: dict[str, list[Score]] = {}
    for fold in range(folds):
        held = np.sort(order[fold::folds])
        for way, some in _fold(photos, chosen, held).items():
            scores.setdefault(way, []).extend(some)
    return scores


def _fold(photos: Photos, chosen: SortedFaces, held: NDArray[np.intp]) -> dict[str, list[Score]]:
    faces = chosen.kept
    rest = np.setdiff1d(np.arange(len(faces)), held)
    meshes = np.array([face.mesh for face in faces])

    def picture(number: int) -> NDArray[np.uint8]:
        return photos.picture(faces[number].photo)

    learnt = learn_persona(meshes[rest], lambda place: picture(rest[place]), FRAME_SIZE)
    persona, used = learnt.persona, rest[learnt.used]
    shown = bared(persona.frame, align_photos(persona.frame, list(meshes[held]), lambda place: picture(held[place])))
    scale = persona.frame.scale
    points = expression_points(frontalise(meshes[held])) * scale
    pictures = [picture(k) for k in used]
    mixed = _mixed(persona, points, _unaligned(persona, pictures, meshes[used]))
    mixed["average, by the spline"] = np.repeat(
        _splined(persona, pictures, meshes[used]).mean(axis=0)[None], len(held), 0
    )
    area = _compared(persona)
    return {
        way: [
            _score(texture, photo, area & (seen > 0.5))
            for texture, photo, seen in zip(textures, shown.colours, shown.shown, strict=True)
        ]
        for way, textures in mixed.items()
    }


def _mixed(persona: Persona, points: NDArray[np.float64], unaligned: NDArray[np.uint8]) -> dict[str, NDArray[np.uint8]]:
    weights = expression_weights(points, persona.points * persona.frame.scale)
    belief = np.asarray(persona.belief / np.float32(255) + np.float32(1e-3), np.float32)
    level = np.ones_like(weights)
    return {
        "average": _one_band(level, persona.colours, np.ones_like(belief)),
        "weighted, unaligned": _one_band(weights, unaligned, _detail(unaligned)),
        "aligned, one band": _one_band(
            weights, persona.colours, np.asarray(_detail(persona.colours) * belief, np.float32)
        ),
        "aligned, expression alone": _one_band(weights, persona.colours, belief),
        OWN_METHOD: persona.synthesis(weights),
    }


def _one_band(
    weights: NDArray[np.float32], colours: NDArray[np.uint8], confidence: NDArray[np.float32]
) -> NDArray[np.uint8]:
    out = np.empty((len(weights), *colours.shape[1:]), np.uint8)
    for row, target in zip(weights, out, strict=True):
        total = np.einsum("n,nhw->hw", row, confidence)
        mean = np.einsum("n,nhw,nhwc->hwc", row, confidence, colours, optimize=True) / total[..., None]
        target[:] = np.clip(np.rint(mean), 0, 255)
    return out


def _detail(colours: NDArray[np.uint8]) -> NDArray[np.float32]:
    """(N, H, W) equation 2's response of the Laplacian."""
    return np.array([np.abs(cv2.Laplacian(one @ LUMINANCE_WEIGHTS, cv2.CV_32F)) + 1e-3 for one in colours], np.float32)


def _unaligned(
    persona: Persona, pictures: Sequence[NDArray[np.uint8]], meshes: NDArray[np.floating]
) -> NDArray[np.uint8]:
    """(N, H, W, 3) each photograph laid on the frame by a similarity, balanced as the others are."""
    chosen, (height, width) = list(RIGID_VERTICES), persona.frame.size
    goal = persona.frame.places[chosen, :2]
    laid = []
    for rgb, mesh in zip(pictures, meshes, strict=True):
        found = fit_similarity(mesh[chosen, :2].astype(np.float64), goal)
        matrix = np.column_stack([found.linear, found.shift])
        laid.append(
            cv2.warpAffine(rgb, matrix, (width, height), flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        )
    colours = np.array(laid, np.uint8)
    return balanced(colours, np.ones(colours.shape[:3], np.float32), persona.frame.face)


def _splined(
    persona: Persona, pictures: Sequence[NDArray[np.uint8]], meshes: NDArray[np.floating]
) -> NDArray[np.uint8]:
    """(N, H, W, 3) each photograph laid on the frame by a thin-plate spline of the 51 inner fiducials (section 4), balanced."""
    frame, (height, width) = persona.frame, persona.frame.size
    goal = fiducials(frame.places[:478])[FIRST_INNER_FIDUCIAL:, :2]
    rows, columns = np.indices((height, width), np.float64)
    pixels = np.column_stack([columns.ravel(), rows.ravel()])
    laid = []
    for rgb, mesh in zip(pictures, meshes, strict=True):
        own = fiducials(mesh)[FIRST_INNER_FIDUCIAL:, :2]
        spline = RBFInterpolator(goal, own, kernel="thin_plate_spline", smoothing=SPLINE_LAMBDA)
        at = spline(pixels).reshape(height, width, 2).astype(np.float32)
        laid.append(cv2.remap(rgb, at[..., 0], at[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE))
    colours = np.array(laid, np.uint8)
    return balanced(colours, np.ones(colours.shape[:3], np.float32), frame.face)


def _compared(persona: Persona) -> NDArray[np.bool_]:
    mouth = np.zeros(persona.frame.size, np.uint8)
    cv2.fillPoly(mouth, [np.rint(persona.frame.places[list(LIPS_INNER), :2]).astype(np.int32)], 1)
    inner = cv2.erode(persona.frame.face.astype(np.uint8), np.ones((UNCOMPARED_RIM_PIXELS, UNCOMPARED_RIM_PIXELS)))
    return np.asarray((inner > 0) & (cv2.dilate(mouth, np.ones((3, 3))) == 0))


def _score(texture: NDArray[np.uint8], photo: NDArray[np.uint8], area: NDArray[np.bool_]) -> Score:
    reference, given = photo @ LUMINANCE_WEIGHTS, texture @ LUMINANCE_WEIGHTS
    slope, offset = np.polyfit(given[area], reference[area], 1)
    given = np.asarray(slope * given + offset, np.float32)
    laid = _laid(given, reference)
    first, second = (one - np.asarray(cv2.GaussianBlur(one, (0, 0), BAND_SIGMA_PIXELS)) for one in (laid, reference))
    return Score(float(_ssim(first, second)[area].mean()), float(first[area].std() / second[area].std()))


def _laid(given: NDArray[np.float32], reference: NDArray[np.float32]) -> NDArray[np.float32]:
    flow = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    flow.setFinestScale(0)
    first, second = (np.clip(np.rint(one), 0, 255).astype(np.uint8) for one in (reference, given))
    raw = flow.calc(first, second, np.zeros((*first.shape, 2), np.float32))
    smooth = np.asarray(cv2.GaussianBlur(raw, (0, 0), FLOW_SIGMA_PIXELS))
    rows, columns = np.indices(first.shape, np.float32)
    found = cv2.remap(given, columns + smooth[..., 0], rows + smooth[..., 1], cv2.INTER_CUBIC)
    return np.asarray(found, np.float32)


def _ssim(first: NDArray[np.float32], second: NDArray[np.float32]) -> NDArray[np.float32]:
    def mean(values: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.asarray(cv2.GaussianBlur(values, (0, 0), SSIM_SIGMA), np.float32)

    one, other = mean(first), mean(second)
    variances = mean(first**2) - one**2 + mean(second**2) - other**2
    covariance = mean(first * second) - one * other
    return np.asarray(
        (2 * one * other + SSIM_C1)
        * (2 * covariance + SSIM_C2)
        / ((one**2 + other**2 + SSIM_C1) * (variances + SSIM_C2)),
        np.float32,
    )


def _table(name: str, scores: Mapping[str, Sequence[Score]]) -> str:
    ours = np.array([score.likeness for score in scores[OWN_METHOD]])
    rows = []
    for way, some in scores.items():
        likeness = np.array([score.likeness for score in some])
        ahead = ours - likeness
        error = ahead.std(ddof=1) / np.sqrt(len(ahead))
        against = "" if way == OWN_METHOD else f"{ahead.mean():+.4f} ± {error:.4f}"
        rows.append([way, f"{likeness.mean():.4f}", against, f"{np.mean([score.energy for score in some]):.2f}"])
    return table(f"{name}, {len(ours)} photographs", ["way", "detail SSIM", "ours ahead by", "energy"], rows)
