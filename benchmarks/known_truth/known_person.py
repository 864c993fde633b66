"""People whose every point is known, drawn into photographs: the truth that characters are held against."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.geometry.camera import Camera
from engine.geometry.mesh.surface import vertex_normals
from engine.render.lighting.film import box_downsample
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import Raster, rasterise

PICTURE_SUPERSAMPLING = 3
PERSON_PICTURE_SIZE = (960, 720)
"""(height, width) of the pictures."""
FOCAL_LENGTH_PICTURE_HEIGHTS = 1.6
"""Focal length in picture heights. What is measured assumes another one, as it must with any photograph."""
PERSON_PICTURE_SHARE = 0.8
"""Share of the picture's height that the person takes, and at most of its width."""
EYE_HEIGHT_METRES = 1.3
"""Metres of the level camera above the ground, for somebody of 1.8 m."""
TELEPHONE_FOCAL_LENGTH_PICTURE_HEIGHTS, TELEPHONE_HEIGHT_METRES = 1.0, 1.5
"""Of a telephone: the focal length in picture heights, and metres above the ground, for somebody of 1.8 m."""
SUN_DIRECTION, AMBIENT_SHARE = np.array([0.35, 0.6, 0.72]), 0.5
GROUND_CONTACT_SHADE_SHARE = 0.45
"""Share of the light that is missing on the ground beneath the feet."""


@dataclass(frozen=True)
class Person:
    """vertices : (V, 3) metres, y up, facing +z, standing on y = 0.
    triangles : (T, 3), counter-clockwise from outside.
    height : metres, when standing upright.
    paint : what gives a raster of these triangles its colours (H, W, 3), 0 to 255.
    joints : (J, 3) of the template's rig, where they are known.
    """

    name: str
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    height: float
    paint: Callable[[Raster], NDArray[np.float32]]
    joints: NDArray[np.float64] | None = None

    def turned(self, degrees: float) -> Person:
        """This person turned about the vertical, to their left."""
        turn = Rotation.from_euler("y", degrees, degrees=True).as_matrix()
        joints = None if self.joints is None else self.joints @ turn.T
        name = f"{self.name} {degrees:+.0f}°" if degrees else self.name
        return Person(name, self.vertices @ turn.T, self.triangles, self.height, self.paint, joints)


@dataclass(frozen=True)
class KnownPicture:
    """`rgb` (H, W, 3) uint8 shows `person`, whose coverage is `alpha` (H, W) float32, as `camera` sees them."""

    rgb: NDArray[np.uint8]
    alpha: NDArray[np.float32]
    camera: Camera
    person: Person


def level_camera(person: Person, size: tuple[int, int]) -> Camera:
    """A level camera, as far away as the person fills `PERSON_PICTURE_SHARE` of a picture of `size` (height, width)."""
    height, width = size
    focal = FOCAL_LENGTH_PICTURE_HEIGHTS * height
    distance = _distance(person, focal, size)
    eye = (_middle(person), EYE_HEIGHT_METRES * person.height / 1.8, distance)
    # level, so that upright lines stay upright: the picture is shifted, not the camera tilted
    centre = ((width - 1) / 2, (height - 1) / 2 + focal / distance * (person.height / 2 - eye[1]))
    return Camera(eye, focal, centre, size)


def telephone_camera(person: Person, size: tuple[int, int]) -> Camera:
    """A telephone held before the eyes of somebody near by, and tilted down so that the person is in the picture's middle."""
    height, width = size
    focal = TELEPHONE_FOCAL_LENGTH_PICTURE_HEIGHTS * height
    middle = _middle(person)
    eye = (middle, TELEPHONE_HEIGHT_METRES * person.height / 1.8, _distance(person, focal, size))
    plain = Camera((0, 0, 0), focal, ((width - 1) / 2, (height - 1) / 2), size)
    return plain.aimed(np.array(eye), np.array([middle, person.height / 2, 0.0]))


def _distance(person: Person, focal: float, size: tuple[int, int]) -> float:
    height, width = size
    return focal * max(person.height / height, float(np.ptp(person.vertices[:, 0])) / width) / PERSON_PICTURE_SHARE


def _middle(person: Person) -> float:
    return float(person.vertices[:, 0].min() + person.vertices[:, 0].max()) / 2


def draw_into(
    person: Person, background: NDArray[np.uint8], shadow: bool = True, camera: Camera | None = None
) -> KnownPicture:
    """Draw a person standing in a photograph (H, W, 3), antialiased, with a soft shadow at the feet unless there is one; as
    `level_camera` sees them, or another."""
    height, width = background.shape[:2]
    camera = camera or level_camera(person, (height, width))
    large = camera.scaled(PICTURE_SUPERSAMPLING)
    raster = rasterise(large.project(person.vertices), person.triangles, large.size, perspective=True)
    covered = raster.triangle >= 0
    normals = interpolate(vertex_normals(person.vertices, person.triangles), person.triangles, raster)
    lamp = np.abs(
        normals @ (SUN_DIRECTION / np.linalg.norm(SUN_DIRECTION)).astype(np.float32)
    )  # cloth is a single sheet at times
    shaded = person.paint(raster) * (AMBIENT_SHARE + (1 - AMBIENT_SHARE) * lamp[..., None])
    alpha = box_downsample(covered.astype(np.float32)[..., None], PICTURE_SUPERSAMPLING)[..., 0]
    premultiplied = box_downsample(
        np.asarray(np.where(covered[..., None], shaded, 0), np.float32), PICTURE_SUPERSAMPLING
    )
    behind = background * _shadow(person, camera)[..., None] if shadow else background
    picture = premultiplied + (1 - alpha[..., None]) * behind
    return KnownPicture(np.clip(picture + 0.5, 0, 255).astype(np.uint8), alpha.astype(np.float32), camera, person)


def _shadow(person: Person, camera: Camera) -> NDArray[np.float64]:
    """(H, W) by what the ground is multiplied: darker in an ellipse around the feet."""
    low = person.vertices[person.vertices[:, 1] < 0.06 * person.height]
    feet = camera.project(low)
    x, y = (feet[:, k].mean() for k in range(2))
    across = 0.7 * np.ptp(feet[:, 0]) + 8
    rows, columns = np.mgrid[: camera.size[0], : camera.size[1]]
    away = ((columns - x) / across) ** 2 + ((rows - y) / (0.25 * across)) ** 2
    return np.asarray(1 - GROUND_CONTACT_SHADE_SHARE * np.exp(-(away**2)))
