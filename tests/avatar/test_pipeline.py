"""A whole avatar of two small clips, whose truth is known: from films to files, as a job behind its walls that went on after
its worker was killed."""

from __future__ import annotations

import json
import zipfile
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from glb_reader import Glb, validate
from made_clip import read_frames, write_frames
from made_motion import bvh
from numpy.typing import NDArray
from PIL import Image
from running import Running, eventually
from scipy.spatial import cKDTree
from stored_stages import Stored, assert_taken, stored

from benchmarks.scan_studio.sample_clips import sample_truth
from benchmarks.scan_studio.truth import Truth
from engine.avatar import KIND, AvatarOptions
from engine.avatar.combined_targets import COMBINED_TARGETS
from engine.avatar.pipeline import STAGES
from engine.avatar.sample import SAMPLE_FRAMES, sample_clip
from engine.body.face.visemes import VISEMES
from engine.body.parts import BODY_PARTS
from engine.body.template import FACE_UNITS
from engine.errors import Canceled, InputError
from engine.geometry.registration.rigid import Similarity, fit_robustly, fit_similarity
from engine.media.video import read_video
from engine.performances import video
from engine.run import Run
from engine.stage_keys import content_hash
from engine.store import StageStore

OPTIONS = {
    "height_m": 1.8,
    "body_frames": SAMPLE_FRAMES["body"],
    "head_frames": SAMPLE_FRAMES["head"],
    "texture_size": 1024,
    "size": (96, 160),
    "fps": 5,
    "vrm": True,
}
pytestmark = pytest.mark.timeout(1900)
"""Seconds: the first test waits for a whole avatar, where other tests compute beside it."""
CAPTURE = ["choose_frames", "choose_frames", "find_cameras", *["find_landmarks", "measure_cloud"] * 2]
"""The stages that measure, in their order."""
TWO_CODINGS = 2.0
"""Grey levels, in the mean of a frame: two codings of one picture, each of which errs by 1.4 in the root of squares (`encoders`)."""
DRIVER_FRAMES = 4


@dataclass(frozen=True)
class Made:
    """The folder with the files, the store of the stages and what of it was there before the worker was killed, what was
    given, and how often the job began."""

    out: Path
    store: Path
    found_before: dict[str, Stored]
    inputs: dict[str, Any]
    attempts: int

    @property
    def report(self) -> dict[str, Any]:
        return json.loads((self.out / "report.json").read_text())

    def again(self, out: Path, until: str | None = None, **changed: Any) -> list[str]:
        """Another run, which ends as soon as a stage `until` begins; the stages that it took from the store."""
        begun: list[str] = []
        inputs, erased = self.inputs | changed.pop("inputs", {}), changed.pop("erased", {})
        with (
            Run(
                StageStore(self.store),
                canceled=lambda: until in begun,
                on_stage=lambda name, turn: begun.append(name),
                erased=erased,
            ) as run,
            suppress(Canceled),
        ):
            KIND.work(inputs, AvatarOptions.model_validate({**OPTIONS, **changed}), out, run)
        return run.reused


@pytest.fixture(scope="module")
def truth() -> Truth:
    return sample_truth()


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """One avatar for all tests; somebody else's face and a motion of one's own move it."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "out").mkdir()
    frames = [frame.rgb for frame in islice(read_video(video("happy")), DRIVER_FRAMES)]
    (folder / "arms.bvh").write_bytes(bvh())
    inputs = {
        "body": sample_clip("body"),
        "head": sample_clip("head"),
        "driver": write_frames(folder / "driver.mp4", frames, fps=5),
        "motion": folder / "arms.bvh",
    }
    settings = {"worker_kinds": "avatar", "lease_seconds": 5, "sweep_seconds": 0.5}
    with Running(folder / "data", kinds="engine.kinds:KINDS", **settings) as service:
        files = {name: (path.name, path.read_bytes()) for name, path in inputs.items()}
        asked = {"kind": "avatar", "options": json.dumps(OPTIONS)}
        job = service.client.post("/v1/jobs", data=asked, files=files).raise_for_status().json()["id"]
        eventually(lambda: service.job(job)["progress"]["stage"] == "measure_cloud", "stereo measures", 900)
        (store,) = (folder / "data" / "jobs").glob("*/stages")
        found_before = stored(store)
        (worker,) = service.processes("shell.main worker")
        worker.kill()
        done = service.until(job, "succeeded", "failed", seconds=900)
        assert done["error"] is None
        for name, artifact in done["artifacts"].items():
            (folder / "out" / name).write_bytes(service.client.get(artifact["url"]).raise_for_status().content)
        with service.client.stream("GET", f"/v1/jobs/{job}/events") as events:
            attempts = events.read().decode().count('{"status": "running"}')
    return Made(folder / "out", store, found_before, inputs, attempts)


@pytest.fixture(scope="module")
def cameras(made: Made) -> dict[str, NDArray[np.float64]]:
    """Of both clips: the number of each frame, and where its camera stood in the avatar's world, (F, 4)."""
    written = json.loads((made.out / "cameras.json").read_text())
    return {
        name: np.array([[one["frame"], *(-np.array(one["rotation"]).T @ np.array(one["translation"]))] for one in clip])
        for name, clip in written.items()
    }


