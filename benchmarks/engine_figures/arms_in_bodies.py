"""Hands and forearms inside trunk and legs, in the built-in motions and in motions by files, on bodies of three shapes.

    python -m benchmarks.engine_figures.arms_in_bodies [FOLDER OF MOTIONS]

What is inside, and how deep, is told by the nearest point of the posed skin without arms, and by its normal.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.tables import table
from engine.avatar.mesh import skinned_mesh, surface_of
from engine.body.rest_pose import t_pose
from engine.body.rig import HUMAN_RIG
from engine.body.shape import Phenotype, load_shape_space
from engine.body.template import load_rig, load_template
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import triangulate, vertex_normals
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.arms.arms_outside import arms_outside
from engine.motion.arms.solid_body import solid_body
from engine.motion.clip import Clip
from engine.motion.files.reading import read_motion
from engine.motion.kinematics import pose_transforms
from engine.motion.library import CLIPS, built_in
from engine.motion.retargeting.retarget import retarget

SHAPES: Mapping[str, tuple[Phenotype, float]] = {
    "template": (Phenotype(), 0.0),
    "slim": (Phenotype(0.5, 0.0, 0.5, 0.1), 0.0),
    "broad, in a coat": (Phenotype(0.6, 1.0, 0.5, 0.9), 0.03),
}
"""Bodies, and metres by which cloth stands off their trunk and thighs."""
WORN_ON = ("Hips", "Spine", "Spine1", "Spine2", "LeftUpLeg", "RightUpLeg")
"""The joints that move a coat."""
LOOKED_AT_SECONDS = 0.15
"""Seconds from one frame that is looked at to the next."""
MAX_DEPTH_METRES = 0.12
"""Metres from the skin beyond which nobody is inside of it."""
SEEN_METRES = 0.01
"""Metres: who is no deeper touches."""


def shaped(phenotype: Phenotype, cloth: float) -> SkinnedMesh:
    """The template in a shape, in T-pose, cloth so many metres off its trunk and thighs."""
    template, rig = load_template(), load_rig(HUMAN_RIG)
    skeleton, _, rest = t_pose(rig, load_shape_space().shape(phenotype), template.vertices_of("body"))
    worn = (rig.weights * np.isin(rig.bones, [rig.index(name) for name in WORN_ON])).sum(1)
    away = vertex_normals(rest, triangulate(template.quads[template.faces("body")]))
    texture = np.full((4, 4, 3), 200, np.uint8)
    return skinned_mesh(surface_of(template), rig, skeleton, rest + cloth * worn[:, None] * away, texture)


def depths(mesh: SkinnedMesh, clip: Clip) -> NDArray[np.float64]:
    """(F,) metres by which the deepest of hands and forearms is inside the rest, in frames `LOOKED_AT_SECONDS` apart."""
    names = np.array(mesh.skeleton.names)
    arm = np.isin(mesh.bones, [j for j, name in enumerate(names) if name.endswith("Arm") or "Hand" in name])
    lower = np.array([name.endswith("ForeArm") or "Hand" in name for name in names])[mesh.bones[:, 0]]
    inside = mesh.triangles[((mesh.weights * arm).sum(1) < 0.3)[mesh.triangles].all(1)]
    chosen = np.flatnonzero(lower & (mesh.weights[:, 0] > 0.7))
    chosen = chosen[np.unique(np.round(mesh.vertices[chosen] / 0.015), axis=0, return_index=True)[1]]
    frames = np.arange(0, len(clip.rotations), max(round(LOOKED_AT_SECONDS * clip.fps), 1))
    found = []
    for transforms in pose_transforms(mesh.skeleton, clip.rotations[frames], clip.root[frames]):
        posed = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
        points = posed[chosen]
        nearest = closest_points(points, posed, inside)
        off = points - nearest.interpolated(posed, inside)
        within = (off * nearest.interpolated(vertex_normals(posed, inside), inside)).sum(1) < 0
        found.append(nearest.distance[within & (nearest.distance < MAX_DEPTH_METRES)].max(initial=0))
    return np.array(found)


def motions(folder: Path | None) -> Mapping[str, Callable[[SkinnedMesh], Clip]]:
    """What makes a motion for a body, by name."""

    def own(name: str) -> Callable[[SkinnedMesh], Clip]:
        return lambda mesh: built_in(name, mesh.skeleton)

    def carried(path: Path) -> Callable[[SkinnedMesh], Clip]:
        return lambda mesh: retarget(read_motion(path), mesh.skeleton).clip

    files = sorted(folder.glob("*.bvh")) if folder else []
    return {name: own(name) for name in CLIPS} | {path.stem: carried(path) for path in files}


def main() -> None:
    """Print how often and how deep, before and after arms are put outside."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?")
    rows = []
    for shape, (phenotype, cloth) in SHAPES.items():
        mesh = shaped(phenotype, cloth)
        solid = solid_body(mesh)
        for name, made in motions(parser.parse_args().folder).items():
            clip = made(mesh)
            started = time.perf_counter()
            mended = arms_outside(solid, clip)
            taken = 1000 * (time.perf_counter() - started) / len(clip.rotations)
            before, after = depths(mesh, clip), depths(mesh, mended)
            shares = [f"{100 * np.mean(one > SEEN_METRES):.0f} %" for one in (before, after)]
            deepest = [f"{100 * one.max():.1f}" for one in (before, after)]
            rows.append([shape, name, *shares, *deepest, f"{taken:.2f}"])
    columns = ["body", "motion", "frames over 1 cm", "after", "deepest, cm", "after", "ms a frame"]
    print(table("Hands and forearms inside the body", columns, rows))


if __name__ == "__main__":
    main()
