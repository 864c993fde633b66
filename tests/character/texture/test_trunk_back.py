"""Backs of trunks: what both sides show goes round, what the middle or one side has does not."""

from __future__ import annotations

import numpy as np

from engine.character.texture.kept_front import kept_front
from engine.character.texture.plain_cloth import cloth_behind
from engine.character.texture.trunk_back import with_trunk_back

HIGH, WIDE = 320, 160
CLOTH, RED, WHITE = (60, 90, 70), (210, 30, 40), (235, 235, 230)
HEAD, TRUNK, NOBODY = np.zeros((3, HIGH, WIDE), np.bool_)
HEAD[10:60, 60:100] = True
TRUNK[60:200, 30:130] = True
INSIDE = np.zeros_like(TRUNK)
INSIDE[66:194, 34:126] = True


def dressed() -> np.ndarray:
    """A picture (h, w, 3) of somebody in plain cloth."""
    rgb = np.full((HIGH, WIDE, 3), 128, np.uint8)
    rgb[HEAD], rgb[TRUNK] = (220, 170, 140), CLOTH
    return rgb


def back(rgb: np.ndarray, shown: np.ndarray = TRUNK, others: np.ndarray = NOBODY) -> np.ndarray:
    return with_trunk_back(rgb, TRUNK, shown, others, HEAD, 1.0)


