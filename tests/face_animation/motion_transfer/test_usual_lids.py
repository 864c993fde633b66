"""A clip's lids are told from how far they usually open and from where its blinks end, not from one frame of it."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed, shut
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.lids_and_lips import lid_ratio
from engine.face_animation.motion_transfer.usual_lids import (
    AS_AT_REST,
    SHUT_SHARE,
    UsualLids,
    blink_bottoms,
    usual_lids,
)

FPS = 30.0
FACE = placed(60, (150, 120))
BLINK = np.array([0.8, 0.55, 0.3, 0.1, 0.3, 0.55, 0.8])
"""Of the way between lids that meet in a clip and lids as usual."""


def clip(*parts: NDArray[np.floating]) -> NDArray[np.float32]:
    """The face with its eyes open by these shares."""
    return np.stack([shut(FACE, float(share)) for share in np.concatenate(parts)])


def blinking(least: float) -> NDArray[np.floating]:
    """A blink that ends at this share of the usual gap."""
    return least + (1 - least) * (BLINK - BLINK.min()) / (1 - BLINK.min())


def test_the_usual_opening_is_that_of_open_eyes_however_often_they_shut_or_are_wide() -> None:
    narrow, usual, wide, asleep = np.full(3, 0.8), np.ones(40), np.full(12, 1.4), np.full(50, 0.1)
    found = usual_lids(clip(narrow, usual, wide, asleep), 0, FPS)
    assert found.opening == pytest.approx(1 / 0.8, rel=0.01)
    assert found.shut == pytest.approx(SHUT_SHARE / 0.8, rel=0.02)


@pytest.mark.parametrize("least", [0.1, 0.4, 0.5])
def test_lids_meet_where_a_clip_s_blinks_end(least: float) -> None:
    still = np.ones(20)
    found = usual_lids(clip(still, blinking(least), still, blinking(least), still), 0, FPS)
    assert found.shut == pytest.approx(max(least, SHUT_SHARE), abs=0.01)


def test_who_squints_or_half_lowers_lids_does_not_blink() -> None:
    still, slow = np.ones(20), np.linspace(1, 0.45, 12)
    assert usual_lids(clip(still, slow, slow[::-1], still), 0, FPS).shut == pytest.approx(SHUT_SHARE, abs=0.01)
    for share in (0.45, 0.7):
        held = np.concatenate([still, blinking(share)[:4], np.full(20, share), blinking(share)[3:], still])
        assert not len(blink_bottoms(held, FPS))


def test_each_blink_counts_once() -> None:
    still = np.ones(15)
    shares = np.concatenate([still, blinking(0.2), still, blinking(0.2)[:4], [0.2, 0.2], blinking(0.2)[3:], still])
    np.testing.assert_allclose(blink_bottoms(shares, FPS), 0.2)


@pytest.mark.parametrize("usually", [0.7, 1.0, 1.44])
def test_the_neutral_frame_shows_the_picture_however_eyes_usually_are(usually: float) -> None:
    lids = usual_lids(clip(np.ones(2), np.full(30, usually)), 0, FPS)
    np.testing.assert_allclose(lid_ratio(FACE[None], FACE, None, lids), 1, atol=1e-6)


def test_eyes_as_usual_do_not_stare_where_those_of_the_neutral_frame_are_narrow() -> None:
    lids = UsualLids(opening=1.44)
    ratio = lid_ratio(clip(np.array([1.0, 1.1, 1.2, 1.44])), FACE, None, lids)[:, 3]
    np.testing.assert_allclose(ratio, [1, 1, 1, 1.2], rtol=0.01)
    wide = lid_ratio(clip(np.array([0.64, 0.7, 0.9])), FACE, None, UsualLids(opening=0.64))[:, 3]
    np.testing.assert_allclose(wide, [0.8, 0.7 / 0.8, 1], rtol=0.01)


def test_a_shut_eye_is_shut_however_narrow_those_of_the_neutral_frame_are() -> None:
    """Seen with 0.42 of the neutral frame's gap, which is 0.3 of the usual one."""
    lids = usual_lids(clip(np.array([0.7]), np.ones(30)), 0, FPS)
    rest = shut(FACE, 0.7)
    seen = clip(np.array([SHUT_SHARE - 0.01]))
    np.testing.assert_array_equal(lid_ratio(seen, rest, None, lids), 0)
    assert lid_ratio(seen, rest, None, AS_AT_REST).min() > 0.05
