"""Characters: seconds by stage, and how well silhouette, colours and joints hold.

    python -m benchmarks.character PICTURE... [--seconds 2]

Each picture is woken once to warm up the process, then measured. "To GLB" is everything but the video. "Front" is the
PSNR of the character, drawn as it is pictured, against the picture inside its mask. "Stretched" is the share of edges
that become more than three times as long as pictured, the worst of all built-in clips.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.tables import machine, table
from engine.body.skinning import pose_transforms, skin
from engine.character.figure import Choice, find_figure
from engine.character.measures import picture_camera, pose
from engine.character.options import CharacterOptions
from engine.character.pipeline import wake_up
from engine.character.rigging import Character
from engine.character.silhouette import cut_out
from engine.character.stages import build_mesh, fit_template, label, make_character
from engine.media.limits import Limits
from engine.motion.library import CLIPS, built_in
from engine.render.character import draw_character, prepare
from engine.run import Run

STRETCHED = 3.0
EVERY = 5
"""Frames of a clip that are looked at."""


def stretched(character: Character) -> float:
    """The largest share, over the built-in clips' frames, of edges stretched more than `STRETCHED` times."""
    mesh = character.mesh
    edges = np.unique(np.sort(np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]]]), 1), axis=0)

    def lengths(vertices: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)

    before = np.maximum(lengths(pose(character, character.pictured)), 1e-4)
    worst = 0.0
    for name in CLIPS:
        clip = built_in(name, mesh.skeleton)
        for transforms in pose_transforms(mesh.skeleton, clip.rotations[::EVERY], clip.root[::EVERY]):
            after = lengths(skin(mesh.vertices, mesh.bones, mesh.weights, transforms))
            worst = max(worst, float((after > STRETCHED * before).mean()))
    return worst


def front_and_stretch(photo: Path, partial: bool) -> tuple[float, float]:
    """(decibels, share of stretched edges) of a picture's character."""
    figure = find_figure(photo, Choice(), partial, Limits(), lambda code, message: None)
    silhouette = cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)
    fitted = fit_template(figure, silhouette)
    labels = label(figure, silhouette, fitted, None, (), Limits())
    mesh = build_mesh(figure, silhouette, fitted, labels)
    character = make_character(figure, silhouette, fitted, labels, mesh, 60_000, "mirror")
    camera = picture_camera(character, fitted, (figure.rgb.shape[0], figure.rgb.shape[1]))
    drawn = draw_character(prepare(character.mesh), pose(character, character.pictured), camera)
    inside = (silhouette.alpha > 0.95) & (drawn.alpha > 0.95)
    error = ((drawn.rgb[inside].astype(float) - figure.rgb[inside]) ** 2).mean()
    return float(10 * np.log10(255**2 / max(error, 1e-9))), stretched(character)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pictures", nargs="+", type=Path)
    parser.add_argument("--seconds", type=float, default=2.0)
    asked = parser.parse_args()
    options = CharacterOptions.model_validate({"seconds": asked.seconds, "partial": True})
    times, quality = [], []
    with tempfile.TemporaryDirectory() as folder:
        wake_up({"photo": asked.pictures[0]}, options, Path(folder), Run())
        for picture in asked.pictures:
            try:
                wake_up({"photo": picture}, options, Path(folder), Run())
            except Exception as error:
                print(f"{picture.name}: {error}")
                continue
            report = json.loads((Path(folder) / "report.json").read_text())
            stages, found = report["stages"], report["quality"]
            to_glb = sum(seconds for stage, seconds in stages.items() if stage != "animate")
            rate = report["inputs"]["frames"] / stages["animate"]
            times.append(
                [picture.stem, *(f"{second:.2f}" for second in stages.values()), f"{to_glb:.1f}", f"{rate:.0f}"]
            )
            decibels, stretch = front_and_stretch(picture, True)
            quality.append([picture.stem, f"{found['silhouette_iou']:.4f}", f"{100 * found['landmark_reprojection']:.2f} %",
                            f"{decibels:.1f} dB", f"{100 * stretch:.2f} %", "yes" if found["closed"] else "no"])  # fmt: skip
    print(machine())
    print(table("Seconds", ["picture", *stages, "to GLB", "frames/s"], times))
    print(table("Quality", ["picture", "silhouette IoU", "landmarks off", "front", "stretched", "closed"], quality))


if __name__ == "__main__":
    main()
