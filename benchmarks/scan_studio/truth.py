"""What is known of a film and of who is in it, beside the film: `truth.npz`, `truth.json` and `texture.png`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.scan_studio.people.subject import Arm, Subject
from benchmarks.scan_studio.people.sway import Stance
from engine.geometry.camera import Camera
from engine.media.image import read_image


@dataclass(frozen=True)
class FilmTruth:
    """Of F frames, in their order."""

    cameras: tuple[Camera, ...]
    """In the room, at the middle of the exposure."""
    stances: tuple[Stance, ...]
    """How the subject stands then."""
    gains: NDArray[np.float64]
    """(F, 3) by what red, green and blue light are multiplied."""
    seconds: NDArray[np.float64]
    """(F,) of the capture, over which the frames are spread."""


@dataclass(frozen=True)
class Truth:
    """All that is known."""

    subject: Subject
    """At rest, that is at the middle of its sway."""
    films: Mapping[str, FilmTruth]
    """By name: "body", "head"."""
    made: Mapping[str, Any]
    """How it was made: format, sway, seed, frames."""

    def vertices(self, film: str, frame: int) -> NDArray[np.float64]:
        """(V, 3) metres: the subject's vertices in the room as a frame shows them."""
        return self.films[film].stances[frame].place(self.subject)

    def person_camera(self, film: str, frame: int) -> Camera:
        """The camera of a frame in the axes of the subject at rest: the sway of the body taken out, that of the arms left."""
        camera, stance = self.films[film].cameras[frame], self.films[film].stances[frame]
        rotation = camera.rotation @ stance.rotation
        translation = camera.rotation @ stance.translation + camera.translation
        return Camera.of_matrices(camera.intrinsics, rotation, translation, camera.size)


def write_truth(folder: Path, truth: Truth) -> None:
    """Write all of it into a folder that is there."""
    one = truth.subject
    arrays: dict[str, NDArray[Any]] = {
        "vertices": one.vertices,
        "triangles": one.triangles,
        "uv": one.uv,
        "uv_triangles": one.uv_triangles,
        "shade": one.shade,
        "joint_names": np.array(list(one.joints), np.str_),
        "joints": np.array(list(one.joints.values())).reshape(-1, 3),
        "arm_weights": np.array([arm.weights for arm in one.arms]).reshape(-1, len(one.vertices)),
        "arm_pivots": np.array([arm.pivot for arm in one.arms]).reshape(-1, 3),
        "arm_reaches": np.array([arm.reach for arm in one.arms]),
    }
    for name, film in truth.films.items():
        arrays |= {
            f"{name}_intrinsics": np.array([camera.intrinsics for camera in film.cameras]),
            f"{name}_rotations": np.array([camera.rotation for camera in film.cameras]),
            f"{name}_translations": np.array([camera.translation for camera in film.cameras]),
            f"{name}_sway_rotations": np.array([stance.rotation for stance in film.stances]),
            f"{name}_sway_translations": np.array([stance.translation for stance in film.stances]),
            f"{name}_arm_vectors": np.array([stance.arms for stance in film.stances]),
            f"{name}_gains": film.gains,
            f"{name}_seconds": film.seconds,
        }
    np.savez_compressed(folder / "truth.npz", **arrays)  # type: ignore[arg-type]
    sizes = {name: film.cameras[0].size for name, film in truth.films.items()}
    told = {"subject": one.name, "height": one.height, "template": one.template, "sizes": sizes, **truth.made}
    (folder / "truth.json").write_text(json.dumps(told, indent=1) + "\n")
    Image.fromarray(one.texture).save(folder / "texture.png")


def read_truth(folder: Path) -> Truth:
    """The inverse of `write_truth`."""
    told = json.loads((folder / "truth.json").read_text())
    with np.load(folder / "truth.npz") as stored:
        arrays = {name: stored[name] for name in stored.files}
    subject = Subject(
        told["subject"],
        arrays["vertices"],
        arrays["triangles"],
        arrays["uv"],
        arrays["uv_triangles"],
        read_image(folder / "texture.png").rgb,
        arrays["shade"],
        dict(zip(arrays["joint_names"].tolist(), arrays["joints"], strict=True)),
        tuple(map(Arm, arrays["arm_weights"], arrays["arm_pivots"], arrays["arm_reaches"].tolist())),
        told["template"],
    )
    films = {name: _film(name, arrays, tuple(size)) for name, size in told["sizes"].items()}
    made = {key: value for key, value in told.items() if key not in ("subject", "height", "template", "sizes")}
    return Truth(subject, films, made)


def _film(name: str, arrays: Mapping[str, NDArray[Any]], size: tuple[int, int]) -> FilmTruth:
    of = {key.removeprefix(f"{name}_"): value for key, value in arrays.items() if key.startswith(f"{name}_")}
    views = zip(of["intrinsics"], of["rotations"], of["translations"], strict=True)
    cameras = tuple(Camera.of_matrices(k, r, t, size) for k, r, t in views)
    stances = tuple(map(Stance, of["sway_rotations"], of["sway_translations"], of["arm_vectors"]))
    return FilmTruth(cameras, stances, of["gains"], of["seconds"])
