"""Characters: seconds by stage and by correction, and how well silhouette, colours and joints hold.

    python -m benchmarks.character [PICTURE...] [--seconds 2]

Without pictures: all people of the test media. The process is warmed up first; stages are kept, as the service does. "To
GLB" is everything but the video and the quality, of a revision too: with a joint moved by hand, with a stroke over the
labels, with another motion. The quality is that of the GLB, read back (`benchmarks.known_truth.written_character`): "of the
mask" is its silhouette, posed by `pictured` and drawn by OpenCV, "reported" what the report says. "Front" is the PSNR
against the picture inside the mask, "flipped" the share of the pixels in view that show a triangle's back. "Stretched" is
the share of edges that become more than three times as long as pictured, the worst moment of all built-in clips. "Off" is,
in turn, how far the file's vertices are from the character's, its weights' sums from one, its joints at rest times their
inverse bind matrices from the identity. Pictures that fail are told, and the exit status is 1.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.character_figures.steps import options_for, pictures
from benchmarks.character_figures.stretching import stretched
from benchmarks.known_truth.written_character import Written, outline, read_written
from benchmarks.presentation.tables import machine, table
from engine.character import KIND
from engine.character.film.person import Person
from engine.character.options import CharacterOptions
from engine.character.pipeline import cut_all_out, find_figures, reconstruct, wake_up
from engine.character.rig.measures import picture_camera
from engine.motion.library import CLIPS
from engine.render.scene.character import draw_character, prepare_character
from engine.run import Run
from engine.store import StageStore

ELBOW_SHIFT_SHARE = 0.02
"""By how much of the picture's height a revision moves an elbow."""


@dataclass(frozen=True)
class Measured:
    """The rows of a picture."""

    seconds: dict[str, str]
    quality: dict[str, str]
    written: dict[str, str]


def examine(photo: Path, asked: Mapping[str, Any], folder: Path) -> Measured:
    """Wake somebody up, look at what was written, and correct it."""
    options, kept, out = options_for(photo, asked), StageStore(folder / "kept"), folder / "out"
    out.mkdir()
    report = _run(photo, options, kept, out)
    written = read_written(out / "character.glb")
    person = _person(photo, options, kept)
    stages, skeleton = report["stages"], json.loads((out / "skeleton.json").read_text())
    megabytes = (out / "character.glb").stat().st_size / 1e6
    seconds = {stage: f"{taken:.2f}" for stage, taken in stages.items()}
    seconds["frames/s"] = f"{report['inputs']['frames'] / stages['animate']:.0f}"
    seconds["to GLB"] = f"{_to_glb(report):.1f}"
    for name, revision in _revisions(options, skeleton):
        corrected = CharacterOptions.model_validate({**options.model_dump(), **revision})
        seconds[name] = f"{_to_glb(_run(photo, corrected, kept, out)):.1f}"
    return Measured(seconds, _quality(report["quality"], person, written), _file(person, written, megabytes))


def _run(photo: Path, options: CharacterOptions, kept: StageStore, out: Path) -> dict[str, Any]:
    with Run(store=kept) as run:
        wake_up({"photo": photo}, options, out, run)
    report: dict[str, Any] = json.loads((out / "report.json").read_text())
    return report


def _to_glb(report: Mapping[str, Any]) -> float:
    return sum(seconds for stage, seconds in report["stages"].items() if stage not in ("animate", "measure"))


def _person(photo: Path, options: CharacterOptions, kept: StageStore) -> Person:
    """Whoever was woken, from the stages that were kept."""
    with Run(store=kept) as run:
        figures, silhouettes = cut_all_out(find_figures(photo, options, run), None, options, run)
        return reconstruct(figures[0], silhouettes[0], None, options, run)


def _revisions(options: CharacterOptions, skeleton: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    width, height = skeleton["size"]
    x, y = skeleton["joints"]["LeftElbow"]["place"]
    radius = ELBOW_SHIFT_SHARE * height
    x, y = min(max(x, 0), width - 1), min(max(y, 0), height - 1 - radius)  # it may lie outside
    yield "joint", {"joints": {**options.joints, "LeftElbow": (x, y + radius)}}
    yield "label", {"label_strokes": ({"path": ((x, y),), "radius": radius, "part": "left_arm"},)}
    yield "motion", {"motion": "dance"}


def _quality(reported: Mapping[str, float], person: Person, written: Written) -> dict[str, str]:
    rgb, alpha = person.figure.rgb, person.silhouette.alpha
    camera = picture_camera(person.character, person.fitted, (rgb.shape[0], rgb.shape[1]))
    mask = alpha > 0.5
    covered = outline(camera.project(written.pictured), written.mesh.triangles, camera.size)
    drawn = draw_character(prepare_character(written.mesh), written.pictured.astype(np.float32), camera)
    inside = (alpha > 0.95) & (drawn.alpha > 0.95)
    error = ((drawn.rgb[inside].astype(float) - rgb[inside]) ** 2).mean()
    return {
        "of the mask": f"{(covered & mask).sum() / (covered | mask).sum():.4f}",
        "reported": f"{reported['silhouette_iou']:.4f}",
        "landmarks off": f"{100 * reported['landmark_reprojection']:.2f} %",
        "front": f"{10 * np.log10(255**2 / max(error, 1e-9)):.1f} dB",
        "flipped": f"{100 * reported['flipped']:.3f} %",
        "stretched": f"{100 * max(stretched(person.character, clip) for clip in CLIPS):.2f} %",
        "closed": "yes" if reported["closed"] else "no",
    }


def _file(person: Person, written: Written, megabytes: float) -> dict[str, str]:
    made, read = person.character.mesh, written.mesh
    same = made.vertices.shape == read.vertices.shape and np.array_equal(made.triangles, read.triangles)
    off = f"{1000 * np.abs(made.vertices - read.vertices).max():.3f} mm" if same else "another mesh"
    return {
        "MB": f"{megabytes:.1f}",
        "triangles": f"{len(read.triangles)}",
        "vertices off": off,
        "weights off": f"{written.unweighted:.0e}",
        "bind off": f"{written.unbound:.0e}",
        "texture": f"{read.texture.shape[1]}x{read.texture.shape[0]}",
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", nargs="*", type=Path)
    parser.add_argument("--seconds", type=float, default=2.0)
    asked = parser.parse_args()
    measured: dict[str, Measured] = {}
    failed: list[list[str]] = []
    with tempfile.TemporaryDirectory() as folder:
        assert KIND.rehearse is not None
        KIND.rehearse(Path(folder))
    for picture in asked.pictures or pictures():
        with tempfile.TemporaryDirectory() as folder:
            try:
                measured[picture.stem] = examine(picture, {"seconds": asked.seconds}, Path(folder))
            except Exception as error:
                failed.append([picture.stem, f"{type(error).__name__}: {error}"])
    print(machine())
    for title, rows in (
        ("Seconds", {name: one.seconds for name, one in measured.items()}),
        ("Quality", {name: one.quality for name, one in measured.items()}),
        ("The GLB, read back", {name: one.written for name, one in measured.items()}),
    ):
        head = list(next(iter(rows.values()), {}))
        print(table(title, ["picture", *head], [[name, *row.values()] for name, row in rows.items()]))
    if failed:
        print(table("Failed", ["picture", "why"], failed))
        sys.exit(1)


if __name__ == "__main__":
    main()
