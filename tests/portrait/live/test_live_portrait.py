"""A portrait that follows a camera: the still face leaves it as it is, no frame waits for a later one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import cv2
import numpy as np
import pytest
from made_clip import OPENS
from numpy.typing import NDArray

from engine.errors import InputError
from engine.face_animation.animation import RiggedTarget
from engine.media.image import write_image
from engine.perception.face.landmarks import LIPS_OUTER
from engine.portrait.live.live_portrait import LivePortrait, Watched, prepare_live
from engine.portrait.live.options import LiveOptions
from engine.run import Run

Frames = Sequence[NDArray[np.uint8]]
OPTIONS = LiveOptions(longest_side=240)
FPS = 15


@pytest.fixture(scope="module")
def target(woman_white: Path) -> RiggedTarget:
    with Run() as run:
        return prepare_live(woman_white, OPTIONS, run)


@pytest.fixture(scope="module")
def opening(clip: Callable[[str, float, float], Frames]) -> Frames:
    """A face at rest for a second, whose mouth then opens: every other frame of the clip."""
    frames = [np.asarray(cv2.resize(rgb, (320, 320))) for rgb in clip("man_mouth_open_d18.mp4", *OPENS)]
    return [frames[0]] * (FPS + 4) + frames[::2]


def followed(target: RiggedTarget, frames: Frames) -> tuple[list[Watched], list[NDArray[np.uint8]]]:
    with LivePortrait(target, OPTIONS) as portrait:
        watched = [portrait.watch(rgb, k / FPS) for k, rgb in enumerate(frames)]
        return watched, [portrait.draw(one) for one in watched[-8:]]


def test_before_a_still_face_the_portrait_is_its_picture(target: RiggedTarget, opening: Frames) -> None:
    watched, drawn = followed(target, [opening[0]] * (FPS + 14))
    assert watched[0].state == "calibrating" and watched[-1].state == "live"
    apart = cv2.absdiff(drawn[-1], target.face.rgb).astype(float)
    assert apart.mean() < 1.0


def test_no_frame_depends_on_a_later_one(target: RiggedTarget, opening: Frames) -> None:
    """The same camera up to a frame, and another one after it: the pictures up to it are the same ones."""
    apart_from = len(opening) - 6
    other = [*opening[:apart_from], *[np.zeros_like(opening[0])] * 6]
    some, others = (
        drawn_one_by_one(target, frames, range(apart_from - 2, apart_from + 1)) for frames in (opening, other)
    )
    np.testing.assert_array_equal(some[0], others[0])
    np.testing.assert_array_equal(some[1], others[1])


def drawn_one_by_one(target: RiggedTarget, frames: Frames, wanted: range) -> list[NDArray[np.uint8]]:
    """Each frame is drawn only after the next two were looked at."""
    with LivePortrait(target, OPTIONS) as portrait:
        watched = [portrait.watch(rgb, k / FPS) for k, rgb in enumerate(frames[: wanted.stop + 2])]
        return [portrait.draw(watched[k]) for k in wanted]


def test_a_mouth_that_opens_opens(target: RiggedTarget, opening: Frames) -> None:
    watched, drawn = followed(target, opening)
    lips = target.face.mesh[list(LIPS_OUTER), :2]
    (x0, y0), (x1, y1) = lips.min(axis=0).astype(int), lips.max(axis=0).astype(int)
    gaps = [float(one.motion.offsets[14, 1] - one.motion.offsets[13, 1]) for one in watched if one.motion is not None]
    assert max(gaps) > 0.25 * (x1 - x0) and abs(gaps[0]) < 0.1 * (x1 - x0)
    changed = cv2.absdiff(drawn[-1], target.face.rgb)
    assert changed[y0:y1, x0:x1].mean() > 4 * changed.mean()


def test_without_a_face_it_says_so_and_holds_still(target: RiggedTarget, opening: Frames) -> None:
    gone = np.full_like(opening[0], 90)
    watched, drawn = followed(target, [gone, *[opening[0]] * (FPS + 6), *[gone] * 3])
    assert watched[0].state == "no_face" and watched[0].motion is None
    assert [one.state for one in watched[-3:]] == ["no_face"] * 3
    assert cv2.absdiff(drawn[-1], drawn[-2]).mean() < 0.1


def test_recalibrated_it_is_its_picture_until_it_has_a_rest_again(target: RiggedTarget, opening: Frames) -> None:
    with LivePortrait(target, OPTIONS) as portrait:
        times = iter(k / FPS for k in range(1000))
        states = [portrait.watch(opening[0], next(times)).state for _ in range(FPS + 4)]
        portrait.recalibrate()
        again = portrait.watch(opening[0], next(times))
        assert states[-1] == "live" and again.state == "calibrating"
        assert portrait.draw(again) is target.face.rgb


def test_a_picture_without_a_face_is_refused(tmp_path: Path) -> None:
    write_image(tmp_path / "plain.png", np.full((120, 120, 3), 128, np.uint8))
    with Run() as run, pytest.raises(InputError) as refused:
        prepare_live(tmp_path / "plain.png", OPTIONS, run)
    assert refused.value.code == "no_face"
