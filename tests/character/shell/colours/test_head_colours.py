"""The head's colours all round, of unrolled heads of which a part is seen and all is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.shell.colours.hair import HeadSeen, hair_share, hairline, strand_levels, strand_noise
from engine.character.shell.colours.head_map import head_map
from engine.character.shell.colours.head_round import head_round
from engine.character.shell.colours.unrolled import UNROLLED_COLUMNS

SKIN, HAIR, HAT, COLLAR = (200.0, 150.0, 120.0), (60.0, 40.0, 20.0), (30.0, 60.0, 160.0), (240.0, 240.0, 250.0)


def seen_from_before(
    colours: NDArray[np.float64],
) -> tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.float32]]:
    """Colours (A, `UNROLLED_COLUMNS`, 3), which of them are seen, and the cosines to the viewer."""
    facing = np.broadcast_to(np.cos(head_map().angle), colours.shape[:2]).astype(np.float32)
    source = facing > 0.2
    return np.where(source[..., None], colours, 0).astype(np.float32), source, facing


def painted(hairline: str = "hairline", temples: float = 0.8) -> NDArray[np.float64]:
    """A head of skin, with hair above a level, and beside the face above the ears."""
    head = head_map()
    hair = head.above(hairline) | (head.above("ears") & (head.angle > temples))
    return np.where(hair[..., None], HAIR, SKIN)


def off(found: NDArray[np.floating], cells: NDArray[np.bool_], colour: tuple[float, ...]) -> float:
    """How far colours are from one, in the median of some cells: sRGB levels."""
    cells = np.broadcast_to(cells, found.shape[:2])
    return float(np.median(np.abs(found[cells] - colour).max(-1)))


def test_what_is_well_seen_stays_as_it_is() -> None:
    colours, source, facing = seen_from_before(painted())
    found = head_round(colours, source, facing).colours
    head = head_map()
    well = source & (facing > 0.36) & ((head.angle < 0.55) | ~head.between("chin", "forehead"))
    assert (found[well] == colours[well]).all()


def test_between_eye_and_ear_skin_goes_on_by_itself() -> None:
    """A wall, a light rim or the shadow before an ear, which the picture has there, is no side of a head."""
    head = head_map()
    strip = (head.angle > 0.72) & (head.angle < 1.1) & head.between("chin", "brow")
    told = head_round(*seen_from_before(np.where(strip[..., None], COLLAR, painted(temples=1.4))))
    skin = strip & head.between("chin", "eyes")
    assert off(told.colours, skin, SKIN) < 3
    assert np.median(told.believed[skin]) < 0.2
    assert told.believed[head.between("chin", "brow") & (head.angle < 0.5)].min() > 0.999


def test_behind_is_hair_down_to_the_nape_and_skin_below() -> None:
    head, found = head_map(), head_round(*seen_from_before(painted())).colours
    behind = head.angle > 2.6
    assert off(found, behind & head.above("nose"), HAIR) < 6
    assert off(found, behind & ~head.above("chin"), SKIN) < 3


def test_ears_and_jaws_are_skin_and_hair_is_around_the_ears() -> None:
    """Sideburns before them, and hair above them and behind, right up to where they grow."""
    head, told = head_map(), head_round(*seen_from_before(painted()))
    found = told.colours
    assert told.ears is not None and np.abs(told.ears - SKIN).max() < 5
    assert off(found, head.around_ears & head.above("eyes"), HAIR) < 8
    assert off(found, (head.angle > 1.28) & (head.angle < 1.36) & head.between("ears", "eyes"), HAIR) < 40
    assert off(found, (head.angle > 1.2) & (head.angle < 1.7) & head.between("chin", "nose"), SKIN) < 3


def test_a_hairline_that_is_seen_goes_on_from_there() -> None:
    """Shaved temples: just above the brows nothing that is seen is hair, and hair begins behind that."""
    head = head_map()
    row = int(head.levels["brow"]) + 2
    begins = []
    for temples in (0.6, 2.0):
        colours, source, facing = seen_from_before(painted(temples=temples))
        found = head_round(colours, source, facing).colours
        hairy = np.abs(found[row] - HAIR).max(-1) < 40
        begins.append(float(head.angle[0][hairy].min()))
    assert begins[0] == pytest.approx(0.6, abs=0.05)
    assert 1.2 < begins[1] < 1.6


def test_a_hat_goes_round_at_its_own_height() -> None:
    head = head_map()
    colours = np.where((head.height > head.levels["forehead"])[..., None], HAT, painted())
    found = head_round(*seen_from_before(colours)).colours
    behind = head.angle > 2.6
    top = head.height > head.levels["forehead"] + 8
    assert off(found, behind & top, HAT) < 8
    assert off(found, behind & head.above("nose") & (head.height < head.levels["brow"]), HAIR) < 8


def test_a_collar_stays_at_the_neck() -> None:
    head = head_map()
    colours = np.where(head.above("chin")[..., None], painted(), COLLAR)
    found = head_round(*seen_from_before(colours)).colours
    assert off(found, (head.angle > 2.6) & (head.height < head.levels["chin"] - 4), COLLAR) < 4
    assert off(found, (head.angle > 2.6) & head.above("nose"), HAIR) < 8


def test_a_bald_head_is_skin_all_round() -> None:
    found = head_round(*seen_from_before(np.broadcast_to(SKIN, (*head_map().ears.shape, 3)))).colours
    assert np.abs(found - SKIN).max() < 2


def test_of_a_face_seen_from_one_side_the_other_cheek_is_the_same() -> None:
    head = head_map()
    side = np.arange(UNROLLED_COLUMNS) < UNROLLED_COLUMNS // 2 + UNROLLED_COLUMNS // 20
    colours, source, facing = seen_from_before(painted())
    found = head_round(np.where(side[None, :, None], colours, 0), source & side, facing).colours
    assert off(found, ~side & (head.angle < 0.6) & head.between("nose", "eyes"), SKIN) < 2


def test_a_hairline_has_no_step() -> None:
    """Hair down to the brows beside a face, and before the ears below: the line goes from one to the other at a slant."""
    head = head_map()
    colours, source, facing = seen_from_before(painted(temples=0.7))
    hair = source & (np.abs(colours - HAIR).max(-1) < 1) & head.above("brow")
    line = hairline(head, HeadSeen(source, hair, facing), falls=False)
    assert np.abs(np.diff(line[:, 0])).max() < 0.12
    assert line[int(head.levels["brow"]) + 4, 0] == pytest.approx(0.7, abs=0.06)
    assert line[int(head.levels["nose"]), 0] > 1.4


def test_where_a_side_shows_no_hair_it_begins_as_on_heads() -> None:
    """A face whose one side is skin up to the head's outline, under hair."""
    head = head_map()
    colours, source, facing = seen_from_before(painted(temples=1.4))
    hair = source & (np.abs(colours - HAIR).max(-1) < 1) & head.above("hairline")
    line = hairline(head, HeadSeen(source & (facing > 0.7), hair & (facing > 0.7), facing), falls=False)
    for level, least, most in (("eyes", 1.2, 1.7), ("nose", 1.8, 2.2), ("chin", 2.2, 2.6)):
        assert least < line[int(head.levels[level]), 0] < most