def off(found: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    return np.abs(found.astype(int) - colour).max(-1)


def test_what_half_of_the_middle_shows_is_not_on_the_back() -> None:
    for half in (4, 12, 20):
        rgb = dressed()
        rgb[60:150, 80 - half : 80 + half] = RED
        found = back(rgb)
        assert off(found, CLOTH)[TRUNK].max() < 4, "a tie, a print, an opening"
        np.testing.assert_array_equal(found[~TRUNK], rgb[~TRUNK])


def test_belts_and_stripes_go_round_at_their_height() -> None:
    rgb = dressed()
    rgb[150:160, 30:130] = RED
    rgb[170:174, 30:130] = WHITE
    found = back(rgb)
    np.testing.assert_allclose(found[INSIDE].astype(int), rgb[INSIDE], atol=4)


def test_what_one_side_alone_has_is_not_on_the_back() -> None:
    rgb = dressed()
    rgb[110:140, 36:52] = RED  # a bag
    found = back(rgb)
    assert (off(found, CLOTH)[INSIDE] > 12).mean() < 0.01


def test_what_an_arm_hides_is_as_the_other_side_has_it() -> None:
    rgb = dressed()
    rgb[120:132, 30:130] = WHITE
    arm = np.zeros_like(TRUNK)
    arm[90:150, 30:60] = True
    rgb[arm] = RED
    found = back(rgb, TRUNK & ~arm, arm)
    assert off(found, WHITE)[INSIDE & (np.arange(HIGH) > 122)[:, None] & (np.arange(HIGH) < 130)[:, None]].max() < 6
    assert off(found, CLOTH)[INSIDE & (np.abs(np.arange(HIGH) - 126) > 9)[:, None]].max() < 6


def test_light_from_one_side_has_no_border_behind() -> None:
    light = np.linspace(0.5, 1, WIDE)[None, :, None]
    rgb = np.where(TRUNK[..., None], light * [200, 180, 160], dressed()).astype(np.uint8)
    found = back(rgb)[80:190, 34:126].astype(int)
    assert np.abs(np.diff(found, axis=1)).max() <= 4
    assert np.abs(found[:, [0, -1]] - rgb[80:190, [34, 125]]).max() <= 8, "as it is before at the outline"


def test_checks_are_on_the_back() -> None:
    rgb = dressed()
    y, x = np.indices(TRUNK.shape)
    rgb[TRUNK & ((x // 6 + y // 6) % 2 == 0)] = WHITE
    assert back(rgb)[INSIDE].std() > 0.75 * rgb[INSIDE].std()


def test_of_a_pattern_what_a_hand_hides_is_as_on_the_other_side() -> None:
    rgb = dressed()
    y, x = np.indices(TRUNK.shape)
    rgb[TRUNK & ((x // 8 + y // 8) % 2 == 0)] = WHITE
    hand = np.zeros_like(TRUNK)
    hand[100:124, 42:66] = True
    rgb[hand] = RED
    found = back(rgb, TRUNK & ~hand, hand)
    dark, light = (off(found, colour)[104:120, 46:62] < 60 for colour in (CLOTH, WHITE))
    assert dark.mean() > 0.25 and light.mean() > 0.25


def test_a_neckline_is_the_front_s_alone() -> None:
    rgb = dressed()
    trunk = TRUNK.copy()
    for row in range(60, 90):  # shoulders
        trunk[row, : 60 - (row - 60)] = trunk[row, 100 + (row - 60) :] = False
    for row in range(60, 84):
        rgb[row, 80 - (84 - row) : 80 + (84 - row)] = WHITE
    found = with_trunk_back(rgb, trunk, trunk, NOBODY, HEAD, 1.0)
    assert off(found, CLOTH)[trunk].max() < 6


def test_of_whom_nothing_is_shown_nothing_changes() -> None:
    rgb = dressed()
    np.testing.assert_array_equal(back(rgb, NOBODY), rgb)


def round_trunk() -> tuple[np.ndarray, np.ndarray]:
    """Two hundred rows of a blue trunk, 1 m high, as it is laid out, and the angles of its columns."""
    angle = ((np.arange(120) + 0.5) / 120 - 0.5) * np.pi
    return np.broadcast_to(np.array([30, 50, 150], np.float32), (200, 120, 3)).copy(), angle


def test_a_word_that_reaches_the_sides_stays_in_front() -> None:
    seen, angle = round_trunk()
    seen[60:90, 8:112:3] = 250
    behind = cloth_behind(seen, np.ones((200, 120), np.bool_), angle, 0.005)
    assert np.abs(behind - [30, 50, 150]).max() < 40
    assert np.abs(behind - [30, 50, 150]).mean() < 4


def test_stripes_that_hang_in_curves_go_round() -> None:
    """No row of them is of one colour."""
    seen, angle = round_trunk()
    striped = (np.arange(200)[:, None] + 10 * np.cos(3 * angle)[None]) % 14 < 3
    seen[striped] = 250
    known = np.ones((200, 120), np.bool_)
    behind = cloth_behind(seen, known, angle, 0.005)
    share = kept_front(seen, known, behind, angle, 0.005)[..., None]
    found = share * seen + (1 - share) * behind
    assert abs((found.mean(-1) > 150)[20:180].mean() - striped[20:180].mean()) < 0.05


def test_where_both_sides_meet_there_is_no_edge() -> None:
    """A shadow, 30 cm high, on one side alone."""
    seen, angle = round_trunk()
    seen[70:130, 60:] *= 0.7
    behind = cloth_behind(seen, np.ones((200, 120), np.bool_), angle, 0.005)
    assert np.abs(np.diff(behind[75:125, 40:80], axis=1)).max() < 6, "grey levels from one column to the next"


def woven() -> np.ndarray:
    """A picture (h, w, 3) of somebody in cloth with a weave."""
    rgb = dressed().astype(int)
    rgb[TRUNK] += np.random.default_rng(0).integers(-4, 5, (int(TRUNK.sum()), 1))
    return rgb.astype(np.uint8)


def test_plain_cloth_is_as_fine_behind_as_before() -> None:
    rgb = woven()
    fine = [np.diff(one[80:190, 45:115].astype(float), axis=1).std() for one in (rgb, back(rgb))]
    assert 0.6 < fine[1] / fine[0] < 1.1  # rows are laid out and back again


def test_pockets_and_seams_are_the_fronts_alone() -> None:
    rgb = woven()
    rgb[80:150, 108:111] = rgb[80:150, 49:52] = WHITE
    rgb[150:153, 45:60] = rgb[150:153, 100:115] = (30, 45, 35)
    assert off(back(rgb), CLOTH)[INSIDE].max() < 16


def test_folds_at_the_sides_make_no_bands_behind() -> None:
    """Creases, 2 cm high: dark ones at other heights on either side, faint ones at the same."""
    seen, angle = round_trunk()
    for first in (40, 90, 140):
        seen[first : first + 4, :50] += 40
        seen[first + 20 : first + 24, 70:] += 40
        seen[first + 35 : first + 39, :50] += 12
        seen[first + 35 : first + 39, 70:] += 12
    behind = cloth_behind(seen, np.ones((200, 120), np.bool_), angle, 0.005)
    assert np.ptp(behind[10:190, 60].mean(-1)) < 5


def test_hair_over_both_shoulders_is_not_on_the_back() -> None:
    rgb = dressed()
    hair = np.zeros_like(TRUNK)
    hair[60:110, 30:62] = hair[60:110, 98:130] = True
    rgb[hair] = RED
    found = back(rgb, TRUNK, hair)
    assert off(found, CLOTH)[TRUNK].max() < 6


def test_where_arms_cross_cloth_goes_over_from_its_light_above_into_its_shade_below() -> None:
    """Beside the arms it is in their shadow."""
    seen, angle = round_trunk()
    seen[:80] *= 1.6
    seen[72:80] *= 0.6
    seen[120:126] *= 0.6
    known = np.ones((200, 120), np.bool_)
    known[80:120] = False
    behind = cloth_behind(seen, known, angle, 0.005).mean(1)
    np.testing.assert_allclose(behind[[20, 180]], [[48, 80, 240], [30, 50, 150]], atol=3)
    assert np.abs(np.diff(behind, axis=0)).max() < 4, "no edge, and no band that is darker than both"
    assert (np.diff(behind[:, 2]) < 1).all()


def test_where_arms_cross_between_two_garments_each_goes_on_half_the_way() -> None:
    seen, angle = round_trunk()
    seen[:80] = WHITE
    known = np.ones((200, 120), np.bool_)
    known[80:120] = False
    behind = cloth_behind(seen, known, angle, 0.005)
    for rows, colour in ((slice(10, 96), WHITE), (slice(104, 190), (30, 50, 150))):
        assert np.abs(behind[rows] - colour).max() < 6


def test_a_trunk_without_a_neck_has_no_neckline() -> None:
    trunk = TRUNK.copy()
    trunk[60:80, :60] = trunk[60:80, 100:] = False
    rgb = dressed()
    rgb[60:80] = WHITE
    found = with_trunk_back(rgb, trunk, trunk, NOBODY, HEAD, 1.0, necked=False)
    assert off(found, WHITE)[64:76, 64:96].max() < 6
    found = with_trunk_back(rgb, trunk, trunk, NOBODY, HEAD, 1.0)
    assert off(found, CLOTH)[64:76, 64:96].max() < 6
