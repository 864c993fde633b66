"""Colour errors of which the size is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.scan_studio.comparison.colour import cielab, film_colour_error
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.scenery.drawing import TexturedMesh, textured_mesh
from benchmarks.scan_studio.scenery.room import Room
from benchmarks.scan_studio.scenery.scene import Scene
from engine.geometry.camera import Camera

CAMERAS = [
    Camera((0, 0, 0), 120, (47.5, 79.5), (160, 96)).aimed(eye, (0, 0.9, 0)) for eye in ((0, 1.2, 2), (-1.9, 1, 0.4))
]


def painted(egg: Subject, grey: int) -> Subject:
    return replace(egg, texture=np.full((32, 32, 3), grey, np.uint8))


def mesh_of(subject: Subject) -> TexturedMesh:
    return textured_mesh(subject.triangles, subject.uv, subject.uv_triangles, subject.shade, subject.texture)


@pytest.fixture(scope="module")
def frames(egg: Subject, plain_room: Room) -> list[NDArray[np.uint8]]:
    """A grey egg in the room."""
    scene = Scene(plain_room, painted(egg, 100))
    return [scene.draw(camera, egg.vertices) for camera in CAMERAS]


def test_known_colours_have_their_places_in_cielab() -> None:
    found = cielab(np.array([[255, 255, 255], [0, 0, 0], [255, 0, 0]], np.uint8))
    np.testing.assert_allclose(found, [[100.0, 0.0, 0.0], [0.0, 0.0, 0.0], [53.24, 80.09, 67.20]], atol=0.15)


def test_the_true_avatar_has_no_error(frames: list[NDArray[np.uint8]], egg: Subject) -> None:
    error = film_colour_error(mesh_of(painted(egg, 100)), [egg.vertices] * 2, frames, CAMERAS)
    assert error.rmse == 0
    assert (error.frames == 0).all()


def test_a_lighter_grey_is_off_by_the_difference_in_lightness(frames: list[NDArray[np.uint8]], egg: Subject) -> None:
    error = film_colour_error(mesh_of(painted(egg, 120)), [egg.vertices] * 2, frames, CAMERAS)

    def lightness(grey: int) -> float:
        light = ((grey / 255 + 0.055) / 1.055) ** 2.4
        return float(116 * np.cbrt(light) - 16)

    assert error.rmse == pytest.approx(lightness(120) - lightness(100), abs=0.02)


def test_who_stands_elsewhere_is_compared_with_the_room(frames: list[NDArray[np.uint8]], egg: Subject) -> None:
    aside = egg.vertices + np.array([0, 0, 0.3])  # towards the first camera, and aside for the second
    error = film_colour_error(mesh_of(painted(egg, 100)), [aside] * 2, frames, CAMERAS)
    assert error.frames[1] > 10


def test_known_gains_of_the_exposure_do_not_count(frames: list[NDArray[np.uint8]], egg: Subject) -> None:
    light = ((np.array([88, 100, 113]) / 255 + 0.055) / 1.055) ** 2.4
    gains = np.array([light / light[1]] * 2)
    tinted = [frame.copy() for frame in frames]
    for frame in tinted:
        frame[(frame == 100).all(-1)] = (88, 100, 113)
    error = film_colour_error(mesh_of(painted(egg, 100)), [egg.vertices] * 2, tinted, CAMERAS, gains)
    assert error.rmse < 0.3
    assert film_colour_error(mesh_of(painted(egg, 100)), [egg.vertices] * 2, tinted, CAMERAS).rmse > 5


def test_an_avatar_that_is_never_seen_is_refused(frames: list[NDArray[np.uint8]], egg: Subject) -> None:
    with pytest.raises(ValueError, match="no frame shows"):
        film_colour_error(mesh_of(egg), [egg.vertices + np.array([0, 50, 0])] * 2, frames, CAMERAS)