def test_a_flap_seen_at_a_slant_before_the_hairline_is_not_shown() -> None:
    head = head_map()
    colours, source, facing = seen_from_before(painted(temples=1.4))
    facing = np.where(head.angle > 0.6, np.minimum(facing, 0.4), facing).astype(np.float32)
    flap = (head.angle > 0.75) & (head.angle < 0.85) & head.between("eyes", "hairline")
    shown = np.where(flap[..., None] & source[..., None], np.float32(HAIR), colours)
    told = head_round(shown, source, facing)
    assert off(told.colours, flap, SKIN) < 5
    assert np.median(told.believed[flap]) < 0.2


def test_what_lies_on_one_cheek_alone_at_a_slant_is_not_shown() -> None:
    head = head_map()
    left = np.arange(UNROLLED_COLUMNS) < UNROLLED_COLUMNS // 2
    scarf = left & (head.angle > 0.75) & (head.angle < 0.95) & head.between("chin", "nose")
    colours, source, facing = seen_from_before(np.where(scarf[..., None], HAT, painted()))
    told = head_round(colours, source, facing)
    assert off(told.colours, scarf, SKIN) < 3
    assert np.median(told.believed[scarf]) < 0.1


def test_where_nothing_is_a_source_nothing_changes() -> None:
    colours = np.full((*head_map().ears.shape, 3), 7, np.float32)
    nothing = np.zeros(colours.shape[:2], np.bool_)
    assert head_round(colours, nothing, np.zeros(colours.shape[:2], np.float32)).colours is colours


def test_long_hair_covers_ears_and_neck() -> None:
    head = head_map()
    known = np.broadcast_to(head.angle < 1.1, head.ears.shape)
    hair = known & (head.above("hairline") | (head.angle > 0.7))
    still = np.zeros(head.ears.shape, np.float32)
    seen = HeadSeen(known, hair, np.cos(np.broadcast_to(head.angle, known.shape)))
    long, short = (
        hair_share(head, hairline(head, seen, falls=falls), seen, still, falls=falls) for falls in (True, False)
    )
    low = np.broadcast_to(~head.above("chin") & (head.angle > 1.5), long.shape)
    assert long[low].all() and not short[low].any()
    assert long[head.ears].all()


def test_strands_have_no_seam_and_are_drawn_out_along_the_head() -> None:
    noise = strand_noise((120, UNROLLED_COLUMNS))
    assert noise.mean() == pytest.approx(0, abs=1e-4) and noise.std() == pytest.approx(1, abs=1e-4)
    steps = np.abs(np.diff(noise, axis=1)).mean()
    assert np.abs(noise[:, 0] - noise[:, -1]).mean() < 1.5 * steps
    assert np.abs(np.diff(noise, axis=0)).mean() < 0.5 * steps
    assert (noise == strand_noise((120, UNROLLED_COLUMNS))).all()


def test_strands_are_as_strong_as_what_is_fine_about_hair() -> None:
    random = np.random.default_rng(1)
    hair = np.zeros((80, UNROLLED_COLUMNS), np.bool_)
    hair[10:70, 20:90] = True
    smooth = np.full((80, UNROLLED_COLUMNS, 3), 90.0)
    assert strand_levels(smooth, hair) < 1e-4
    fine = smooth + random.normal(0, 5, (80, UNROLLED_COLUMNS, 1))
    assert strand_levels(fine, hair) == pytest.approx(5, abs=0.7)
    assert strand_levels(fine, hair & False) == 0
