"""How good an avatar is, from films to files: a film of a known person, and what was delivered, held against the truth.

    python -m benchmarks.avatar FOLDER OUT [--body 75] [--head 50] [--texture 4096] [--without-head] [--room-cameras] [--sheet OUT.png]

FOLDER is what `python -m benchmarks.scan_studio` made of a subject; OUT takes the avatar's files, and OUT/stages what its
stages found. Where OUT holds a finished avatar, it is measured as it is. Prints seconds by stage, peak memory, distances to the truth of body and
head, vertex errors of template people, and the error of colours (CIELAB) beside that of the true shape and cameras through the
same texture stage. Only delivered files are measured: `avatar.glb` in its clip `filmed`, and `cameras.json`.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from dataclasses import astuple, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.avatar_figures.colours import colour_errors
from benchmarks.avatar_figures.room_cameras import RoomCamerasRun
from benchmarks.avatar_figures.sheet import avatar_sheet
from benchmarks.presentation.contact_sheet import write_sheet
from benchmarks.presentation.tables import machine, table
from benchmarks.scan_studio.comparison.distance import (
    Distances,
    MeasuredSurface,
    above,
    below,
    between_surfaces,
    measured_surface,
)
from benchmarks.scan_studio.people.rigged_glb import TexturedPart, read_in_clip
from benchmarks.scan_studio.truth import Truth, read_truth
from engine.avatar.mesh import surface_of
from engine.avatar.options import AvatarOptions
from engine.avatar.pipeline import make_avatar
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template
from engine.geometry.camera import Camera
from engine.geometry.registration.iterative_closest_point import rigid_onto_surface
from engine.geometry.registration.rigid import Similarity, fit_rigid
from engine.run import Run
from engine.store import StageStore

HEAD_START_HEIGHT_SHARE = 0.87
"""Share of the person's height from which up it is the head."""
TRUTH_GATE_METRES = 0.03
"""Metres within which points of what was made are laid on the truth."""
TRUTH_ALIGNMENT_ROUNDS = 12
"""How often what was made is laid on the truth."""


def make(folder: Path, out: Path, asked: argparse.Namespace, height: float) -> None:
    """Make an avatar of the films in a folder, and tell how long it took and what memory."""
    out.mkdir(parents=True, exist_ok=True)
    options = AvatarOptions(
        height_m=round(height, 3),
        body_frames=asked.body,
        head_frames=asked.head,
        texture_size=asked.texture,
        size=(360, 640),
        seconds=1,
    )
    inputs = {"body": folder / "body.mp4"} | ({} if asked.without_head else {"head": folder / "head.mp4"})
    began = time.perf_counter()
    kind = RoomCamerasRun if asked.room_cameras else Run
    with kind(store=StageStore(out / "stages")) as run:
        make_avatar(inputs, options, out, run)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(f"{time.perf_counter() - began:.0f} s, peak {peak:.2f} GB")


def cameras_of(out: Path) -> dict[str, dict[int, Camera]]:
    """The cameras of `cameras.json`, by clip and frame."""
    return {
        clip: {
            one["frame"]: Camera.of_matrices(
                np.array(one["intrinsics"]), np.array(one["rotation"]), np.array(one["translation"]), one["size"][::-1]
            )
            for one in each
        }
        for clip, each in json.loads((out / "cameras.json").read_text()).items()
    }


def onto_truth(
    cameras: dict[int, Camera], truth: Truth, vertices: NDArray[np.float64], surface: MeasuredSurface
) -> Similarity:
    """The rigid motion that takes what was made to the truth: by where the cameras stood, then by closest points."""
    mine = np.array([camera.eye for camera in cameras.values()])
    true = np.array([truth.person_camera("body", frame).eye for frame in cameras])
    first = fit_rigid(mine, true)
    placed = first(vertices)
    turn = rigid_onto_surface(placed, surface.vertices, surface.triangles, TRUTH_GATE_METRES, TRUTH_ALIGNMENT_ROUNDS)
    return Similarity(turn.linear @ first.linear, turn(first.shift))


def vertex_errors(part: TexturedPart, motion: Similarity, truth: Truth) -> dict[str, float]:
    """Medians, millimetres, of how far the template's vertices are from those of a person of the template."""
    template, rig = load_template(), load_rig(HUMAN_RIG)
    surface = surface_of(template)
    if len(surface.vertex_of) != len(part.vertices):
        raise ValueError("the avatar has fewer vertices than the template: ask for all triangles")
    off = np.full(len(template.vertices), np.nan)
    off[surface.vertex_of] = np.linalg.norm(motion(part.vertices) - truth.subject.vertices[surface.vertex_of], axis=1)
    skin = np.zeros(len(off), np.bool_)
    skin[template.vertices_of("body")] = True
    strongest = rig.bones[:, 0]
    face = skin & (strongest == rig.index("Head")) & (truth.subject.vertices[:, 2] > 0)
    return {name: 1000 * float(np.nanmedian(off[where])) for name, where in (("face", face), ("body", skin))}


def print_distances(rows: dict[str, Distances]) -> None:
    """Millimetres, by region."""
    names = [field.name for field in fields(Distances)]
    print(
        table(
            "Distances, mm",
            ["region", *names],
            [[region, *(f"{1000 * value:.1f}" for value in astuple(row))] for region, row in rows.items()],
        )
    )


def main() -> None:
    """Make, measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--body", type=int, default=75)
    parser.add_argument("--head", type=int, default=50)
    parser.add_argument("--texture", type=int, default=4096)
    parser.add_argument("--without-head", action="store_true")
    parser.add_argument("--room-cameras", action="store_true", help="do not lock the cameras to the person")
    parser.add_argument("--sheet", type=Path)
    parser.add_argument("--without-colours", action="store_true", help="the oracle's texture takes a minute or two")
    asked = parser.parse_args()
    truth = read_truth(asked.folder)
    subject = truth.subject
    print(machine())
    if not (asked.out / "report.json").exists():
        make(asked.folder, asked.out, asked, subject.height)
    report = json.loads((asked.out / "report.json").read_text())
    print(f"{subject.name}: warned of " + (", ".join(w["code"] for w in report["warnings"]) or "nothing"))
    print(table("Seconds", ["stage", "s"], [[name, f"{s:.1f}"] for name, s in report["stages"].items()]))
    print(f"seen share {report['quality']['seen_share']}, coverage {report['coverage']}")

    (part,) = read_in_clip(asked.out / "avatar.glb", "filmed")
    cameras = cameras_of(asked.out)
    surface = measured_surface(subject.vertices, subject.triangles)
    motion = onto_truth(cameras["body"], truth, part.vertices, surface)
    mine = measured_surface(motion(part.vertices), part.triangles)
    neck = HEAD_START_HEIGHT_SHARE * subject.height
    print_distances(
        {
            "all": between_surfaces(mine, surface),
            "body": between_surfaces(mine, surface, below(neck)),
            "head": between_surfaces(mine, surface, above(neck)),
        }
    )
    if subject.template:
        print("vertex errors, mm:", {k: round(v, 1) for k, v in vertex_errors(part, motion, truth).items()})
    if not asked.without_colours:
        ours, oracle = colour_errors(asked.folder, truth, part, cameras, asked.texture)
        print(f"CIELAB RMSE {ours:.2f}, oracle {oracle:.2f}, ratio {ours / oracle:.2f}")
    if asked.sheet:
        write_sheet(asked.sheet, avatar_sheet(asked.folder, part, cameras))


if __name__ == "__main__":
    main()
