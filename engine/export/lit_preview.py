"""A lit, shadowed preview of a character by `pyrender`, where OpenGL can be had without a screen (EGL or OSMesa).

Nothing else needs it: the project's own rasteriser (`engine.render.scene.character`) draws unlit pictures everywhere.
"""

from __future__ import annotations

import ctypes
import os
from types import ModuleType, TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.render.scene.character import DrawnCharacter

NEAR_PLANE_METRES, FAR_PLANE_METRES = 0.05, 100.0
"""Metres from the camera between which things are seen."""

PLATFORM_LIBRARIES = {"egl": ("libEGL.so.1",), "osmesa": ("libOSMesa.so.8", "libOSMesa.so.6")}
"""PyOpenGL's ways to draw without a screen, and a library of which each takes one. They are loaded by name: what looks for
libraries starts programs, and a job may start none."""

KEY_LIGHT_STRENGTH = 4.0
"""Strength of the light from above the camera's left, which casts shadows."""
FILL_LIGHT_STRENGTH = 1.5
"""Strength of the light from the opposite side."""


class LitPreview:
    """Draws a character lit; a context manager that holds an OpenGL context, to be used from one thread.

    Raises
    ------
    InputError : `gl_unavailable`, where there is no OpenGL without a screen.
    """

    def __init__(self, mesh: SkinnedMesh, size: tuple[int, int]):
        """`size` (height, width) of the pictures."""
        self._gl = _load()
        self._mesh = mesh
        self._size = size
        # four bytes to a pixel: OpenGL begins each row at a multiple of four, and pyrender does not
        texture = np.pad(mesh.texture, ((0, 0), (0, 0), (0, 1)), constant_values=255)
        self._material = self._gl.MetallicRoughnessMaterial(
            baseColorTexture=self._gl.Texture(source=texture, source_channels="RGBA"),
            metallicFactor=0.0,
            roughnessFactor=0.8,
        )
        try:
            self._renderer: Any = self._gl.OffscreenRenderer(size[1], size[0])
        except Exception as error:  # whatever the driver raises: there are as many kinds as drivers
            raise _unavailable() from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._renderer.delete()

    def draw(
        self, posed: NDArray[np.float32], camera: Camera, background: NDArray[np.uint8] | None = None
    ) -> DrawnCharacter:
        """The character as its vertices `posed` (V, 3) stand, as `engine.render.scene.character.draw_character` gives it.

        Light falls from above the camera's left, whichever way the camera looks.
        """
        if camera.size != self._size:
            raise ValueError(f"a camera of {camera.size} for pictures of {self._size}")
        gl = self._gl
        axes = np.array(camera.axes)
        view = np.eye(4)
        view[:3, :3], view[:3, 3] = axes.T, camera.eye
        scene = gl.Scene(bg_color=[0.0, 0.0, 0.0, 0.0], ambient_light=[0.35, 0.35, 0.35])
        primitive = gl.Primitive(
            positions=posed,
            normals=vertex_normals(posed, self._mesh.triangles),
            # pyrender's textures begin at the lower left corner
            texcoord_0=np.stack([self._mesh.uv[:, 0], 1 - self._mesh.uv[:, 1]], 1),
            indices=self._mesh.triangles,
            material=self._material,
        )
        scene.add(gl.Mesh([primitive]))
        lens = gl.IntrinsicsCamera(
            camera.focal,
            camera.focal * camera.aspect,
            camera.centre[0] + 0.5,  # OpenGL's pixels have their centres at halves
            camera.centre[1] + 0.5,
            znear=NEAR_PLANE_METRES,
            zfar=FAR_PLANE_METRES,
        )
        scene.add(lens, pose=view)
        middle = posed.mean(0)
        scene.add(gl.DirectionalLight(intensity=KEY_LIGHT_STRENGTH), pose=_aimed(axes, (-0.6, 0.9, 0.8), middle))
        scene.add(gl.DirectionalLight(intensity=FILL_LIGHT_STRENGTH), pose=_aimed(axes, (0.9, 0.2, 0.5), middle))
        flags = gl.RenderFlags.RGBA | gl.RenderFlags.SHADOWS_DIRECTIONAL
        try:
            rgba, _ = self._renderer.render(scene, flags=flags)
        except Exception as error:  # OpenGL's own, where a driver lacks what shadows take
            raise _unavailable() from error
        return _composed(np.asarray(rgba), background)


def _aimed(axes: NDArray[np.float64], towards: tuple[float, float, float], middle: NDArray[np.float32]) -> NDArray:
    """The pose (4, 4) of a light that stands `towards` (in the camera's axes) of the middle and shines at it."""
    back = np.array(towards) @ axes
    back /= np.linalg.norm(back)
    right = np.cross(axes[1], back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(back, right), back], 1)
    pose[:3, 3] = middle + 3 * back
    return pose


def _composed(rgba: NDArray[np.uint8], background: NDArray[np.uint8] | None) -> DrawnCharacter:
    """The renderer's picture, whose colours at edges are mixed with black, as a `DrawnCharacter`."""
    alpha = rgba[..., 3].astype(np.float32) / np.float32(255)
    rgb = rgba[..., :3].astype(np.float32)
    if background is None:
        rgb /= np.maximum(alpha, 1 / 255)[..., None]
    else:
        rgb += (1 - alpha[..., None]) * background
    return DrawnCharacter(np.clip(np.rint(rgb), 0, 255).astype(np.uint8), alpha)


def _load() -> ModuleType:
    """`pyrender`, told where its OpenGL is; which has to happen before its first import."""
    os.environ.setdefault("PYGLET_HEADLESS", "1")
    if "PYOPENGL_PLATFORM" not in os.environ:
        platform = next((name for name, libraries in PLATFORM_LIBRARIES.items() if any(map(_loads, libraries))), None)
        if platform is None:
            raise _unavailable()
        os.environ["PYOPENGL_PLATFORM"] = platform
    if not hasattr(np, "infty"):  # numpy 2 took it away, pyrender 0.1.45 asks for it
        np.infty = np.inf  # type: ignore[attr-defined]
    try:
        import pyrender
    except Exception as error:  # PyOpenGL fails in many ways where a library is missing
        raise _unavailable() from error
    return pyrender


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _unavailable() -> InputError:
    return InputError(
        "gl_unavailable",
        "There is no OpenGL without a screen on this machine: install Mesa's EGL or OSMesa, or do without lit previews.",
    )
