"""Filmed and painted colours of a hand, made one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.texture.template_surface import TemplateSurface, template_surface
from engine.avatar.texture.template_texture.hand_joining import HandSurface, joined_hand
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template
from engine.imaging.histogram_matching import to_lab
from engine.performances.modelling.hands import HandBones, hand_bones
from engine.render.textures.texture_bake import texel_raster

SKIN, BLUE, GREEN = np.array([205.0, 160, 135]), np.array([60.0, 90, 160]), np.array([90.0, 150, 70])
TONE = to_lab(SKIN)[0]
FINE, COARSE = 900.0, 200.0
"""Pixels per metre: of a film of 1,400 lines, and of one of 300."""


class KnownHand(NamedTuple):
    surface: TemplateSurface
    bones: HandBones
    alone: HandSurface
    texels: PartTexels
    along: NDArray[np.float64]
    """(T,) metres of the surface's faces past the wrist."""

    def joined(self, filmed: NDArray, painted: NDArray, resolution: NDArray) -> NDArray[np.float64]:
        return joined_hand(self.alone, self.texels, filmed, painted, resolution, TONE)

    @property
    def at(self) -> NDArray[np.float64]:
        """(N,) metres of the texels past the wrist."""
        return self.along[self.texels.triangles]

    def stripes(self) -> NDArray[np.float64]:
        """(N, 3) details of 3 mm and mean 0."""
        places = self.texels.blend(self.surface.rest, self.surface.triangles)
        return 12 * np.sign(np.sin(2 * np.pi * places[:, [0]] / 0.003)).repeat(3, 1)


@pytest.fixture(scope="module")
def hand() -> KnownHand:
    rig = load_rig(HUMAN_RIG)
    surface = template_surface(load_template(), rig)
    bones = hand_bones(rig, surface.rest, "Left")
    texels = PartTexels.of(texel_raster(surface.atlas, 1024), surface.hands["Left"])
    alone = HandSurface.of(surface.rest, surface.triangles, surface.hands["Left"], bones)
    along = (surface.rest[surface.triangles].mean(1) - bones.wrist) @ bones.along
    return KnownHand(surface, bones, alone, texels, along)


def test_what_a_fine_film_shows_is_kept_and_the_rest_takes_its_tone_without_an_edge(hand: KnownHand) -> None:
    filmed = SKIN + hand.stripes()
    painted = np.tile(SKIN - [30, 20, 10], (len(filmed), 1))
    resolution = np.where(hand.along < 0.09, FINE, 0)
    found = hand.joined(np.where((hand.at < 0.09)[:, None], filmed, 0), painted, resolution)
    np.testing.assert_allclose(found[hand.at < 0.06], filmed[hand.at < 0.06], atol=1)
    beyond = found[hand.at > 0.11]
    assert np.abs(beyond - SKIN).max() < 6  # not what was painted, by 30; of stripes there is nothing
    assert np.abs(beyond - SKIN).mean() < 2


def test_a_coarse_film_gives_the_tone_and_what_is_painted_the_details(hand: KnownHand) -> None:
    painted = SKIN - [30, 20, 10] + hand.stripes()
    filmed = np.tile(SKIN, (len(painted), 1))
    found = hand.joined(filmed, painted, np.full(len(hand.along), COARSE))
    assert np.abs(found - (SKIN + hand.stripes())).mean() < 3


def test_a_sleeve_over_the_wrist_stays_and_a_lawn_behind_fingers_does_not(hand: KnownHand) -> None:
    at = hand.at
    filmed = np.where((at < 0.03)[:, None], BLUE, np.where((at > 0.13)[:, None], GREEN, SKIN))
    painted = np.tile(SKIN, (len(filmed), 1))
    found = hand.joined(filmed, painted, np.full(len(hand.along), FINE))
    np.testing.assert_allclose(found[at < 0.022], filmed[at < 0.022], atol=1)
    assert np.abs(found[at > 0.04] - SKIN).max() < 8


def test_a_pocket_before_one_side_of_the_palm_is_no_sleeve(hand: KnownHand) -> None:
    places = hand.texels.blend(hand.surface.rest, hand.surface.triangles)
    across = (places - hand.bones.wrist) @ np.cross(hand.bones.along, hand.bones.back)
    filmed = np.where(((hand.at < 0.06) & (across > 0.01))[:, None], BLUE, SKIN)
    found = hand.joined(filmed, np.tile(SKIN, (len(filmed), 1)), np.full(len(hand.along), FINE))
    assert np.abs(found[hand.at > 0.02] - SKIN).max() < 8
