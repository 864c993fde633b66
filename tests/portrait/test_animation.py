"""The whole system on real media: what comes out, and that it acts."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import av
import numpy as np
import pytest
from made_clip import OPENS, face, unpacked, write_frames
from numpy.typing import NDArray

from engine.media.image import read_image
from engine.perception.face.landmarks import eye_distance, eye_opening, fiducials, mouth_opening
from engine.performances import video


def test_it_has_the_target_s_size_and_a_frame_for_each_of_the_driver_s(opens, woman: Path) -> None:
    assert len(opens.frames) == 24
    assert opens.frames[0].shape == read_image(woman).rgb.shape
    with av.open(str(opens.out / "animation.mp4")) as container:
        stream = container.streams.video[0]
        assert stream.average_rate == 30
        assert stream.codec_context.name == "h264" and stream.codec_context.pix_fmt == "yuv420p"
        assert not container.streams.audio


def test_artifacts_are_those_of_the_contract(opens, woman: Path) -> None:
    names = {p.name for p in opens.out.iterdir()}
    assert names == {"animation.mp4", "preview.jpg", "thumbnail.jpg", "poster.jpg", "landmarks.json", "report.json"}
    report = json.loads((opens.out / "report.json").read_text())
    assert report["kind"] == "portrait"
    assert set(report["stages"]) >= {"find_face", "separate_layers", "track_driver", "animate"}
    assert report["inputs"]["size"] == [300, 300] and report["inputs"]["frames"] == 24
    assert report["inputs"]["fps"] == 30 and len(report["inputs"]["faces"]) == 1
    assert report["quality"]["driver_face_share"] == 1.0
    for name in ("preview.jpg", "poster.jpg"):
        assert read_image(opens.out / name).rgb.shape == (300, 300, 3)
    preview, thumbnail = (read_image(opens.out / name).rgb for name in ("preview.jpg", "thumbnail.jpg"))
    assert np.abs(thumbnail.astype(int) - preview).mean() < 6 and (opens.out / "thumbnail.jpg").stat().st_size < 12_000


def test_the_driver_s_neutral_frame_shows_the_target(opens, woman: Path) -> None:
    picture = read_image(woman).rgb
    apart = np.abs(opens.frames[0].astype(int) - picture)
    assert apart.mean() < 2.5
    moved = np.linalg.norm(fiducials(face(opens.frames[0]))[:, :2] - fiducials(face(picture))[:, :2], axis=1)
    assert moved.mean() < 0.8


def test_the_mouth_opens_when_the_driver_s_does(opens) -> None:
    ours = np.array([mouth_opening(face(f)) for f in opens.frames])
    assert ours[0] < 0.08
    assert ours[-1] > 0.4
    quarter = [int(np.argmax(ours > s * ours.max())) for s in (0.25, 0.75)]
    assert 2 <= quarter[0] <= quarter[1] <= 16


def test_an_open_mouth_is_not_skin_inside(opens) -> None:
    """Teeth, tongue or dark: the inside differs from the lips that were torn apart."""
    frame = opens.frames[-1]
    mesh = face(frame)
    middle = ((mesh[13] + mesh[14]) / 2)[:2].round().astype(int)
    inside = frame[middle[1] - 3 : middle[1] + 4, middle[0] - 4 : middle[0] + 5].astype(float).mean(axis=(0, 1))
    cheek = mesh[50, :2].round().astype(int)
    skin = frame[cheek[1] - 3 : cheek[1] + 4, cheek[0] - 3 : cheek[0] + 4].astype(float).mean(axis=(0, 1))
    assert np.linalg.norm(inside - skin) > 60


def test_the_background_does_not_move(opens, woman: Path) -> None:
    picture = read_image(woman).rgb.astype(int)
    corner = (slice(0, 60), slice(0, 40))
    for frame in opens.frames[::6]:
        assert np.abs(frame[corner].astype(int) - picture[corner]).mean() < 3


def test_strength_scales_the_motion(animation, opens, woman, driver) -> None:
    half = animation(woman, driver, trim=OPENS, neutral_frame=0, strength=0.5)
    whole = fiducials(face(opens.frames[-1]))[57, 1] - fiducials(face(opens.frames[0]))[57, 1]
    less = fiducials(face(half.frames[-1]))[57, 1] - fiducials(face(half.frames[0]))[57, 1]
    assert less == pytest.approx(whole / 2, rel=0.25)


def changes(frames: list[NDArray[np.uint8]]) -> NDArray[np.float64]:
    """(H, W) the largest change of each pixel against the first frame, grey levels."""
    stack = np.array(frames, np.int16)[..., :3]
    return np.asarray(np.abs(stack - stack[0]).max(axis=(0, 3)), float)


@pytest.mark.parametrize("options", [{"strength": 0.0}, {"follow": ()}], ids=["no strength", "nothing follows"])
def test_what_follows_nothing_is_still(animation, woman, driver, options) -> None:
    made = animation(woman, driver, trim=OPENS, neutral_frame=0, format="png", **options)
    assert changes(unpacked(made.out / "animation.zip")).max() <= 2


def parts(mesh: NDArray, shape: tuple[int, ...]) -> dict[str, NDArray[np.bool_]]:
    """Where mouth and chin, brows and forehead, and what is outside the face are."""
    unit = float(eye_distance(mesh[:, :2]))
    y, x = np.mgrid[: shape[0], : shape[1]]
    near = np.hypot(x - mesh[4, 0], y - mesh[4, 1])
    wide = np.abs(x - mesh[4, 0]) < 0.9 * unit
    return {
        "mouth": wide & (y > mesh[2, 1] + 0.25 * unit) & (y < mesh[152, 1] - 0.15 * unit),
        "brows": wide & (y < mesh[105, 1] - 0.05 * unit) & (y > mesh[10, 1] + 0.15 * unit),
        "outside": near > 2.6 * unit,
    }


def test_only_the_mouth_follows(animation, woman, driver) -> None:
    made = animation(woman, driver, trim=OPENS, neutral_frame=0, format="png", follow=("mouth",))
    frames = unpacked(made.out / "animation.zip")
    change = changes(frames)
    where = parts(face(frames[0]), change.shape)
    assert change[where["mouth"]].mean() > 25
    assert change[where["brows"]].mean() < 2
    assert change[where["outside"]].max() <= 2
    assert mouth_opening(face(frames[-1])) > 0.4


def test_only_the_eyes_follow(animation, woman) -> None:
    """A wink shuts one eye, and neither mouth nor brows take part."""
    made = animation(woman, video("wink"), trim=(0.0, 0.9), neutral_frame=0, format="png", follow=("eyes",))
    frames = unpacked(made.out / "animation.zip")
    opening = np.array([eye_opening(face(f)) for f in frames])
    assert sorted(opening.min(axis=0) / opening[0] < 0.5) == [False, True]
    change, where = changes(frames), parts(face(frames[0]), frames[0].shape)
    assert change[where["mouth"]].mean() < 2 and change[where["brows"]].mean() < 2


def test_only_the_brows_follow(animation, woman) -> None:
    """Of a surprise, in which eyes and mouth open wide, the brows alone."""
    made = animation(woman, video("surprise"), trim=(0.0, 1.2), neutral_frame=0, format="png", follow=("brows",))
    frames = unpacked(made.out / "animation.zip")
    before, after = face(frames[0]), face(frames[33])
    unit = float(eye_distance(before[:, :2]))
    up = (before - after)[[105, 334], 1] / unit
    assert up.min() > 0.04
    assert mouth_opening(after) < 0.08
    assert eye_opening(after) == pytest.approx(eye_opening(before), rel=0.15)
    assert changes(frames)[parts(before, frames[0].shape)["mouth"]].mean() < 2


def test_only_the_head_follows(animation, woman, driver) -> None:
    """The face keeps its expression while it moves."""
    made = animation(woman, driver, trim=OPENS, neutral_frame=0, follow=("head",))
    opening = np.array([mouth_opening(face(f)) for f in made.frames])
    assert opening.max() < 0.1
    assert changes(made.frames).mean() > 0.5


def test_with_and_without_the_3d_head_the_face_acts_alike(animation, opens, woman, driver) -> None:
    plane = animation(woman, driver, trim=OPENS, neutral_frame=0, head_3d=False)
    a, b = (fiducials(face(m.frames[-1]))[:, :2] for m in (opens, plane))
    unit = float(eye_distance(face(opens.frames[0])[:, :2]))
    assert np.linalg.norm(a - b, axis=1).mean() < 0.08 * unit


@pytest.mark.parametrize("name", ["painting_mona_lisa.jpg", "drawing_young_man.png"])
def test_paintings_and_cartoons_act_without_tuning(animation, small, driver, name: str) -> None:
    made = animation(small(name, 320), driver, trim=OPENS, neutral_frame=0)
    opening = [float(mouth_opening(face(made.frames[i]))) for i in (0, -1)]
    assert opening[1] > opening[0] + 0.2


def test_a_driver_whose_face_vanishes_is_held_and_said_so(animation, woman, clip, tmp_path: Path) -> None:
    frames = clip("man_mouth_open_d18.mp4", 1.9, 2.7)
    frames = [np.full_like(f, 110) if 8 <= i < 12 else f for i, f in enumerate(frames)]
    made = animation(woman, write_frames(tmp_path / "gone.mp4", frames, 30), neutral_frame=0, format="png")
    assert "driver_face_lost" in {n.code for n in made.run.notices}
    shown = unpacked(made.out / "animation.zip")
    held = np.array(shown[8:12], int)
    assert np.abs(held - held[0]).max(axis=0).mean() < 2
    steps = [np.abs(a.astype(int) - b).mean() for a, b in pairwise(shown)]
    assert max(steps) < 8
