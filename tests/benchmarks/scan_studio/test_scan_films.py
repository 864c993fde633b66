"""A film shows what its truth says: who stands where, how bright, and which way is up."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.scan_studio.camera.developing import hlg_code
from benchmarks.scan_studio.camera.sensor import Sensor
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.studio import Order, film
from benchmarks.scan_studio.truth import read_truth
from engine.media.colour_conversion.tone_mapping import hlg_scene_light
from engine.media.video import probe_video, read_video
from engine.render.rasterisation.rasteriser import rasterise

SIZE = (96, 160)


@pytest.fixture(scope="module")
def folder(egg: Subject, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Films of the egg, which sways by 3 cm."""
    out = tmp_path_factory.mktemp("scan") / "egg"
    film(egg, Order({"body": 8, "head": 5}, SIZE, sway=0.03), out)
    return out


def magenta(rgb: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Where the egg is seen: nothing else in the room has this colour."""
    red, green, blue = (rgb[..., k].astype(int) for k in range(3))
    return np.asarray(np.minimum(red, blue) - green > 127)


def overlaps(folder: Path, name: str, swaying: bool) -> list[float]:
    """Of what each frame shows of the egg with the projected mesh, as it sways or at rest: intersection over union."""
    truth, found = read_truth(folder), []
    frames = [magenta(frame.rgb) for frame in read_video(folder / f"{name}.mp4")]
    for number, (camera, seen) in enumerate(zip(truth.films[name].cameras, frames, strict=True)):
        vertices = truth.vertices(name, number) if swaying else truth.subject.vertices
        known = (
            rasterise(camera.project(vertices), truth.subject.triangles, camera.size, perspective=True).triangle >= 0
        )
        found.append(float((known & seen).sum() / (known | seen).sum()))
    return found


@pytest.mark.parametrize("name", ["body", "head"])
def test_the_truth_projects_the_mesh_where_the_film_shows_it(folder: Path, name: str) -> None:
    assert min(overlaps(folder, name, swaying=True)) > 0.95


def test_without_the_sway_the_mesh_would_be_seen_elsewhere(folder: Path) -> None:
    assert min(overlaps(folder, "body", swaying=False)) < 0.93


def test_a_film_lies_in_its_file_and_is_read_upright(folder: Path) -> None:
    shown = probe_video(folder / "body.mp4")
    assert (shown.width, shown.height) == SIZE
    assert shown.frames == 8
    head = next(iter(read_video(folder / "head.mp4"))).rgb
    assert magenta(head)[-1].any()  # the body goes on below
    assert not magenta(head)[0].any()


def test_the_cameras_of_the_person_see_the_body_at_rest_as_the_film_shows_it(folder: Path) -> None:
    truth = read_truth(folder)
    trunk = sum(arm.weights for arm in truth.subject.arms) == 0
    for number, camera in enumerate(truth.films["body"].cameras):
        in_the_room = camera.project(truth.vertices("body", number)[trunk], np.float64)
        at_rest = truth.person_camera("body", number).project(truth.subject.vertices[trunk], np.float64)
        np.testing.assert_allclose(at_rest, in_the_room, atol=1e-6)


def test_what_is_written_is_read_again(folder: Path, egg: Subject) -> None:
    truth = read_truth(folder)
    np.testing.assert_array_equal(truth.subject.vertices, egg.vertices)
    np.testing.assert_array_equal(truth.subject.texture, egg.texture)
    np.testing.assert_array_equal(truth.subject.arms[1].weights, egg.arms[1].weights)
    np.testing.assert_array_equal(truth.subject.joints["Head"], egg.joints["Head"])
    assert truth.made == {
        "format": "h264",
        "conditions": "good",
        "sway": 0.03,
        "seed": 0,
        "frames": {"body": 8, "head": 5},
    }
    assert json.loads((folder / "truth.json").read_text())["height"] == pytest.approx(1.8)


def test_a_film_of_high_dynamic_range_shows_the_same_picture(folder: Path, egg: Subject, tmp_path: Path) -> None:
    film(egg, Order({"body": 8, "head": 0}, SIZE, "hlg", sway=0.03), tmp_path)
    told = probe_video(tmp_path / "body.mp4")
    assert (told.codec, told.hdr) == ("hevc", "hlg")
    assert not (tmp_path / "head.mp4").exists()
    wide, usual = (next(iter(read_video(path / "body.mp4"))).rgb.astype(int) for path in (tmp_path, folder))
    below_the_knee = usual.max(-1) < 150  # what is brighter is rolled off when it is read
    assert below_the_knee.mean() > 0.3
    assert np.median(np.abs(wide - usual)[below_the_knee]) <= 4
    assert np.abs((wide - usual)[below_the_knee].mean(0)).max() < 3


def test_light_of_hlg_code_values_is_what_they_were_made_of() -> None:
    light = np.linspace(0, 1, 101)
    np.testing.assert_allclose(hlg_scene_light(hlg_code(light)), light, atol=1e-6)


def test_the_sensor_reads_light_with_its_gain_and_its_noise() -> None:
    sensor = Sensor(80, 3)
    light = np.full((200, 200, 3), 0.3, np.float32)
    gains = sensor.gains(np.array([12.0]))[0]
    values = sensor.read(light, gains, 4)
    np.testing.assert_allclose(values.mean((0, 1)), 0.3 * gains, rtol=2e-3)
    spread = np.sqrt(2.5e-4 * 0.3 * gains + 1.2e-3**2)
    np.testing.assert_allclose(values.std((0, 1)), spread, rtol=0.03)
    assert (sensor.read(light, gains, 4) == sensor.read(light, gains, 4)).all()
    assert (sensor.read(light, gains, 4) != sensor.read(light, gains, 5)).any()
