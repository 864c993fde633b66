"""The human template: how long it takes to load and to pose, and how much of what tells bodies apart its space of shapes holds.

    python -m benchmarks.engine_figures.human_template

Each time is the least of five, after one that is not counted: files lie in the system's memory, code is compiled.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from benchmarks.presentation.tables import machine, table
from engine.body import makehuman
from engine.body.body_space import load_body_space
from engine.body.cache import CACHE_FORMAT, cache_folder
from engine.body.rig import HUMAN_RIG
from engine.body.shape import load_shape_space
from engine.body.template import load_rig, load_template
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms
from engine.motion.library import built_in

POSED_FRAME_COUNT, REPEAT_COUNT = 100, 5
GOAL_TIME, GOAL_SIZE = "0.3 s", "40 MB"
COMPARED_COMPONENT_COUNTS = (1, 5, 10, 20, 30, 40)


def speed() -> None:
    """Print how long loading and skinning take, and how large the cache is."""
    template, rig, space = load_template(), load_rig(HUMAN_RIG), load_body_space()
    load_shape_space()
    body = template.vertices_of("body")
    clip = built_in("dance", space.skeleton(np.zeros(1)))
    rotations = np.resize(clip.rotations, (POSED_FRAME_COUNT, *clip.rotations.shape[1:]))
    root = np.resize(clip.root, (POSED_FRAME_COUNT, 3))
    bound = space.mean[body], rig.bones[body], rig.weights[body]
    transforms = pose_transforms(space.skeleton(np.zeros(1)), rotations, root)
    cases: dict[str, Callable[[], object]] = {
        "load: mesh, rig, space of shapes": lambda: (load_template(), load_rig(HUMAN_RIG), load_body_space()),
        "load: phenotypes and local shapes too": lambda: (load_rig(HUMAN_RIG), load_body_space(), load_shape_space()),
        f"skin {len(body)} vertices x {POSED_FRAME_COUNT} frames": lambda: skin(*bound, transforms),
    }
    rows = [[name, f"{_least(work):.3f} s", GOAL_TIME] for name, work in cases.items()]
    files = (cache_folder() / "template").glob(f"*-{makehuman.version()}-{CACHE_FORMAT}.npz")
    rows.append(["cache on the disk", f"{sum(file.stat().st_size for file in files) / 1e6:.0f} MB", GOAL_SIZE])
    print(table("Template", ["", "measured", "goal"], rows))


def variance() -> None:
    """Print how much of the sampled bodies' variance the first components of the space of shapes hold."""
    held = load_body_space().variance_held
    rest = (held - held[0]) / (1 - held[0])
    rows = [[f"{n}", f"{100 * held[n - 1]:.2f} %", f"{100 * rest[n - 1]:.1f} %"] for n in COMPARED_COMPONENT_COUNTS]
    print(table("Variance that the space of shapes holds", ["components", "of all", "of what is not size"], rows))
    print("\nThe first component is size, from children to tall adults.")


def _least(work: Callable[[], object]) -> float:
    """Seconds."""
    taken = []
    for _ in range(REPEAT_COUNT + 1):
        started = time.perf_counter()
        work()
        taken.append(time.perf_counter() - started)
    return min(taken[1:])


if __name__ == "__main__":
    print(machine())
    speed()
    variance()
