"""Targets that are stored come back as they were, and all that is stored of the template stays small."""

from __future__ import annotations

import numpy as np

from engine.body import load_shape_space, load_template
from engine.body.body_space import load_body_space
from engine.body.cache import cache_folder
from engine.body.rig import HUMAN_RIG
from engine.body.targets import compact, expand, gather
from engine.body.template import load_rig

MEGABYTES = 40


def test_stored_targets_are_the_same() -> None:
    random = np.random.default_rng(4)
    fields = {
        f"target-{k}": (np.sort(random.choice(50_000, size, replace=False)), random.uniform(-1, 1, (size, 3)))
        for k, size in enumerate((1, 700, 40_000))
    } | {"all": (np.arange(50_000), random.uniform(-3, 3, (50_000, 3)))}
    targets = gather(fields, 50_000)
    back = expand(compact(targets), 50_000)
    assert back.names == targets.names
    for part in ("starts", "moved", "counts"):
        np.testing.assert_array_equal(getattr(back, part), getattr(targets, part))
        assert getattr(back, part).dtype == getattr(targets, part).dtype


def test_the_converted_template_is_small() -> None:
    load_template(), load_rig(HUMAN_RIG), load_body_space(), load_shape_space()
    newest: dict[str, int] = {}
    for file in sorted((cache_folder() / "template").glob("*.npz"), key=lambda file: file.stat().st_mtime):
        newest[file.name.rsplit("-", 2)[0]] = file.stat().st_size
    assert {"mesh", f"rig-{HUMAN_RIG}", "bodies", "shape"} <= set(newest)
    assert sum(newest.values()) < MEGABYTES * 1e6
