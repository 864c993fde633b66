"""What is shown on the way: the shape stands in the cloud, the small texture looks like the large one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image
from template_avatar import fitted_template

from engine.avatar.interim_previews import write_fitted_shape, write_small_texture
from engine.avatar.options import MAX_TEMPLATE_TRIANGLES
from engine.body.template import load_template


def test_the_shape_is_the_template_where_it_was_fitted(tmp_path: Path) -> None:
    template, fitted = load_template(), fitted_template()
    moved = replace(fitted, vertices=fitted.vertices + np.array([0.5, 0, 0]))
    shape = trimesh.load(write_fitted_shape(tmp_path, template, moved), process=False)
    assert len(shape.faces) == MAX_TEMPLATE_TRIANGLES and shape.volume > 0
    body = moved.vertices[template.vertices_of("body")]
    assert np.abs(shape.bounds - [body.min(0), body.max(0)]).max() < 1e-5
    assert (tmp_path / "fitted.ply").stat().st_size < 700_000


def test_the_small_texture_is_the_large_one(tmp_path: Path) -> None:
    ramp = np.linspace(0, 255, 1280).astype(np.uint8)
    texture = np.stack(np.broadcast_arrays(ramp[None, :], ramp[:, None], np.uint8(90)), axis=2)
    path = write_small_texture(tmp_path, texture, True)
    small = np.asarray(Image.open(path)).astype(int)
    assert small.shape == (640, 640, 3)
    assert np.abs(small - texture[::2, ::2]).mean() < 3
