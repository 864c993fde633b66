"""Speech without sound: sentences as phonemes, phonemes as shapes of the mouth that melt into each other.

Shapes follow each other as in M. Cohen, D. Massaro, Modeling Coarticulation in Synthetic Visual Speech, 1993: each
phoneme pulls at the mouth around its own time. It pulls the more, the more its shape matters (lips that must meet, do).
What is seen is the mean of all, weighted by their pull. Stress carries brows and head along, as in real talk.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from engine.performances.catalogue import performance
from engine.performances.modelling.figure import Pose
from engine.performances.scores.acting import Units, add, add_both_sides, head_sway, lids, pose, sum_turns
from engine.performances.scores.timing import blink, ease, glances, swell

MOUTH_SHAPES: Mapping[str, Mapping[str, float]] = {
    "_": {},
    "p": {"mouthPress": 0.34, "mouthRollLower": 0.26, "mouthRollUpper": 0.18, "jawOpen": 0.01},
    "f": {"mouthRollLower": 0.46, "mouthUpperUp": 0.22, "jawOpen": 0.07},
    "t": {"jawOpen": 0.13, "mouthLowerDown": 0.14, "mouthUpperUp": 0.06},
    "s": {"jawOpen": 0.07, "mouthStretch": 0.24, "mouthLowerDown": 0.26, "mouthUpperUp": 0.10},
    "sh": {"jawOpen": 0.08, "mouthFunnel": 0.58, "mouthPucker": 0.12},
    "k": {"jawOpen": 0.17, "mouthLowerDown": 0.12, "mouthStretch": 0.08},
    "r": {"jawOpen": 0.15, "mouthFunnel": 0.34, "mouthPucker": 0.12},
    "l": {"jawOpen": 0.22, "mouthLowerDown": 0.12, "mouthUpperUp": 0.06},
    "w": {"jawOpen": 0.08, "mouthPucker": 0.62, "mouthFunnel": 0.18},
    "a": {"jawOpen": 0.46, "mouthLowerDown": 0.20, "mouthUpperUp": 0.10},
    "e": {"jawOpen": 0.30, "mouthStretch": 0.26, "mouthSmile": 0.12, "mouthLowerDown": 0.20},
    "i": {"jawOpen": 0.15, "mouthStretch": 0.38, "mouthSmile": 0.20, "mouthLowerDown": 0.20},
    "o": {"jawOpen": 0.32, "mouthFunnel": 0.48, "mouthPucker": 0.12},
    "u": {"jawOpen": 0.12, "mouthPucker": 0.56, "mouthFunnel": 0.28},
    "@": {"jawOpen": 0.22, "mouthLowerDown": 0.12},
}
"""The mouth of each phoneme, by face units; a unit without a side acts on both. `_` is silence, `@` the schwa."""

PHONEME_PULLS: Mapping[str, float] = {"p": 6.0, "f": 4.0, "w": 2.5, "sh": 2.2, "u": 1.8, "o": 1.6, "_": 2.0}
"""How much a shape matters; 1 for all others."""

PULL_SECONDS = 0.080
"""Seconds over which the pull of a phoneme falls off: about half its usual length."""


@dataclass(frozen=True)
class Phoneme:
    """A sound: its shape, the time of its middle, seconds, and whether it bears the stress."""

    shape: str
    at: float
    stressed: bool


def spell(text: str, start: float, tempo: float = 1.0) -> tuple[Phoneme, ...]:
    """Phonemes from a spelling: shapes divided by blanks, `'` before one that is stressed, `,` for a pause.

    Vowels take 0.13 s, under stress 0.20, consonants 0.085, a pause 0.26, divided by `tempo`.
    """
    said, at = [], start
    for sign in text.split():
        stressed, shape = sign.startswith("'"), sign.lstrip("'").replace(",", "_")
        length = {"_": 0.26}.get(shape, 0.13 if shape in "aeiou@" else 0.085) + (0.07 if stressed else 0.0)
        length /= tempo
        said.append(Phoneme(shape, at + length / 2, stressed))
        at += length
    return tuple(said)


CALM_SENTENCE = "w 'e l , a i t i k , w i k @ t r 'a i p l i s"
"""About: well, I think we could try, please."""

EAGER_SENTENCE = "l 'u k , t i s i s 'i r i l i p 'i k , 'w a u"
"""About: look, this is really big, wow."""


def talk(t: float) -> Pose:
    """A calm sentence: small beats of the head, brows that stress a word, blinks at the pauses."""
    seconds = performance("talk").seconds
    said = spell(CALM_SENTENCE, 0.25)
    units: Units = {}
    _mouth(units, t, said, seconds, force=0.85)
    beat = _stress(t, said)
    add_both_sides(units, "browOuterUp", 0.16 * beat)
    add(units, "browInnerUp", 0.12 * beat + 0.12 * swell(t, 1.5, 1.9, 2.4, 3.0))
    add_both_sides(units, "mouthSmile", 0.10 * swell(t, 0.2, 0.7, seconds - 0.9, seconds - 0.25))
    lids(units, blink(t, 0.58) + blink(t, 2.72), lead=0.02)
    head = sum_turns(
        (1.7 * beat - 0.6 * swell(t, 0.1, 0.5, 0.8, 1.5), 1.8 * swell(t, 1.0, 1.6, 2.1, 2.9), 0.0),
        (0.0, 0.0, 1.2 * swell(t, 1.8, 2.3, 2.7, 3.3)),
        head_sway(t, 401, seconds, 0.8),
    )
    gaze = glances(t, ((-1, 0, 0), (0.62, 0.6, -2.4), (1.25, 0.0, 0.4), (2.12, -0.8, 2.6), (2.75, 0, 0)))
    return pose(units, head, gaze, 0.4 * swell(t, 0.0, 0.4, 0.6, 2.4), (0.0, 0.0, 0.0015 * beat))


def talk_strong(t: float) -> Pose:
    """An eager one: the mouth articulates, brows and head underline every stress."""
    seconds = performance("talk-strong").seconds
    said = spell(EAGER_SENTENCE, 0.25, tempo=1.04)
    units: Units = {}
    _mouth(units, t, said, seconds, force=1.25)
    beat = _stress(t, said)
    add_both_sides(units, "browOuterUp", 0.42 * beat)
    add(units, "browInnerUp", 0.34 * beat)
    add_both_sides(units, "eyeWide", 0.20 * beat)
    add_both_sides(units, "mouthSmile", 0.12 * swell(t, 0.3, 0.9, seconds - 0.9, seconds - 0.25))
    lids(units, blink(t, 0.62) + blink(t, 2.34), lead=0.02)
    head = sum_turns(
        (3.0 * beat, -3.0 * swell(t, 0.9, 1.4, 1.9, 2.5), -1.8 * swell(t, 1.2, 1.8, 2.3, 3.1)),
        (0.0, 2.6 * swell(t, 2.0, 2.4, 2.6, 3.2), 0.0),
        head_sway(t, 411, seconds, 1.1),
    )
    gaze = glances(t, ((-1, 0, 0), (0.66, 0.4, 2.0), (1.10, 0, 0), (2.36, 0.8, -2.2), (2.9, 0, 0)))
    return pose(units, head, gaze, 0.6 * swell(t, 0.0, 0.4, 0.6, 2.4), (0.0, 0.0, 0.003 * beat))


def _mouth(units: Units, t: float, said: tuple[Phoneme, ...], seconds: float, force: float) -> None:
    """The mouth at a time: the mean of all shapes, weighted by their pull."""
    ends = (Phoneme("_", said[0].at - 0.18, False), *said, Phoneme("_", said[-1].at + 0.20, False))
    pulls = [PHONEME_PULLS.get(one.shape, 1.0) * math.exp(-(((t - one.at) / PULL_SECONDS) ** 2)) for one in ends]
    before, after = said[0].at - 0.2, said[-1].at + 0.24
    speaking = ease(t, before, before + 0.16) * (1 - ease(t, after - 0.12, after + 0.10))
    total = sum(pulls) + 1e-9
    for one, pull in zip(ends, pulls, strict=True):
        louder = 1.16 if one.stressed else 0.96
        for name, weight in MOUTH_SHAPES[one.shape].items():
            amount = force * louder * speaking * weight * pull / total
            if name.startswith(("mouthPress", "mouthStretch", "mouthSmile", "mouthUpperUp", "mouthLowerDown")):
                add_both_sides(units, name, amount, right=0.96)
            else:
                add(units, name, amount)


def _stress(t: float, said: tuple[Phoneme, ...]) -> float:
    """How much of a stress there is at a time [0, 1]: gestures come a little before the vowel."""
    return min(sum(swell(t, s.at - 0.24, s.at - 0.03, s.at + 0.03, s.at + 0.36) for s in said if s.stressed), 1.0)
