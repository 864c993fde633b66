"""The lit preview against the project's own rasteriser: another renderer sees the same character."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from template_character import template_character, walk

from engine.export.lit_preview import LitPreview
from engine.geometry.camera import Camera
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms
from engine.render.scene.character import draw_character, prepare_character

SIZE = (480, 360)
CAMERA = Camera((0, 0, 0), 520, (175.0, 240.5), SIZE).aimed((1.4, 1.3, 2.6), (0, 0.85, 0.3))


def middle(alpha: np.ndarray) -> np.ndarray:
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    return np.array([(alpha * columns).sum(), (alpha * rows).sum()]) / alpha.sum()


def test_both_renderers_draw_the_same_silhouette(opengl: None) -> None:
    stripes = np.full((255, 255, 3), (80, 0, 170), np.uint8)  # of which a row is not a multiple of four bytes
    stripes[:, np.arange(255) // 17 % 2 == 1] = (200, 0, 50)
    mesh = replace(template_character(texture_size=64), texture=stripes)
    clip = walk(mesh.skeleton)
    transforms = pose_transforms(mesh.skeleton, clip.rotations[[7]], clip.root[[7]])[0]
    posed = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
    background = np.full((*SIZE, 3), (30, 60, 200), np.uint8)
    with LitPreview(mesh, SIZE) as preview:
        lit, alone = preview.draw(posed, CAMERA, background), preview.draw(posed, CAMERA)
    unlit = draw_character(prepare_character(mesh), posed, CAMERA, background)
    assert unlit.alpha.sum() > 5000
    assert np.minimum(unlit.alpha, lit.alpha).sum() / np.maximum(unlit.alpha, lit.alpha).sum() > 0.99
    assert np.hypot(*(middle(unlit.alpha) - middle(lit.alpha))) < 0.1  # half a pixel would be a convention mixed up
    assert unlit.alpha.sum() == pytest.approx(lit.alpha.sum(), rel=2e-3)
    np.testing.assert_array_equal(lit.rgb[lit.alpha == 0], background[lit.alpha == 0])
    # the same texture at the same places: only the light differs
    inside = (unlit.alpha == 1) & (lit.alpha == 1)
    hues = [rgb[inside][:, 2] / (1.0 + rgb[inside][:, 0]) for rgb in (unlit.rgb, alone.rgb)]
    assert np.corrcoef(*hues)[0, 1] > 0.9


def test_a_machine_without_gl_is_told_so() -> None:
    script = (
        "from engine.errors import InputError\n"
        "from engine.export import lit_preview\n"
        "lit_preview.PLATFORM_LIBRARIES = {'egl': ('libof_no_machine.so.1',)}\n"
        "try: lit_preview.LitPreview(None, (8, 8))\n"
        "except InputError as error: print(error.code)\n"
    )
    environment = {name: value for name, value in os.environ.items() if name != "PYOPENGL_PLATFORM"}
    root = Path(__file__).parents[2]
    run = subprocess.run(
        [sys.executable, "-c", script],
        cwd=root,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert run.stdout.strip() == "gl_unavailable"


def test_gl_is_not_loaded_before_it_is_asked_for() -> None:
    script = "import sys, engine.export.lit_preview; assert not {'pyrender', 'OpenGL', 'pyglet'} & {*sys.modules}"
    subprocess.run([sys.executable, "-c", script], cwd=Path(__file__).parents[2], check=True, timeout=60)
