"""An avatar of an earlier job acts anew, without clips of anybody."""

from __future__ import annotations

import json
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from glb_reader import Glb, validate
from made_clip import read_frames, write_frames
from made_motion import bvh
from template_avatar import template_avatar, write_template_avatar

from engine.avatar import KIND, AvatarOptions
from engine.avatar.acting import Scene, film
from engine.errors import InputError
from engine.media.video import read_video
from engine.motion.library import built_in
from engine.performances import video
from engine.run import Run

SMALL: dict[str, Any] = {"size": (96, 160), "fps": 5, "seconds": 1}


@pytest.fixture(scope="module")
def earlier(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("earlier")
    write_template_avatar(out, AvatarOptions())
    return out / "avatar.glb"


def animated(earlier: Path, out: Path, options: dict[str, Any], **inputs: Path) -> dict[str, Any]:
    """The report of a job."""
    out.mkdir()
    with Run() as run:
        KIND.work({"avatar": earlier, **inputs}, AvatarOptions.model_validate({**SMALL, **options}), out, run)
    return json.loads((out / "report.json").read_text())


def test_it_does_a_motion_as_it_would_have_done_at_first(earlier: Path, tmp_path: Path) -> None:
    report = animated(earlier, tmp_path / "out", {"motion": "bow"})
    assert report["kind"] == "avatar" and "choose_frames" not in report["stages"]
    made = template_avatar()
    clip = built_in("bow", made.mesh.skeleton, 5)
    first = list(islice(film(made.mesh, made.morphs, Scene(clip), SMALL["size"]), 5))
    shown = read_frames(tmp_path / "out/animation.mp4")
    assert len(shown) == 5
    assert max(np.abs(a.astype(int) - b).mean() for a, b in zip(first, shown, strict=True)) < 3
    assert (tmp_path / "out/poster.jpg").stat().st_size > 1000 < (tmp_path / "out/thumbnail.jpg").stat().st_size
    assert not (tmp_path / "out/points.ply").exists(), "nothing was measured"


def test_its_file_holds_the_new_clip_and_all_that_it_had(earlier: Path, tmp_path: Path) -> None:
    (tmp_path / "arms.bvh").write_bytes(bvh())
    animated(earlier, tmp_path / "out", {"vrm": True}, motion=tmp_path / "arms.bvh")
    before, after = Glb(earlier), Glb(tmp_path / "out/avatar.glb")
    assert [one["severity"] for one in validate(tmp_path / "out/avatar.glb")["messages"] if one["severity"] == 0] == []
    assert after.json["animations"][0]["name"] == "motion"
    assert {one["name"] for one in before.json["animations"]} <= {one["name"] for one in after.json["animations"]}
    assert np.array_equal(before.attribute("POSITION"), after.attribute("POSITION"))
    assert before.json["meshes"][0]["extras"] == after.json["meshes"][0]["extras"]
    assert (tmp_path / "out/avatar.vrm").exists()


def test_its_face_follows_a_driver(earlier: Path, tmp_path: Path) -> None:
    frames = [frame.rgb for frame in islice(read_video(video("happy")), 4)]
    driver = write_frames(tmp_path / "driver.mp4", frames, fps=5)
    report = animated(earlier, tmp_path / "out", {}, driver=driver)
    assert {"capture_face", "animate"} <= set(report["stages"])
    glb = Glb(tmp_path / "out/avatar.glb")
    assert any(one["target"]["path"] == "weights" for one in glb.animation("driver")["channels"])


def test_it_may_be_made_smaller(earlier: Path, tmp_path: Path) -> None:
    report = animated(earlier, tmp_path / "out", {"triangles": 6000, "levels": 1})
    assert report["quality"]["triangles"] <= 6000
    glb = Glb(tmp_path / "out/avatar.glb")
    assert len(glb.triangles(1)) <= 1500
    assert len(glb.json["meshes"][0]["extras"]["targetNames"]) == len(template_avatar(64).morphs)


def test_what_is_of_clips_does_not_go_with_it(earlier: Path, tmp_path: Path) -> None:
    def refused(options: dict[str, Any], **inputs: Path) -> InputError:
        with pytest.raises(InputError) as error, Run() as run:
            KIND.work({"avatar": earlier, **inputs}, AvatarOptions.model_validate(options), tmp_path, run)
        return error.value

    assert refused({}, body=video("happy")).code == "avatar_and_clips"
    assert refused({}, head=video("happy")).code == "avatar_and_clips"
    found = refused({"height_m": 1.8})
    assert found.code == "option_needs_clips" and "height_m" in found.detail
    assert refused({"body_frames_left_out": [3]}).code == "option_needs_clips"
