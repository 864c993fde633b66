"""Heads of known shape, photographed: a real scan, which shows one expression, and people made of the human template, who show many.

Each photograph has one lamp somewhere before the face, which casts shadows, and more or less light from everywhere; heads are turned by up
to twenty degrees.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from benchmarks.known_truth.head_scan import read_head_scan
from benchmarks.scan_studio.people.template_people import template_subject
from benchmarks.shared_media import media
from engine.body.template import load_template
from engine.geometry.mesh.surface import vertex_normals
from engine.perception.face.faces import FaceTracker
from engine.render.rasterisation.attributes import interpolate, sample_texture
from engine.render.rasterisation.rasteriser import depth_map, rasterise

PHOTO_SIDE_PIXELS = 360
"""Pixels of a photograph."""
HEAD_SHARE = 0.62
"""Of a photograph's side that the head takes."""
MAX_TURN_DEGREES, MAX_NOD_DEGREES = 20.0, 10.0
"""Degrees."""
SHADOW_BIAS_HEAD_HEIGHTS = 0.01
"""Of the head's height: a surface is not in the shadow of itself."""
SHOWN_EXPRESSIONS = (
    *({"jawOpen": 0.5}, {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8}, {"browInnerUp": 0.8, "jawOpen": 0.2}),
    *(
        {"mouthPucker": 0.7},
        {"browDownLeft": 0.8, "browDownRight": 0.8},
        {"mouthFrownLeft": 0.7, "mouthFrownRight": 0.7},
    ),
)
"""Shown by a share of the photographs each, at half to full strength; the others are at rest."""
SHOULDER_SCAN_HEIGHTS = -0.05
"""Heights of the scan above its middle up to which shoulders are."""
HEAD_BODY_SHARE = 0.145
"""Of a standing body's height that its head takes."""


class KnownHead(NamedTuple):
    """`shaped` gives the vertices (V, 3), y up and facing +z, for weights of face units; `triangles` (T, 3), which lie on the texture
    (h, w, 3) by `uv` (U, 2) and `uv_triangles` (T, 3)."""

    name: str
    shaped: Callable[[Mapping[str, float]], NDArray[np.float64]]
    triangles: NDArray[np.integer]
    uv: NDArray[np.floating]
    uv_triangles: NDArray[np.integer]
    texture: NDArray[np.uint8]
    framed: NDArray[np.bool_]
    """(V,) what the picture is framed by: the head, without the shoulders."""
    expressive: bool
    numbers: NDArray[np.integer]
    """(V,) of the vertices: those of the template's people are the same for all."""


