"""A painted sphere filmed from around becomes a cloud of its surface."""

from dataclasses import replace

import numpy as np
import pytest
from textured_sphere import CENTRE, RADIUS, picture, ring, seen_depth

from engine.avatar.capture.captured_view import CapturedView
from engine.avatar.capture.dense import DenseCloud, dense_cloud
from engine.errors import InputError
from engine.geometry.camera import Camera
from engine.geometry.registration.rigid import Similarity

CAMERAS = [*ring(14), *ring(10, height=1.2, first=0.2)]
SWAY = Similarity(np.eye(3), np.array([0.004, 0.003, 0.0]))
SWAYED = 3


def seen(camera: Camera) -> CapturedView:
    grey = picture(camera)
    image = np.stack([grey, grey * 0.5, grey * 0.25], axis=-1).astype(np.uint8)
    return CapturedView(image, seen_depth(camera) > 0, camera)


@pytest.fixture(scope="module")
def made() -> DenseCloud:
    """In one view the sphere had swayed: its camera is told as if the sphere stood still."""
    views = [seen(camera) for camera in CAMERAS]
    views[SWAYED] = replace(views[SWAYED], camera=CAMERAS[SWAYED].moved(SWAY))
    return dense_cloud(views)


def test_points_lie_on_the_sphere_and_all_over_what_was_seen(made: DenseCloud) -> None:
    away = made.cloud.points - CENTRE
    distance = np.linalg.norm(away, axis=1)
    assert np.abs(distance - RADIUS).mean() < 0.003  # a pixel is 6 mm wide
    assert np.quantile(np.abs(distance - RADIUS), 0.99) < 0.012
    assert np.median((away * made.cloud.normals).sum(axis=1) / distance) > np.cos(np.radians(8))
    for angle in np.arange(0, 2 * np.pi, 0.3):
        place = CENTRE + RADIUS * np.array([np.sin(angle), 0.0, np.cos(angle)])
        assert np.linalg.norm(made.cloud.points - place, axis=1).min() < 0.008


def test_points_have_the_pictures_colours_and_the_number_of_views_that_saw_them(made: DenseCloud) -> None:
    red, green, blue = made.cloud.colours.T.astype(int)
    assert np.abs(red // 2 - green).max() <= 1
    assert np.abs(red // 4 - blue).max() <= 1
    assert made.support[made.support > 0].min() >= 3
    assert (made.support > 0).mean() > 0.9
    assert len(made.support) == len(made.cloud)


def test_a_view_that_swayed_is_laid_on_the_others(made: DenseCloud) -> None:
    def centre(camera: Camera) -> np.ndarray:
        return camera.rotation @ CENTRE + camera.translation  # of turns about it a sphere does not tell

    left = centre(made.cameras[SWAYED]) - centre(CAMERAS[SWAYED])
    assert np.linalg.norm(left) < 0.65 * np.linalg.norm(SWAY.shift)  # what others measured against it sways, too


def test_silhouettes_that_share_nothing_are_refused() -> None:
    views = [replace(seen(camera), figure=np.zeros(camera.size, bool)) for camera in ring(5)]
    with pytest.raises(InputError) as refusal:
        dense_cloud(views)
    assert refusal.value.code == "person_not_measured"


def test_the_lens_is_taken_out_of_a_view_and_kept_in_its_camera() -> None:
    camera = replace(CAMERAS[0], distortion=(-0.2, 0.05, 0.0, 0.0))
    y, x = np.indices(camera.size, np.float64)
    bent = CapturedView(np.stack([x, y, x], -1).astype(np.uint8), np.ones(camera.size, bool), camera)
    straight = bent.undistorted()
    assert straight.camera.distortion == ()
    point = camera.unproject(np.array([30.0, 45.0]), 2.0)
    column, row = straight.camera.project(point)[:2]
    shown = straight.image[round(float(row)), round(float(column))]
    assert np.abs(shown[:2] - np.array([30.0, 45.0])).max() <= 1.5


def test_grey_levels_are_finer_than_those_of_pictures() -> None:
    image = np.array([[[20, 20, 20], [21, 20, 20], [20, 21, 20], [20, 20, 21]]], np.uint8)
    camera = Camera((0.0, 0.0, 0.0), 100.0, (1.5, 0.0), (1, 4))
    grey = CapturedView(image, np.ones((1, 4), np.bool_), camera).grey
    np.testing.assert_allclose(grey[0] - 20, [0, 0.299, 0.587, 0.114], atol=1e-3)
