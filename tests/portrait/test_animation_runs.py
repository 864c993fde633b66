"""Runs of the portrait system: what a second one takes over, how they end early, and the Python call."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import numpy as np
import pytest
from made_clip import OPENS, face, read_frames
from stored_stages import assert_taken, stored

import galatea
from engine.errors import Canceled, InputError
from engine.media.image import read_image
from engine.media.limits import Limits
from engine.perception.face.landmarks import fiducials
from engine.portrait import PortraitOptions
from engine.portrait.pipeline import animate_portrait
from engine.run import Progress, Run


def test_a_second_run_reuses_every_analysis_and_gives_the_same(animation, opens, woman, driver) -> None:
    again = animation(woman, driver, again=True, trim=OPENS, neutral_frame=0)
    assert set(again.run.reused) >= {"find_face", "separate_layers", "track_driver"}
    assert set(again.run.seconds) - set(again.run.reused) == {"animate"}, "all but the streamed one"
    apart = np.abs(np.array(opens.frames, int) - np.array(again.frames, int))
    # filters that threads share round differently now and then: one level before encoding, and less than two after it
    assert apart.mean() < 2 < np.abs(np.diff(np.array(opens.frames, int), axis=0)).max(), "grey levels"


@pytest.mark.parametrize(
    ("change", "redone"),
    [
        ({"strength": 0.5}, {"look_again"}),
        ({"head_3d": False}, {"look_again"}),
        ({"format": "png"}, set()),
        ({"crop": "face"}, {"find_face", "detail_region", "separate_layers", "rig_target", "look_again"}),
        ({"trim": (1.9, 2.3)}, {"track_driver", "register_driver", "ratio_images", "glance_at_driver", "look_again"}),
    ],
    ids=["strength", "head_3d", "format", "crop", "trim"],
)
def test_a_revision_redoes_only_what_follows(animation, opens, woman, driver, change, redone) -> None:
    revised = animation(woman, driver, **{"trim": OPENS, "neutral_frame": 0, **change})
    worked = set(revised.run.seconds) - set(revised.run.reused) - {"animate"}
    assert worked == redone & set(revised.run.seconds)


def test_three_lines_of_python(woman, driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Progress] = []
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    path = galatea.animate(
        woman, str(driver), tmp_path / "out", progress=seen.append, trim=(1.9, 2.1), strength=0.8
    ).path
    assert [left.name for left in tmp_path.iterdir()] == ["out"], "nothing is left behind"
    assert path == tmp_path / "out" / "animation.mp4"
    assert len(read_frames(path)) == 6
    fractions = [p.fraction for p in seen]
    assert fractions == sorted(fractions) and fractions[0] == 0
    assert [fraction for fraction in fractions if fraction == 1] == [fractions[-1]], "1 once, at the end"
    assert {p.stage for p in seen} >= {"find_face", "separate_layers", "track_driver", "animate"}


def test_a_folder_that_holds_another_animation_gives_the_new_one(woman, driver, tmp_path: Path) -> None:
    for format, name in (("webm", "animation.webm"), ("png", "animation.zip"), ("mp4", "animation.mp4")):
        made = galatea.animate(
            woman, driver, tmp_path / "out", cache=tmp_path / "cache", trim=(1.9, 2.0), format=format
        ).path
        assert made == tmp_path / "out" / name and made.is_file()
        assert json.loads((tmp_path / "out" / "report.json").read_text())["inputs"]["animation"] == name


def test_a_cache_folder_spares_the_second_call(woman, driver, tmp_path: Path) -> None:
    left = []
    for name in ("one", "two"):
        galatea.animate(woman, driver, tmp_path / name, cache=tmp_path / "cache", trim=(1.9, 2.1))
        left.append(stored(tmp_path / "cache"))
    stages = [json.loads((tmp_path / n / "report.json").read_text())["stages"] for n in ("one", "two")]
    assert set(stages[0]) == set(stages[1])
    assert len(left[0]) >= 4 and set(left[0]) == set(left[1]), "what was found, and nothing more by the second"
    assert_taken(*left)


def test_a_bad_choice_leaves_no_animation(woman, driver, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(InputError) as caught:
        galatea.animate(woman, driver, out, trim=(1.9, 2.1), neutral_frame=400)
    assert caught.value.code == "neutral_frame_out_of_range"
    assert not out.exists()


@pytest.mark.parametrize("stage", ["separate_layers", "track_driver", "animate"])
def test_a_canceled_run_stops_and_leaves_no_animation(woman, driver, tmp_path: Path, stage: str) -> None:
    reached: list[str] = []
    with (
        pytest.raises(Canceled),
        Run(on_progress=lambda p: reached.append(p.stage), canceled=lambda: stage in reached) as run,
    ):
        animate_portrait({"image": woman, "driver": driver}, PortraitOptions(trim=(1.9, 2.3)), tmp_path, run)
    assert reached[-1] == stage
    assert not [p for p in tmp_path.iterdir() if "animation" in p.name]


def test_limits_of_the_run_hold(woman, driver, tmp_path: Path) -> None:
    for limits, code in (
        (Limits(image_megapixels=0.01), "image_too_large"),
        (Limits(video_seconds=2), "video_too_long"),
    ):
        with pytest.raises(InputError) as caught, Run(limits=limits) as run:
            animate_portrait({"image": woman, "driver": driver}, PortraitOptions(), tmp_path, run)
        assert caught.value.code == code


def test_landmarks_are_in_the_original_picture_s_pixels(animation, small, driver) -> None:
    image = small("photo_woman_white.png", 300)
    made = animation(image, driver, trim=(1.9, 2.1), crop="face", size=(200, 200))
    document = json.loads((made.out / "landmarks.json").read_text())
    assert document["size"] == [300, 300] and len(document["landmarks"]) == 68
    found = fiducials(face(read_image(image).rgb))[:, :2]
    assert np.linalg.norm(np.array(document["landmarks"]) - found, axis=1).mean() < 1.0


def test_corrected_landmarks_are_used(animation, opens, woman, driver) -> None:
    """What `landmarks.json` says can be moved and given back: the face is then taken to be there."""
    document = json.loads((opens.out / "landmarks.json").read_text())
    moved = tuple((x + 8.0, y - 5.0) for x, y in document["landmarks"])
    made = animation(woman, driver, trim=(1.9, 2.1), landmarks=moved)
    again = json.loads((made.out / "landmarks.json").read_text())["landmarks"]
    assert np.abs(np.array(again) - np.array(moved)).mean() < 0.5
    assert "find_face" not in made.run.reused
