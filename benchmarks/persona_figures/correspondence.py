"""Which points of two faces correspond: by their meshes, and by the flow between their averages in one another's light.

Source of the flow: section 4; I. Kemelmacher-Shlizerman, S. M. Seitz, Collection flow, CVPR 2012. A's average, laid on B's frame by its mesh, is
projected onto the subspace of B's photographs, which is B in A's light; the flow from there to A's average is what the meshes missed.

Two people are made of the human template, whose vertices are known to correspond. The error is the distance on B's frame, 194 pixels wide,
between where a vertex of A is and where what corresponds to B's is said to be, of vertices that are seen from before.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.persona_figures.known_heads import (
    PHOTO_SIDE_PIXELS,
    KnownHead,
    from_before,
    photographs,
    template_person,
)
from benchmarks.presentation.tables import table
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.persona.learning import learn_persona
from engine.persona.motion.performance import FRAME_SIZE
from engine.persona.persona import Persona
from engine.persona.texture.aligned_photos import align_photos
from engine.persona.texture.appearance_subspace import SUBSPACE_RANK, exposed
from engine.persona.texture.bare_skin import bared
from engine.persona.texture.dense_alignment import SMOOTHING_SIGMA
from engine.persona.texture.texture_frame import TextureFrame
from engine.render.rasterisation.rasteriser import rasterise

PHOTOS_OF_A, PHOTOS_OF_B = 8, 30
WIDE_SIGMA_PIXELS = 16.0
"""Pixels: beside that of the persona's own alignment."""
UNCOUNTED_RIM_PIXELS = 21
"""Pixels of the oval's rim that do not count."""
HIDDEN_DEPTH_PIXELS = 2.0
"""Pixels behind the surface that is seen from which on a vertex is hidden."""


def correspondence() -> None:
    """Print the table."""
    people = [template_person(name) for name in ("template-a", "template-b")]
    rows = []
    for a, b in (people, people[::-1]):
        random = np.random.default_rng(5)
        meshes, photos = photographs(b, PHOTOS_OF_B, random)
        persona = learn_persona(meshes, photos.__getitem__, FRAME_SIZE).persona
        average = _average(persona.frame, *photographs(a, PHOTOS_OF_A, random, acting=False))
        own, others = _vertices(persona.frame, a, b)
        told = [np.zeros_like(others), *(_along(flow, others) for flow in _flows(persona, average))]
        rows.append([f"{a.name} to {b.name}", str(len(own)), *(f"{_error(own, others + one):.2f}" for one in told)])
    head = [
        "faces",
        "vertices",
        "meshes",
        f"flow, smoothed over {SMOOTHING_SIGMA:.0f} px",
        f"over {WIDE_SIGMA_PIXELS:.0f} px",
    ]
    print(table("Correspondence, mean error in pixels of a frame 194 wide", head, rows))


def _average(frame: TextureFrame, meshes: NDArray[np.float32], photos: list[NDArray[np.uint8]]) -> NDArray[np.float32]:
    """(H, W) A's average grey on B's frame, exposed as its photographs are."""
    laid = bared(frame, align_photos(frame, list(meshes), lambda number: photos[number]))
    weight = laid.shown[..., None] + np.float32(1e-3)
    mean = (laid.colours * weight).sum(axis=0) / weight.sum(axis=0)
    return exposed((mean @ LUMINANCE_WEIGHTS)[None].astype(np.float32), frame.face)[0]


def _flows(persona: Persona, average: NDArray[np.float32]) -> list[NDArray[np.float32]]:
    """(H, W, 2) where on B's frame what is at each pixel of B is in A's average, as offsets; smoothed over little, and over much."""
    face = persona.frame.face
    rows = exposed(np.asarray(persona.colours @ LUMINANCE_WEIGHTS, np.float32), face)[:, face]
    basis = np.linalg.svd(rows, full_matrices=False)[2][:SUBSPACE_RANK]
    lit = average.copy()
    lit[face] = (basis @ average[face]) @ basis
    flow = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    flow.setFinestScale(0)
    first, second = (np.clip(np.rint(one), 0, 255).astype(np.uint8) for one in (lit, average))
    raw = np.asarray(flow.calc(first, second, np.zeros((*FRAME_SIZE, 2), np.float32)), np.float32)
    believed = persona.belief.mean(axis=0, dtype=np.float32)[..., None] + 1
    return [
        cv2.GaussianBlur(raw * believed, (0, 0), sigma) / cv2.GaussianBlur(believed, (0, 0), sigma)[..., None]
        for sigma in (SMOOTHING_SIGMA, WIDE_SIGMA_PIXELS)
    ]


def _vertices(frame: TextureFrame, a: KnownHead, b: KnownHead) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(P, 2) twice: where on B's frame A's and B's meshes lay the vertices that are seen of both, well within B's oval."""
    found = []
    for head in (a, b):
        mesh, seen = from_before(head)
        rows, columns = np.clip(np.rint(seen[:, 1::-1]).astype(int), 0, PHOTO_SIDE_PIXELS - 1).T
        depth = rasterise(seen, head.triangles, (PHOTO_SIDE_PIXELS, PHOTO_SIDE_PIXELS)).depth[rows, columns]
        places = np.full((int(head.numbers.max()) + 1, 2), np.nan)
        shown = np.abs(depth - seen[:, 2]) < HIDDEN_DEPTH_PIXELS
        places[head.numbers[shown]] = _on_frame(frame, mesh, seen[shown, :2])
        found.append(places)
    count = min(len(one) for one in found)
    own, others = (one[:count] for one in found)
    known = np.isfinite(own + others).all(axis=1)
    inner = cv2.erode(frame.face.astype(np.uint8), np.ones((UNCOUNTED_RIM_PIXELS, UNCOUNTED_RIM_PIXELS))) > 0
    rows, columns = np.rint(others[known][:, ::-1]).astype(int).T
    within = inner[rows, columns]
    return own[known][within], others[known][within]


def _on_frame(frame: TextureFrame, mesh: NDArray[np.floating], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(P, 2) where `points` (P, 2) of a picture are on the frame by the `mesh` (478, 3) of its face; NaN beside the face."""
    triangles = frame.triangles[(frame.triangles < 478).all(axis=1)]
    rows, columns = np.clip(np.rint(points[:, ::-1]).astype(int), 0, PHOTO_SIDE_PIXELS - 1).T
    triangle = rasterise(np.asarray(mesh, np.float64), triangles, (PHOTO_SIDE_PIXELS, PHOTO_SIDE_PIXELS)).triangle[
        rows, columns
    ]
    corners = triangles[np.maximum(triangle, 0)]
    first, second, third = (mesh[corners[:, k], :2].astype(np.float64) for k in range(3))
    sides = np.stack([second - first, third - first], -1)
    shares = np.linalg.solve(sides, (points - first)[..., None])[..., 0]
    weights = np.column_stack([1 - shares.sum(axis=1), shares])
    laid = np.einsum("pk,pkc->pc", weights, frame.places[corners][..., :2])
    laid[triangle < 0] = np.nan
    return np.asarray(laid)


def _along(flow: NDArray[np.float32], places: NDArray[np.float64]) -> NDArray[np.float64]:
    at = places.astype(np.float32)
    found = cv2.remap(np.asarray(flow, np.float32), at[:, :1], at[:, 1:], cv2.INTER_LINEAR)
    return np.asarray(found, np.float64).reshape(len(places), 2)


def _error(own: NDArray[np.float64], told: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(own - told, axis=1).mean())
