"""Hair around a face and down the body: told from skin and clothes, and hanging from hair above it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.figure.face_region import within_oval
from engine.character.hair.mask import hair_mask
from engine.character.hair.regions import FACE_SHARE, TemplateHead

SHAPE = (200, 140)
FACE = np.array([70.0, 60.0, 20.0, 28.0, 0.0])
SKIN, HAIR, SHIRT, HAT = (215, 170, 145), (50, 34, 26), (225, 225, 220), (160, 30, 40)
Y, X = np.mgrid[: SHAPE[0], : SHAPE[1]]
ASIDE = np.abs(X - 70)
OVAL = within_oval(FACE * [1, 1, FACE_SHARE, FACE_SHARE, 1], SHAPE)
EARS = np.hypot((ASIDE - 25) / 3, (Y - 60) / 9) < 1
NECK = (ASIDE < 11) & (Y > 60) & (Y < 104)
TEMPLATE = TemplateHead((np.hypot((X - 70) / 24, (Y - 54) / 38) < 1) | NECK | EARS, EARS, FACE)
TRUNK = (ASIDE < 50) & (Y >= 100)
CAP = (np.hypot((X - 70) / 29, (Y - 52) / 44) < 1) & (Y < 52) & ~OVAL
"""Short hair."""
BOB = CAP | ((ASIDE < 30) & (Y >= 52) & (Y < 100) & ~OVAL & ~NECK)
LOCK = (ASIDE > 18) & (ASIDE < 30) & (Y >= 100) & (Y < 140)
"""What falls on over both shoulders."""


def found(
    *painted: tuple[NDArray[np.bool_], tuple[int, int, int]],
    shirt: tuple[int, int, int] = SHIRT,
    head: NDArray[np.bool_] | None = None,
) -> NDArray[np.bool_]:
    """The hair that is found where areas are painted over somebody bald, one over the other; the `head` is they and the template's above the trunk."""
    rgb = np.full((*SHAPE, 3), 240.0)
    for area, colour in ((TRUNK, shirt), (TEMPLATE.covered, SKIN), *painted):
        rgb[area] = colour
    noisy = np.clip(rgb + np.random.default_rng(1).normal(0, 4, rgb.shape), 0, 255).astype(np.uint8)
    own = np.logical_or.reduce([TEMPLATE.covered, *(area for area, _ in painted)]) & (Y < 100) if head is None else head
    return hair_mask(noisy, own, TRUNK & ~own, TEMPLATE)


def alike(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> float:
    return float((one & other).sum() / (one | other).sum())


def test_hair_is_told_from_the_face_and_the_neck() -> None:
    assert alike(found((BOB, HAIR)), BOB) > 0.95
    assert not found().any(), "nothing is loose"


def test_what_hangs_from_no_hair_is_none() -> None:
    """A clasp of hair's colour at the collar, and the flap of a hood, of a colour that is nowhere else, from below an ear to the shoulder."""
    clasp = np.hypot(X - 102, Y - 93) < 6
    assert alike(found((CAP, HAIR), (clasp, HAIR)), CAP) > 0.95
    flap = (X > 82) & (X < 108) & (Y > 74) & (Y < 100) & ~OVAL
    assert alike(found((CAP, HAIR), (flap, (150, 150, 160))), CAP) > 0.95


def test_hair_comes_out_below_an_ear() -> None:
    behind = (ASIDE > 20) & (ASIDE < 29) & (Y >= 66) & (Y < 96) & ~EARS & ~OVAL
    short = CAP & (Y < 50)
    shown = found((short, HAIR), (behind, HAIR), (EARS, SKIN))
    assert shown[behind].mean() > 0.85 and not shown[EARS].any()


@pytest.mark.parametrize(("shirt", "is_found"), [(SHIRT, True), (HAIR, False)], ids=["on white", "on its own colour"])
def test_it_is_followed_down_the_shoulders_where_they_have_other_colours(
    shirt: tuple[int, int, int], is_found: bool
) -> None:
    shown = found((BOB, HAIR), (LOCK, HAIR), shirt=shirt, head=TEMPLATE.covered | BOB)
    assert alike(shown, BOB | LOCK if is_found else BOB) > 0.9


def test_above_the_mouth_a_head_wears_no_shirt() -> None:
    """A strand of the shirt's colour beside the forehead."""
    strand = CAP & (Y > 32) & (ASIDE > 19) & (ASIDE < 24)
    shown = found((BOB, HAIR), (strand, SHIRT))
    assert strand.sum() > 30 and shown[strand].mean() > 0.9


def test_the_edge_of_a_hood_that_touches_hair_is_no_hair() -> None:
    """In the colour of the clothes, from the brow down, off the template's head."""
    edge = (ASIDE > 27) & (ASIDE < 36) & (Y > 48) & (Y < 100)
    shown = found((CAP, HAIR), (edge, (70, 90, 130)), shirt=(70, 90, 130))
    assert alike(shown, CAP & ~edge) > 0.9 and shown[edge].mean() < 0.1


def test_hair_below_a_hat_has_another_colour() -> None:
    hat, fair = CAP & (Y < 45), (200, 165, 110)
    shown = found((BOB, fair), (hat, HAT))
    assert alike(shown, BOB) > 0.9


def test_bare_shoulders_are_no_hair() -> None:
    """In shadow, above a black dress: nearer to hair than clothes are, and they go on from it."""
    shoulders = TRUNK & (Y < 125)
    shown = found(
        (shoulders, (150, 112, 92)),
        (BOB, HAIR),
        (NECK, (180, 140, 118)),
        shirt=(25, 25, 30),
        head=TEMPLATE.covered | BOB,
    )
    assert not shown[Y >= 104].any()


def test_a_forehead_is_skin_as_high_as_it_is_seen() -> None:
    """Hair combed back: bare skin above the face's oval, up to a hairline near the crown."""
    bare = (np.hypot((X - 70) / 17, (Y - 46) / 26) < 1) & (Y < 46)
    shown = found((BOB, HAIR), (bare & CAP, SKIN))
    assert (bare & CAP & (Y < 60 - 28)).sum() > 200
    assert not shown[bare & CAP].any() and alike(shown, BOB & ~bare) > 0.93


def test_temples_are_skin_and_a_crown_is_hair() -> None:
    """Dark hair with a bare temple beside the oval above the brow; and one whose crown shines in the skin's own colour."""
    temple = BOB & TEMPLATE.covered & (Y < 52) & (Y > 38) & (ASIDE < 23)
    shown = found((BOB, HAIR), (temple, SKIN))
    assert temple.sum() > 30 and shown[temple].mean() < 0.2
    fair = (205, 165, 130)
    shown = found((BOB, fair))
    assert shown[BOB & (Y < 52)].mean() > 0.9, "of the skin's colours, too"
    crown = CAP & (Y < 30)
    shown = found((BOB, HAIR), (crown, SKIN))
    assert shown[crown].mean() > 0.95


def test_a_coat_of_its_colour_is_no_hair() -> None:
    """It goes on from the hair without a border."""
    coat = TRUNK & (Y < 180)
    shown = found((coat, HAIR), (BOB, HAIR), head=TEMPLATE.covered | BOB)
    assert not shown[Y >= 100].any() and alike(shown, BOB) > 0.9


def test_at_the_throat_no_hair_falls() -> None:
    scarf = TRUNK & (Y < 130) & (ASIDE < 32)
    shown = found((scarf, HAIR), (BOB, HAIR), head=TEMPLATE.covered | BOB)
    assert not shown[(ASIDE < 7) & (Y >= 104)].any()
