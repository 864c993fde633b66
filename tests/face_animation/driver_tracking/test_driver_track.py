"""Drivers analysed: faces that vanish and return, blinks that keep their depth, and an analysis that is kept."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from made_clip import write_frames
from made_face import placed
from numpy.typing import NDArray

from engine.errors import InputError
from engine.face_animation.creases.fine_details import keep_ratio_images
from engine.face_animation.creases.registration import register_track
from engine.face_animation.driver_tracking.driver import track_driver
from engine.face_animation.loop import close_loop
from engine.media.excerpt import Excerpt
from engine.media.image import read_image
from engine.media.video import read_video
from engine.perception.face.faces import FaceTracker, find_faces
from engine.perception.face.landmarks import eye_distance, eye_opening, mouth_opening
from engine.perception.face_track.face_crop import CROP_EYES, CROP_SHAPE
from engine.perception.face_track.held_face import EASE_BACK_FRAMES
from engine.perception.face_track.periphery import PeripheryTracker
from engine.perception.face_track.track import FaceTrack
from engine.run import Run
from engine.store import StageStore

BLANK_FRAMES = slice(10, 16)
MOVED_PIXELS = 60
"""Pixels to the right at which the face comes back."""


@pytest.fixture(scope="module")
def frames(clip) -> list[NDArray[np.uint8]]:
    return clip("man_talk_tps.mp4", 0.6, 2.0)


@pytest.fixture(scope="module")
def whole(frames, tmp_path_factory) -> Path:
    return write_frames(tmp_path_factory.mktemp("driver") / "whole.mp4", frames)


@pytest.fixture(scope="module")
def track(whole: Path) -> FaceTrack:
    return track_driver(Excerpt(whole))


def unfiltered(path: Path) -> NDArray[np.float32]:
    """What the face tracker says, frame by frame."""
    with FaceTracker() as tracker:
        return np.array([tracker(f.rgb)[0] for f in read_video(path)])


def shifted(frame: NDArray[np.uint8], by: float) -> NDArray[np.uint8]:
    matrix = np.array([[1.0, 0.0, by], [0.0, 1.0, 0.0]])
    return np.asarray(cv2.warpAffine(frame, matrix, frame.shape[1::-1], borderMode=cv2.BORDER_REPLICATE))


def test_every_frame_has_a_mesh_on_its_face(frames, track: FaceTrack, whole: Path) -> None:
    assert len(track) == len(frames)
    assert track.found.all()
    assert track.size == frames[0].shape[1::-1]
    away = np.linalg.norm(track.meshes[..., :2] - unfiltered(whole)[..., :2], axis=-1)
    assert away.mean() < 0.02 * float(eye_distance(track.meshes[0, :, :2]))


def test_crops_show_the_face_in_its_place_and_are_small(track: FaceTrack, frames) -> None:
    eyes = np.array(CROP_EYES)
    for index in (0, len(track) - 1):
        crop, mesh = track.crop(index), track.in_crop(index)
        assert crop.shape == (*CROP_SHAPE, 3)
        found = np.array([mesh[[33, 133]].mean(axis=0), mesh[[263, 362]].mean(axis=0)])
        assert np.abs(found - eyes).max() < 4
        again = cv2.warpAffine(
            frames[index], track.crop_places[index], CROP_SHAPE[::-1], borderMode=cv2.BORDER_REPLICATE
        )
        inner = (slice(60, 260), slice(60, 230))
        assert np.abs(again[inner].astype(int) - crop[inner]).mean() < 5
    assert track.crops.file.stat().st_size / len(track) < 50_000


def test_an_analysis_is_kept_as_it_is(whole: Path, tmp_path: Path) -> None:
    stored = []
    for _ in range(2):
        with Run(store=StageStore(tmp_path)) as run:
            stored.append(run.stage("track_driver", track_driver, Excerpt(whole), 0, run.tick, run.warn))
    fresh = track_driver(Excerpt(whole))
    assert run.reused == ["track_driver"]
    kept = stored[1]
    for name in ("meshes", "found", "periphery", "trust", "crop_places"):
        np.testing.assert_array_equal(getattr(kept, name), getattr(fresh, name), err_msg=name)
    np.testing.assert_array_equal(kept.crops.ends, fresh.crops.ends)
    assert (kept.size, kept.fps, kept.has_sound) == (fresh.size, fresh.fps, fresh.has_sound)
    assert kept.crops.file.read_bytes() == fresh.crops.file.read_bytes()


def test_all_that_is_kept_of_a_driver_takes_at_most_50_kilobytes_a_frame(media, tmp_path: Path) -> None:
    """The clip of the sharpest face: its track, its registration and its ratio images together."""
    clip = media("driving/woman_talk_aoc.mp4")
    with Run(store=StageStore(tmp_path)) as run:
        track = run.stage("track", track_driver, Excerpt(clip, trim=(0.0, 1.5)), 0, run.tick, run.warn)
        registration = run.stage("register", register_track, track, 0, run.tick)
        run.stage("ratios", keep_ratio_images, replace(track, meshes=registration.meshes), 0, run.tick)
    size = sum(p.stat().st_size for p in tmp_path.rglob("*") if p.is_file())
    assert size / len(track) < 50_000


@pytest.fixture(scope="module")
def vanished(frames, tmp_path_factory) -> tuple[FaceTrack, list[str], NDArray[np.float32]]:
    """The face is gone for some frames and comes back further to the right; the warnings; the true shifts."""
    shift = np.array([0.0 if i < BLANK_FRAMES.stop else MOVED_PIXELS for i in range(len(frames))], np.float32)
    acted = [
        np.full_like(f, 128) if BLANK_FRAMES.start <= i < BLANK_FRAMES.stop else shifted(f, shift[i])
        for i, f in enumerate(frames)
    ]
    path = write_frames(tmp_path_factory.mktemp("driver") / "vanished.mp4", acted)
    codes: list[str] = []
    return track_driver(Excerpt(path), warn=lambda code, message: codes.append(code)), codes, shift


def test_where_the_face_is_gone_it_holds(vanished) -> None:
    track, codes, _ = vanished
    assert not track.found[BLANK_FRAMES].any()
    assert track.found[: BLANK_FRAMES.start].all() and track.found[BLANK_FRAMES.stop :].all()
    assert codes == ["driver_face_lost"]
    unit = float(eye_distance(track.meshes[0, :, :2]))
    still = track.meshes[BLANK_FRAMES, :, :2]
    assert np.linalg.norm(still - still[0], axis=-1).max() < 0.03 * unit
    assert np.linalg.norm(still[0] - track.meshes[BLANK_FRAMES.start - 1, :, :2], axis=-1).mean() < 0.03 * unit


def test_when_it_comes_back_it_eases_back(vanished, track: FaceTrack) -> None:
    """No step is a jump, and after the easing it is where it is seen."""
    found, _, shift = vanished
    centre = found.meshes[..., :2].mean(axis=1)
    steps = np.linalg.norm(np.diff(centre, axis=0), axis=1)[
        BLANK_FRAMES.start - 1 : BLANK_FRAMES.stop + EASE_BACK_FRAMES
    ]
    assert steps.max() < 0.25 * MOVED_PIXELS
    after = slice(BLANK_FRAMES.stop + EASE_BACK_FRAMES + 1, len(found))
    expected = track.meshes[after, :, :2] + np.array([1.0, 0.0]) * shift[after, None, None]
    unit = float(eye_distance(track.meshes[0, :, :2]))
    assert np.linalg.norm(found.meshes[after, :, :2] - expected, axis=-1).mean() < 0.04 * unit


def test_its_looks_hold_and_ease_with_it(vanished) -> None:
    """What is drawn from the driver's pictures, its creases and the inside of its mouth, is of a face, and that face is
    where the mesh says, also where the video shows none or has it elsewhere."""
    track, _, _ = vanished
    last = track.crop(BLANK_FRAMES.start - 1)
    for frame in range(BLANK_FRAMES.start, BLANK_FRAMES.stop):
        np.testing.assert_array_equal(track.crop(frame), last)
    for frame in range(BLANK_FRAMES.stop, BLANK_FRAMES.stop + EASE_BACK_FRAMES + 1):
        seen = find_faces(track.crop(frame))
        assert len(seen) == 1
        assert np.linalg.norm(seen[0][:, :2] - track.in_crop(frame), axis=1).mean() < 2.5


def test_a_driver_of_several_faces_is_told_and_lets_choose(frames, tmp_path: Path) -> None:
    """The same man twice, half as large on the right, mirrored: who is followed is on that side."""
    some = frames[:6]
    height, side = some[0].shape[:2]
    both = []
    for frame in some:
        other = cv2.resize(frame[:, ::-1], (side // 4 * 2, height // 2), interpolation=cv2.INTER_AREA)
        below = np.full((height - len(other), other.shape[1], 3), 128, np.uint8)
        both.append(np.hstack([frame, np.vstack([other, below])]))
    path = write_frames(tmp_path / "both.mp4", both)
    codes: list[str] = []
    for index in (0, 1):
        track = track_driver(Excerpt(path), index, warn=lambda code, message: codes.append(code))
        assert ((track.meshes[..., 0].mean(axis=1) > side) == bool(index)).all()
        assert len(track.faces) == 2
    assert codes == ["several_faces_in_driver"] * 2
    with pytest.raises(InputError) as caught:
        track_driver(Excerpt(path), 2)
    assert (caught.value.code, caught.value.correctable) == ("driver_face_out_of_range", ("driver_face_index",))


def test_a_face_that_comes_later_holds_from_the_beginning(frames, tmp_path: Path) -> None:
    late = [np.full_like(frames[0], 128)] * 4 + frames[:8]
    track = track_driver(Excerpt(write_frames(tmp_path / "late.mp4", late)))
    assert not track.found[:4].any() and track.found[4:].all()
    assert np.isfinite(track.meshes).all()
    assert np.abs(track.meshes[:4] - track.meshes[4]).max() < 2
    assert all(np.array_equal(track.crop(frame), track.crop(4)) for frame in range(4))
    assert track.periphery.shape[0] == track.trust.shape[0] == len(track) == 12


def test_a_driver_without_a_face_is_refused(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    frames = [rng.integers(0, 255, (120, 160, 3), np.uint8) for _ in range(6)]
    with pytest.raises(InputError) as caught:
        track_driver(Excerpt(write_frames(tmp_path / "noise.mp4", frames)))
    assert caught.value.code == "no_face_in_driver"
    assert caught.value.correctable == ("driver",)


def test_rate_and_part_are_the_asked_ones(whole: Path) -> None:
    half = track_driver(Excerpt(whole, 12.5, (0.2, 1.0)))
    assert len(half) == 10 and half.fps == 12.5
    full = track_driver(Excerpt(whole, trim=(0.2, 1.0)))
    assert len(full) == 20 and full.fps == 25


@pytest.mark.parametrize(
    ("name", "start", "end"),
    [("man_talk_tps.mp4", 3.6, 5.0), ("man_selfie_talk_d13.mp4", 2.9, 4.3)],
)
def test_lips_open_most_on_the_same_frame(clip, tmp_path: Path, name: str, start: float, end: float) -> None:
    """Against the unfiltered landmarks, to the frame; somewhere within the clip."""
    path = write_frames(tmp_path / "lips.mp4", clip(name, start, end))
    track = track_driver(Excerpt(path))
    peak = int(mouth_opening(unfiltered(path)).argmax())
    assert 2 < peak < len(track) - 3
    assert int(mouth_opening(track.meshes).argmax()) == peak


def test_lips_and_lids_keep_their_moments_and_their_depth(track: FaceTrack, whole: Path) -> None:
    """Against the unfiltered landmarks: lips peak on the same frame, blinks keep 95 % of their depth."""
    raw = unfiltered(whole)
    assert int(mouth_opening(track.meshes).argmax()) == int(mouth_opening(raw).argmax())
    lids, kept = eye_opening(raw).mean(axis=1), eye_opening(track.meshes).mean(axis=1)
    usual = np.median(lids)
    low = int(lids.argmin())
    assert lids[low] < 0.6 * usual, "the clip has a blink here"
    assert usual - kept[low - 1 : low + 2].min() >= 0.95 * (usual - lids[low])
    assert abs(int(kept.argmin()) - low) <= 1


@pytest.fixture(scope="module")
def still(small) -> NDArray[np.uint8]:
    return read_image(small("photo_woman_outdoor.jpg", 320)).rgb


def test_points_around_the_head_follow_it(still, tmp_path: Path) -> None:
    """A still portrait carried across the picture: every tracked point does just that."""
    shifts = [np.array([1.5 * i, -0.75 * i]) for i in range(12)]
    moved = [
        cv2.warpAffine(
            still, np.column_stack([np.eye(2), s]), still.shape[1::-1],
            flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE,
        )
        for s in shifts
    ]  # fmt: skip
    track = track_driver(Excerpt(write_frames(tmp_path / "moved.mp4", moved)))
    assert track.periphery.shape[1] > 20
    assert track.trust.mean() > 0.8
    away = track.periphery - track.periphery[0] - np.array(shifts)[:, None]
    assert np.median(np.linalg.norm(away, axis=-1)[track.trust == 1]) < 0.2
    assert np.quantile(np.linalg.norm(away, axis=-1)[track.trust == 1], 0.95) < 1.0
    mesh = track.meshes[..., :2].mean(axis=1) - track.meshes[0, :, :2].mean(axis=0) - np.array(shifts)
    assert np.abs(mesh).max() < 1.0


def test_points_around_are_found_again_where_the_face_comes_back(still, tmp_path: Path) -> None:
    """The portrait is gone and comes back further to the right, where nothing has followed its points."""
    gone = [np.full_like(still, 128)] * 4
    seen = [still] * 6 + gone + [shifted(still, 40)] * 30
    track = track_driver(Excerpt(write_frames(tmp_path / "again.mp4", seen)))
    moved = track.periphery - track.periphery[0]
    assert np.abs(moved[:10]).max() < 1
    assert track.trust[-1].mean() > 0.5
    assert np.linalg.norm(moved[-1] - [40, 0], axis=-1)[track.trust[-1] == 1].max() < 1.5
    assert np.abs(np.diff(moved[:, track.trust[-1] == 1], axis=0)).max() < 0.25 * 40


def test_what_is_around_holds_still_with_the_face(still, tmp_path: Path) -> None:
    """Where nothing is seen, no point moves, and none loses its say."""
    path = write_frames(tmp_path / "dark.mp4", [still] * 12 + [np.zeros_like(still)] * 24 + [still] * 12)
    track = track_driver(Excerpt(path))
    gone = slice(12, 36)
    assert not track.found[gone].any()
    assert np.abs(track.periphery[gone] - track.periphery[11]).max() < 0.1
    assert np.array_equal(track.trust[12:28], np.broadcast_to(track.trust[11], (16, track.trust.shape[1])))


def covers(frame: NDArray[np.uint8], mesh: NDArray[np.floating], colour: tuple[int, int, int], shaded: bool) -> NDArray:
    """The frame with something of one colour, or a shaded one, before its face."""
    low, high = mesh[:, :2].min(axis=0), mesh[:, :2].max(axis=0)
    middle, reach = (low + high) / 2, 0.65 * (high - low)
    y, x = np.mgrid[: frame.shape[0], : frame.shape[1]]
    inside = ((x - middle[0]) / reach[0]) ** 2 + ((y - middle[1]) / reach[1]) ** 2 < 1
    light = 1 - 0.3 * shaded * ((x - middle[0]) / reach[0]) ** 2
    grain = np.random.default_rng(0).normal(0, 4, frame.shape[:2])
    drawn = np.clip(np.array(colour) * light[..., None] + grain[..., None], 0, 255)
    return np.where(inside[..., None], drawn, frame).astype(np.uint8)


@pytest.mark.parametrize(("colour", "shaded"), [((150, 120, 105), True), ((215, 175, 155), False)])
def test_what_covers_a_face_is_none_whatever_its_colour(
    frames, track: FaceTrack, tmp_path: Path, colour: tuple[int, int, int], shaded: bool
) -> None:
    """A hand has the colours by which a tracker goes on."""
    hidden = slice(12, 24)
    acted = [
        covers(frame, track.meshes[k], colour, shaded) if hidden.start <= k < hidden.stop else frame
        for k, frame in enumerate(frames)
    ]
    seen = track_driver(Excerpt(write_frames(tmp_path / "covered.mp4", acted)))
    assert not seen.found[hidden].any()
    assert seen.found[: hidden.start].all() and seen.found[hidden.stop + 2 :].all()


@pytest.mark.parametrize("name", ["man_smile_d9.mp4", "woman_funny_faces_d6.mp4"])
def test_no_turn_nor_grimace_is_taken_for_a_cover(media, name: str) -> None:
    assert track_driver(Excerpt(media(f"driving/{name}"), 12.0)).found.all()


def test_a_face_with_nothing_around_it_to_follow_has_no_points_in_any_frame() -> None:
    """A plain picture, in which the face fills all: as many frames, and no point in any of them."""
    plain = np.full((120, 100, 3), 128, np.uint8)
    around = PeripheryTracker()
    for mesh in (None, placed(40, (50, 50)), None, placed(40, (52, 50))):
        around.follow(plain, mesh)
    points, trust = around.result()
    assert points.shape == (4, 0, 2) and trust.shape == (4, 0)


def test_a_track_without_points_around_can_be_closed(track: FaceTrack) -> None:
    none = replace(track, periphery=track.periphery[:, :0], trust=track.trust[:, :0])
    assert close_loop(none).periphery.shape == (len(track), 0, 2)