def true_eyes(truth: Truth, name: str, frames: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.array([truth.person_camera(name, int(frame)).eye for frame in frames])


@pytest.fixture(scope="module")
def to_truth(truth: Truth, cameras: dict[str, NDArray[np.float64]]) -> Similarity:
    """From the avatar's world to the true one, by the body's cameras."""
    body = cameras["body"]
    return fit_robustly(body[:, 1:], true_eyes(truth, "body", body[:, 0]), 0.05).transform


def test_what_was_found_before_the_worker_was_killed_is_not_sought_again(made: Made) -> None:
    assert made.attempts == 2
    assert len(made.found_before) >= 3, "two choices of frames, and cameras"
    assert_taken(made.found_before, stored(made.store))


def test_cameras_stand_to_one_another_as_they_stood(
    truth: Truth, cameras: dict[str, NDArray[np.float64]], to_truth: Similarity
) -> None:
    for name, farthest in (("body", 0.02), ("head", 0.01)):
        found = cameras[name]
        assert len(found) > 0.8 * SAMPLE_FRAMES[name]
        true = true_eyes(truth, name, found[:, 0])
        own = fit_robustly(found[:, 1:], true, 0.03).transform
        assert np.median(np.linalg.norm(own(found[:, 1:]) - true, axis=1)) < farthest, name
    assert np.degrees(np.arccos((np.trace(to_truth.rotation) - 1) / 2)) < 8, "it faces +z"
    assert np.abs(to_truth(np.zeros(3))).max() < 0.12, "it stands at the origin"


def test_the_avatar_is_as_tall_as_was_said(made: Made, to_truth: Similarity) -> None:
    assert made.report["quality"]["height_m"] == pytest.approx(1.8, abs=0.05)
    assert to_truth.scale == pytest.approx(1, abs=0.05)


def test_points_of_both_clips_lie_on_one_person(made: Made, truth: Truth, to_truth: Similarity) -> None:
    """Once the body's size is corrected by its own points, the head's have their size and place, too."""
    subject = truth.subject
    surface = trimesh.sample.sample_surface(trimesh.Trimesh(subject.vertices, subject.triangles), 100_000, seed=1)[0]
    tree = cKDTree(surface)
    points = to_truth(np.asarray(trimesh.load(made.out / "points.ply").vertices))
    neck = subject.joints["Head"][1]
    body = points[points[:, 1] < neck - 0.1]
    for gate in (0.05, 0.03, 0.02, 0.02, 0.02, 0.02):
        distance, nearest = tree.query(body)
        near = distance < gate
        change = fit_similarity(body[near], surface[nearest[near]])
        body, points = change(body), change(points)
    head = points[points[:, 1] > neck]
    assert len(points) > 5000 and len(head) > 1000
    assert np.median(tree.query(points)[0]) < 0.008 and np.percentile(tree.query(points)[0], 90) < 0.03
    assert np.median(tree.query(head)[0]) < 0.008


def test_the_glb_is_valid_and_has_all_expressions_and_clips(made: Made) -> None:
    glb = Glb(made.out / "avatar.glb")
    issues = validate(made.out / "avatar.glb")
    assert issues["numErrors"] == 0, issues
    meshes = [mesh for mesh in glb.json["meshes"] if "extras" in mesh]
    assert [mesh["extras"]["targetNames"] for mesh in meshes] == [[*FACE_UNITS, *VISEMES, *COMBINED_TARGETS]]
    clips = [clip["name"] for clip in glb.json["animations"]]
    assert clips[:2] == ["driver", "filmed"] and {"idle", "walk"} <= set(clips)
    assert {"avatar.usdz", "avatar.vrm"} <= {path.name for path in made.out.iterdir()}


def test_films_have_the_frames_that_they_should(made: Made) -> None:
    turn, acted = (read_frames(made.out / f"{name}.mp4") for name in ("turntable", "animation"))
    assert len(turn) == 6 * OPTIONS["fps"] and len(acted) == DRIVER_FRAMES
    assert turn[0].shape == acted[0].shape == (160, 96, 3)
    half = len(turn) // 2
    assert np.abs(turn[0].astype(int) - turn[half]).mean() > 2, "seen from behind it looks otherwise"
    assert np.abs(turn[0].astype(int) - turn[-1]).mean() < np.abs(turn[0].astype(int) - turn[half]).mean()


def test_the_report_tells_coverage_and_the_files_that_they_are_synthetic(made: Made) -> None:
    report = made.report
    assert set(report["coverage"]) == set(BODY_PARTS) and all(0 <= share <= 1 for share in report["coverage"].values())
    assert 0.5 < report["quality"]["seen_share"] <= 1
    assert (
        report["inputs"]["body"]["size"] == [216, 384] and report["inputs"]["body"]["placed"] <= SAMPLE_FRAMES["body"]
    )
    warned = {warning["code"] for warning in report["warnings"]}
    assert not warned & {"head_clip_missing", "head_not_joined", "head_not_reconstructed", "height_guessed"}
    for name in ("texture.png", "poster.jpg"):
        assert b"compositeSynthetic" in (made.out / name).read_bytes()
    with Image.open(made.out / "texture.png") as texture:
        assert texture.size == (1024, 1024)


def contents(path: Path) -> dict[str, bytes]:
    """What a file holds; of an archive, which tells when it was made, its members."""
    if path.suffix != ".usdz":
        return {path.name: path.read_bytes()}
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_a_second_run_takes_all_stages_from_the_store_and_writes_the_same(made: Made, tmp_path: Path) -> None:
    assert made.again(tmp_path) == [*CAPTURE, "fit_template", "find_attachments", "stitch_texture"]
    for path in made.out.iterdir():
        if path.suffix == ".mp4":
            one, other = (np.stack(read_frames(film)).astype(int) for film in (path, tmp_path / path.name))
            assert one.shape == other.shape and np.abs(one - other).mean((1, 2, 3)).max() < TWO_CODINGS, path.name
        elif path.name != "report.json":
            assert contents(path) == contents(tmp_path / path.name), path.name
    assert {**made.report, "stages": None} == {**json.loads((tmp_path / "report.json").read_text()), "stages": None}


@pytest.mark.parametrize(
    ("changed", "until", "reused"),
    [
        ({"height_m": 1.7}, "fit_template", CAPTURE),
        (
            {"motion": "wave", "inputs": {"motion": None}},
            "write_avatar",
            [*CAPTURE, "fit_template", "find_attachments", "stitch_texture"],
        ),
        ({"texture_size": 2048}, "stitch_texture", [*CAPTURE, "fit_template", "find_attachments"]),
    ],
)
def test_what_is_changed_redoes_what_depends_on_it(
    made: Made, tmp_path: Path, changed: dict[str, Any], until: str, reused: list[str]
) -> None:
    assert set(reused) <= set(STAGES)
    assert made.again(tmp_path, until, **changed) == reused


def test_it_is_made_again_when_its_clips_are_erased(made: Made, tmp_path: Path) -> None:
    clips = {name: Path("erased") / name for name in ("body", "head")}
    erased = {path: content_hash(made.inputs[name]) for name, path in clips.items()}
    inputs = {**clips, "motion": None}
    found = made.again(tmp_path, "write_avatar", inputs=inputs, erased=erased, motion="wave")
    assert found == [*CAPTURE, "fit_template", "find_attachments", "stitch_texture"]
    with pytest.raises(InputError) as refused:
        made.again(tmp_path, inputs=inputs, erased=erased, body_frames=SAMPLE_FRAMES["body"] - 2)
    assert refused.value.code == "source_erased"
