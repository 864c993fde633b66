"""A character's GLB keeps to its size, and the report says what that took."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from template_character import template_character

from engine.character.pipeline import MAX_GLB_BYTES, write_small_glb
from engine.errors import Canceled
from engine.export.gltf.glb import TEXTURE_REDUCTIONS
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.run import Run


def noisy(height: int, width: int) -> SkinnedMesh:
    noise = np.random.default_rng(7).integers(0, 256, (height, width, 3), np.uint8)
    return replace(template_character(texture_size=64), texture=noise)


@pytest.mark.parametrize(
    ("height", "width", "warned"),
    [
        (1024, 2048, None),
        (2048, 3072, "at JPEG quality 80"),
        (4096, 4096, "1/2 of its width and height, at JPEG quality 90"),
    ],
)
def test_a_texture_of_noise_is_made_to_fit(tmp_path: Path, height: int, width: int, warned: str | None) -> None:
    with Run() as run:
        write_small_glb(tmp_path / "character.glb", noisy(height, width), (), run)
    assert (tmp_path / "character.glb").stat().st_size <= MAX_GLB_BYTES
    assert [notice.code for notice in run.notices] == ["texture_reduced"] * (warned is not None)
    assert all(warned is not None and warned in notice.message for notice in run.notices)


def test_a_surface_that_is_too_large_by_itself_is_told_of(tmp_path: Path) -> None:
    mesh = template_character(texture_size=64)
    heavy = replace(mesh, triangles=np.tile(mesh.triangles, (80, 1)))
    with Run() as run:
        write_small_glb(tmp_path / "character.glb", heavy, (), run)
    assert (tmp_path / "character.glb").stat().st_size > MAX_GLB_BYTES
    assert [notice.code for notice in run.notices] == ["glb_too_large"]


def test_a_cancel_is_heard_before_each_try(tmp_path: Path) -> None:
    """Noise of 3072 x 2048 takes two of them: asked before the second, it ends."""
    heard = 2
    asked: list[None] = []

    def canceled() -> bool:
        asked.append(None)
        return len(asked) == heard

    with pytest.raises(Canceled), Run(canceled=canceled) as run:
        write_small_glb(tmp_path / "character.glb", noisy(2048, 3072), (), run)
    assert len(asked) == heard <= TEXTURE_REDUCTIONS.index((1, 80)) + 1
    assert not list(tmp_path.iterdir())
