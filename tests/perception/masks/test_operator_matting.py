"""The operator's own ONNX model, on a model that is written here."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest
from tiny_onnx import brightness_model

from engine.face_animation.target_face import TargetFace
from engine.face_animation.warping.layers import separate_layers
from engine.perception.masks.matting_network import load_matting_model, matting_model
from engine.perception.masks.person import DOUBTFUL_BELIEF, person_mask
from engine.perception.models import MATTING_SETTING, ModelError, ModelFile


def settings_for(path: Path, **more: str) -> dict[str, str]:
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    named = {MATTING_SETTING: str(path), f"{MATTING_SETTING}_SHA256": digest, f"{MATTING_SETTING}_LICENCE": "MIT"}
    return named | {f"{MATTING_SETTING}_{name}": value for name, value in more.items()}


def disk_picture() -> tuple[np.ndarray, np.ndarray]:
    """A white disk on black (96, 128, 3), and its mask."""
    ys, xs = np.mgrid[:96, :128]
    disk = (xs - 70) ** 2 + (ys - 40) ** 2 < 25**2
    return np.repeat(disk[..., None] * np.uint8(255), 3, axis=2), disk


def test_no_setting_means_no_model() -> None:
    assert matting_model({}) is None


def test_model_takes_the_place_of_the_networks(tmp_path: Path) -> None:
    model = matting_model(settings_for(brightness_model(tmp_path / "bright.onnx"), SIZE="64"))
    assert model is not None
    assert model.file.licence == "MIT"
    assert model.size == (64, 64)
    rgb, disk = disk_picture()
    mask = person_mask(rgb, model=model)
    assert mask.shape == disk.shape
    assert mask.dtype == np.float32
    wrong = (mask > 0.5) != disk
    assert wrong.mean() < 0.002  # half of the picture's resolution, and yet the edge is the picture's own


def test_what_the_model_leaves_out_of_the_known_is_found_without_it(tmp_path: Path) -> None:
    """A disk, and a dark arm that the model does not see: once the arm is known it is cut along its edge. What is known of
    the disk alone changes nothing."""
    model = matting_model(settings_for(brightness_model(tmp_path / "bright.onnx"), SIZE="128"))
    ys, xs = np.mgrid[:200, :240]
    disk = np.hypot(xs - 80, ys - 100) < 50
    arm = (np.abs(ys - 100) < 12) & (xs >= 110) & (xs < 210) & ~disk
    rgb = np.select([disk[..., None], arm[..., None]], [(255, 255, 255), (150, 40, 30)], (20, 22, 25)).astype(np.uint8)
    alone = person_mask(rgb, model=model)
    seed = ((xs - 80) ** 2 + (ys - 100) ** 2 < 20**2).astype(np.float32)
    np.testing.assert_array_equal(person_mask(rgb, seed, model=model), alone)
    seed[80:120, 90:225] = DOUBTFUL_BELIEF
    seed[94:107, 90:205] = 1
    mask = person_mask(rgb, seed, model=model)
    assert alone[arm].max() < 0.5
    np.testing.assert_array_equal(mask > 0.5, disk | arm)


def test_shape_of_the_model_counts_more_than_the_setting(tmp_path: Path) -> None:
    model = matting_model(settings_for(brightness_model(tmp_path / "bright.onnx", side=32), SIZE="64"))
    assert model is not None
    assert model.size == (32, 32)


def test_colours_are_normalised(tmp_path: Path) -> None:
    model = matting_model(
        settings_for(brightness_model(tmp_path / "bright.onnx", side=32), MEAN="0.5", STD="0.25,0.25,0.25")
    )
    assert model is not None
    grey = np.full((32, 32, 3), 153, np.uint8)  # 0.6 -> (0.6 - 0.5) / 0.25 = 0.4
    np.testing.assert_allclose(model(grey), 0.4, atol=1e-5)


def test_hash_and_licence_are_needed(tmp_path: Path) -> None:
    settings = settings_for(brightness_model(tmp_path / "bright.onnx"))
    for missing in ("SHA256", "LICENCE"):
        with pytest.raises(ModelError, match="needs"):
            matting_model({name: value for name, value in settings.items() if not name.endswith(missing)})
    with pytest.raises(ModelError, match="SHA-256"):
        matting_model(settings | {f"{MATTING_SETTING}_SHA256": "0" * 64})


def test_what_cannot_be_run_is_refused_with_a_reason(tmp_path: Path) -> None:
    broken = tmp_path / "broken.onnx"
    broken.write_bytes(b"not a model")
    with pytest.raises(ModelError, match="no model that can be run"):
        matting_model(settings_for(broken))
    with pytest.raises(ModelError, match="cannot be read"):
        load_matting_model(ModelFile(tmp_path / "absent.onnx", "0" * 64, "MIT"))
    with pytest.raises(ModelError, match=r"\(1, 3, h, w\)"):
        matting_model(settings_for(brightness_model(tmp_path / "grey.onnx", channels=1)))


def test_portraits_are_cut_out_by_the_operator_s_model(tmp_path: Path) -> None:
    """The layer's alpha is what the model says of the picture, at its outline refined to the picture's edges."""
    rgb, disk = disk_picture()
    model = matting_model(settings_for(brightness_model(tmp_path / "bright.onnx", side=64)))
    assert model is not None
    mesh = np.repeat([[70.0, 40.0, 0.0]], 478, axis=0).astype(np.float32)
    target = TargetFace(rgb, None, mesh, np.zeros((1, 4), np.float32), (128, 96), np.eye(2, 3))
    alpha = separate_layers(target, model, model.file.sha256).person[..., 3]
    assert np.mean((alpha > 127) != disk) < 0.01