@dataclass(frozen=True)
class View:
    """A head seen orthographically: `scale`, pixels for one unit of it, `turn` (3, 3) and `middle` (3,), what lies at the picture's middle."""

    turn: NDArray[np.float64]
    middle: NDArray[np.float64]
    scale: float

    def __call__(self, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
        """(V, 3) pixels, depth away from the viewer."""
        turned = (vertices - self.middle) @ self.turn.T * self.scale
        return turned * (1, -1, -1) + ((PHOTO_SIDE_PIXELS - 1) / 2, (PHOTO_SIDE_PIXELS - 1) / 2, 0)


def photographs(
    head: KnownHead, count: int, random: np.random.Generator, acting: bool = True
) -> tuple[NDArray[np.float32], list[NDArray[np.uint8]]]:
    """Meshes (N, 478, 3) and photographs (PHOTO_SIDE_PIXELS, PHOTO_SIDE_PIXELS, 3) of those among `count` in which a face is found; every other one of a head that is
    `expressive` shows an expression, if it is to act."""
    meshes, photos = [], []
    with FaceTracker(alone=True) as tracker:
        for number in range(count):
            weights: dict[str, float] = {}
            if acting and head.expressive and number % 2:
                strength = random.uniform(0.5, 1)
                weights = {
                    name: strength * one
                    for name, one in SHOWN_EXPRESSIONS[number // 2 % len(SHOWN_EXPRESSIONS)].items()
                }
            photo = photographed(head, weights, random)
            found = tracker(photo)
            if found:
                meshes.append(found[0])
                photos.append(photo)
    return np.array(meshes), photos


def from_before(head: KnownHead) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """The mesh (478, 3) that a tracker finds of the head at rest, seen from before in an even light, and its vertices (V, 3) there, pixels."""
    vertices = head.shaped({})
    front = rendered(head, vertices, np.eye(3), np.array([0.0, 0.3, 0.95]), 0.7)
    with FaceTracker(alone=True) as tracker:
        mesh = tracker(front)[0]
    return mesh, view_of(head, vertices, np.eye(3))(vertices)


def photographed(head: KnownHead, weights: Mapping[str, float], random: np.random.Generator) -> NDArray[np.uint8]:
    angles = random.uniform(-1, 1, 2) * (MAX_NOD_DEGREES, MAX_TURN_DEGREES)
    turn = np.asarray(Rotation.from_euler("xy", angles, degrees=True).as_matrix())
    lamp = np.array([random.uniform(-1, 1), random.uniform(-0.4, 1), random.uniform(0.5, 1.2)])
    return rendered(head, head.shaped(weights), turn, lamp / np.linalg.norm(lamp), random.uniform(0.15, 0.5))


def rendered(
    head: KnownHead, vertices: NDArray[np.float64], turn: NDArray[np.float64], lamp: NDArray[np.float64], ambient: float
) -> NDArray[np.uint8]:
    """A photograph (PHOTO_SIDE_PIXELS, PHOTO_SIDE_PIXELS, 3) of the head, `turn`ed (3, 3), by a `lamp` (3,) that stays where it is and light from everywhere."""
    view = view_of(head, vertices, turn)
    seen = view(vertices)
    raster = rasterise(seen, head.triangles, (PHOTO_SIDE_PIXELS, PHOTO_SIDE_PIXELS))
    there = raster.triangle >= 0
    colours = sample_texture(head.texture, interpolate(head.uv, head.uv_triangles, raster), there)
    normals = interpolate(vertex_normals(vertices, head.triangles) @ turn.T, head.triangles, raster)
    facing = np.clip(normals @ lamp, 0, 1) * ~_in_shadow(seen, head.triangles, raster, lamp)
    shaded = (colours / 255) ** 2.2 * (ambient + (1 - ambient) * 1.4 * facing)[..., None]
    picture = np.where(there[..., None], 255 * np.clip(shaded, 0, 1) ** (1 / 2.2), 128)
    return np.asarray(cv2.GaussianBlur(picture, (0, 0), 0.6) + 0.5, np.uint8)


def _in_shadow(
    seen: NDArray[np.float64], triangles: NDArray[np.integer], raster: object, lamp: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(PHOTO_SIDE_PIXELS, PHOTO_SIDE_PIXELS) where something lies between what is seen and the lamp."""
    toward = lamp * (1, -1, -1)  # in pixels: y down, away from the viewer
    side = np.cross(toward, (0.0, 1.0, 0.0))
    side /= np.linalg.norm(side)
    basis = np.array([side, np.cross(toward, side), -toward])
    middle = np.array([(PHOTO_SIDE_PIXELS - 1) / 2, (PHOTO_SIDE_PIXELS - 1) / 2, 0])
    lit = (seen - middle) @ basis.T + (PHOTO_SIDE_PIXELS / 2, PHOTO_SIDE_PIXELS / 2, 0)
    depth = depth_map(lit, triangles, (PHOTO_SIDE_PIXELS, PHOTO_SIDE_PIXELS))
    own = interpolate(lit, triangles, raster)  # type: ignore[arg-type]
    nearest = cv2.remap(
        depth, own[..., 0], own[..., 1], cv2.INTER_NEAREST, borderMode=cv2.BORDER_CONSTANT, borderValue=1e9
    )
    return np.asarray(own[..., 2] > np.asarray(nearest) + SHADOW_BIAS_HEAD_HEIGHTS * PHOTO_SIDE_PIXELS)


def view_of(head: KnownHead, vertices: NDArray[np.float64], turn: NDArray[np.float64]) -> View:
    low, high = vertices[head.framed].min(axis=0), vertices[head.framed].max(axis=0)
    return View(turn, (low + high) / 2, HEAD_SHARE * PHOTO_SIDE_PIXELS / float(high[1] - low[1]))


def head_scan() -> KnownHead:
    scan = read_head_scan(media("scans3d/head_lee_perry_smith"))
    above = scan.vertices[:, 1] > SHOULDER_SCAN_HEIGHTS * float(np.ptp(scan.vertices[:, 1]))
    on = (scan.triangles, scan.uv, scan.triangles, scan.texture)
    return KnownHead("scan", lambda weights: scan.vertices, *on, above, False, np.arange(len(scan.vertices)))


def template_person(name: str) -> KnownHead:
    subject, units = template_subject(name, 1024), load_template().face_units
    above = subject.vertices[:, 1] > (1 - HEAD_BODY_SHARE) * subject.height
    on_head = above[subject.triangles].all(axis=1)
    kept, triangles = np.unique(subject.triangles[on_head], return_inverse=True)

    def shaped(weights: Mapping[str, float]) -> NDArray[np.float64]:
        return np.asarray((subject.vertices + units.displacement(weights))[kept], np.float64)

    on = (triangles.reshape(-1, 3), subject.uv, subject.uv_triangles[on_head], subject.texture)
    return KnownHead(name, shaped, *on, np.ones(len(kept), np.bool_), True, kept)
