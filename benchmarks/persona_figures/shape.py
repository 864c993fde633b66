"""How near a persona's shape is to the true one, of collections that are rendered of known heads under many lights.

A real head scan, which shows one expression, and two people made of the human template, who show many. Each photograph has one lamp
somewhere before the face, which casts shadows, and more or less light from everywhere; heads are turned by up to twenty degrees. The
error is that of depth, after the similarity that fits best, in shares of the face's width: the persona's, that of its landmark mesh, and
that of the general face.
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
from benchmarks.scan_studio.template_people import template_subject
from benchmarks.shared_media import media
from benchmarks.tables import table
from engine.body.template import load_template
from engine.geometry.registration.rigid import fit_similarities, fit_similarity
from engine.geometry.surface import vertex_normals
from engine.perception.faces import FaceTracker
from engine.perception.head_pose import canonical_face
from engine.perception.landmarks import FACE_OVAL, RIGID_VERTICES
from engine.persona.learning import learn_persona
from engine.persona.persona import Persona
from engine.render.attributes import interpolate, sample_texture
from engine.render.rasteriser import depth_map, rasterise

PHOTOS, SIZE = 60, (244, 194)
SIDE = 360
"""Pixels of a photograph."""
SHARE = 0.62
"""Of a photograph's side that the head takes."""
MAX_TURN, MAX_NOD = 20.0, 10.0
"""Degrees."""
SHADOW_BIAS = 0.01
"""Of the head's height: a surface is not in the shadow of itself."""
EXPRESSIONS = (
    *({"jawOpen": 0.5}, {"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8}, {"browInnerUp": 0.8, "jawOpen": 0.2}),
    *(
        {"mouthPucker": 0.7},
        {"browDownLeft": 0.8, "browDownRight": 0.8},
        {"mouthFrownLeft": 0.7, "mouthFrownRight": 0.7},
    ),
)
"""Shown by a share of the photographs each, at half to full strength; the others are at rest."""
SHOULDERS = -0.05
"""Heights of the scan above its middle, up to which they are."""
BODY_SHARE = 0.145
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


@dataclass(frozen=True)
class View:
    """A head seen orthographically: `scale`, pixels for one unit of it, `turn` (3, 3) and `middle` (3,), what lies at the picture's middle."""

    turn: NDArray[np.float64]
    middle: NDArray[np.float64]
    scale: float

    def __call__(self, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
        """(V, 3) pixels, depth away from the viewer."""
        turned = (vertices - self.middle) @ self.turn.T * self.scale
        return turned * (1, -1, -1) + ((SIDE - 1) / 2, (SIDE - 1) / 2, 0)


def shape() -> None:
    """Print the table."""
    rows = []
    for head in (_scan(), *(_template_person(name) for name in ("template-a", "template-b"))):
        persona = _learnt(head)
        ours, mesh, general = _errors(head, persona)
        best = min(mesh, general)
        rows.append([head.name, f"{ours:.2f}", f"{mesh:.2f}", f"{general:.2f}", f"{100 * (1 - ours / best):.0f}%"])
    head_row = ["head", "persona", "landmark mesh", "general face", "below the better of both"]
    print(table(f"Depth error, % of the face's width, {PHOTOS} photographs; goal 10% below", head_row, rows))


def _learnt(head: KnownHead) -> Persona:
    random = np.random.default_rng(5)
    meshes, photos = [], []
    with FaceTracker(alone=True) as tracker:
        for number in range(PHOTOS):
            weights: dict[str, float] = {}
            if head.expressive and number % 2:
                strength = random.uniform(0.5, 1)
                weights = {name: strength * one for name, one in EXPRESSIONS[number // 2 % len(EXPRESSIONS)].items()}
            photo = _photograph(head, weights, random)
            found = tracker(photo)
            if found:
                meshes.append(found[0])
                photos.append(photo)
    return learn_persona(np.array(meshes), lambda number: photos[number], SIZE).persona


def _photograph(head: KnownHead, weights: Mapping[str, float], random: np.random.Generator) -> NDArray[np.uint8]:
    angles = random.uniform(-1, 1, 2) * (MAX_NOD, MAX_TURN)
    turn = np.asarray(Rotation.from_euler("xy", angles, degrees=True).as_matrix())
    lamp = np.array([random.uniform(-1, 1), random.uniform(-0.4, 1), random.uniform(0.5, 1.2)])
    return _rendered(head, head.shaped(weights), turn, lamp / np.linalg.norm(lamp), random.uniform(0.15, 0.5))


def _rendered(
    head: KnownHead, vertices: NDArray[np.float64], turn: NDArray[np.float64], lamp: NDArray[np.float64], ambient: float
) -> NDArray[np.uint8]:
    """A photograph (SIDE, SIDE, 3) of the head, `turn`ed (3, 3), by a `lamp` (3,) that stays where it is and light from everywhere."""
    view = _view(head, vertices, turn)
    seen = view(vertices)
    raster = rasterise(seen, head.triangles, (SIDE, SIDE))
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
    """(SIDE, SIDE) where something lies between what is seen and the lamp."""
    toward = lamp * (1, -1, -1)  # in pixels: y down, away from the viewer
    side = np.cross(toward, (0.0, 1.0, 0.0))
    side /= np.linalg.norm(side)
    basis = np.array([side, np.cross(toward, side), -toward])
    middle = np.array([(SIDE - 1) / 2, (SIDE - 1) / 2, 0])
    lit = (seen - middle) @ basis.T + (SIDE / 2, SIDE / 2, 0)
    depth = depth_map(lit, triangles, (SIDE, SIDE))
    own = interpolate(lit, triangles, raster)  # type: ignore[arg-type]
    nearest = cv2.remap(
        depth, own[..., 0], own[..., 1], cv2.INTER_NEAREST, borderMode=cv2.BORDER_CONSTANT, borderValue=1e9
    )
    return np.asarray(own[..., 2] > np.asarray(nearest) + SHADOW_BIAS * SIDE)


def _view(head: KnownHead, vertices: NDArray[np.float64], turn: NDArray[np.float64]) -> View:
    low, high = vertices[head.framed].min(axis=0), vertices[head.framed].max(axis=0)
    return View(turn, (low + high) / 2, SHARE * SIDE / float(high[1] - low[1]))


def _errors(head: KnownHead, persona: Persona) -> tuple[float, float, float]:
    """Of the persona's depth, its landmark mesh's and the general face's."""
    frame = persona.frame
    vertices = head.shaped({})
    front = _rendered(head, vertices, np.eye(3), np.array([0.0, 0.3, 0.95]), 0.7)
    with FaceTracker(alone=True) as tracker:
        mesh = tracker(front)[0]
    chosen = list(RIGID_VERTICES)
    laid = fit_similarity(mesh[chosen, :2].astype(np.float64), frame.places[chosen, :2])
    scale = float(np.sqrt(np.linalg.det(laid.linear)))
    seen = _view(head, vertices, np.eye(3))(vertices)
    placed = np.column_stack([seen[:, :2] @ laid.linear.T + laid.shift, seen[:, 2] * scale])
    true = rasterise(placed, head.triangles, frame.size).depth
    area = cv2.erode(frame.face.astype(np.uint8), np.ones((15, 15))) > 0
    area &= np.isfinite(true)
    width = float(np.ptp(frame.places[list(FACE_OVAL), 0]))
    general = np.zeros(len(frame.places))
    general[:478] = canonical_face()[:, 2] * frame.scale
    general[478:] = general[list(FACE_OVAL)]
    depths = (
        persona.depth,
        frame.interpolated(frame.places[:, 2:])[..., 0],
        frame.interpolated(general[:, None])[..., 0],
    )
    ours, landmark, generic = (100 * _error(depth, true, area) / width for depth in depths)
    return ours, landmark, generic


def _error(depth: NDArray[np.floating], true: NDArray[np.floating], area: NDArray[np.bool_]) -> float:
    """Mean distance in depth, pixels, of what is in the `area` after a similarity."""
    rows, columns = np.nonzero(area)
    given = np.column_stack([columns, rows, depth[area]]).astype(np.float64)
    goal = np.column_stack([columns, rows, true[area]]).astype(np.float64)
    scale, rotation, shift = fit_similarities(given, goal[None], np.ones(len(given)))
    moved = scale[0] * given @ rotation[0].T + shift[0]
    return float(np.abs(moved - goal)[:, 2].mean())


def _scan() -> KnownHead:
    scan = read_head_scan(media("scans3d/head_lee_perry_smith"))
    above = scan.vertices[:, 1] > SHOULDERS * float(np.ptp(scan.vertices[:, 1]))
    on = (scan.triangles, scan.uv, scan.triangles, scan.texture)
    return KnownHead("scan", lambda weights: scan.vertices, *on, above, expressive=False)


def _template_person(name: str) -> KnownHead:
    subject, units = template_subject(name, 1024), load_template().face_units
    above = subject.vertices[:, 1] > (1 - BODY_SHARE) * subject.height
    on_head = above[subject.triangles].all(axis=1)
    kept, triangles = np.unique(subject.triangles[on_head], return_inverse=True)

    def shaped(weights: Mapping[str, float]) -> NDArray[np.float64]:
        return np.asarray((subject.vertices + units.displacement(weights))[kept], np.float64)

    on = (triangles.reshape(-1, 3), subject.uv, subject.uv_triangles[on_head], subject.texture)
    return KnownHead(name, shaped, *on, np.ones(len(kept), np.bool_), expressive=True)
