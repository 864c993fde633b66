"""What the names of joints say, in the habits of the programs that write them.

Known habits: Mixamo (`mixamorig:LeftUpLeg`), MotionBuilder (`Character1_LeftUpLeg`), CMU in two spellings (`LeftUpLeg`,
`LeftHip`), Bandai (`UpperLeg_L`), MakeHuman (`UpLeg_L`), Blender (`thigh.L`), Unreal (`thigh_l`), 3ds Max (`Bip01 L
Thigh`), VRM (`J_Bip_L_UpperLeg`), Poser (`lThigh`). What most names of a skeleton have in common before or behind the
word that tells them apart says nothing of a joint. It is a program's name, a character's, or a number.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from engine.geometry.rigging.joint_names import FINGER_NAMES, SIDE_NAMES

SIDED_JOINTS = ("Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase")

TARGET_NAMES: tuple[str, ...] = (
    *("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"),
    *(f"{side}{part}" for side in SIDE_NAMES for part in SIDED_JOINTS),
    *(f"{side}Hand{f}{n}" for side in SIDE_NAMES for f in FINGER_NAMES for n in (1, 2, 3)),
)
"""The joints of our skeletons that a motion can move, by their Mixamo names."""

_JOINT_WORDS: Mapping[str, tuple[str, ...]] = {
    "Hips": ("hips", "hip", "pelvis"),
    "Neck": ("neck", "lowerneck"),
    "Head": ("head", "skull"),
    "Shoulder": ("shoulder", "clavicle", "collar", "collarbone", "clav"),
    "Arm": ("arm", "uparm", "upperarm", "shldr", "humerus", "bicep"),
    "ForeArm": ("forearm", "loarm", "lowerarm", "lowarm", "elbow"),
    "Hand": ("hand", "wrist"),
    "UpLeg": ("upleg", "upperleg", "thigh", "hip", "femur"),
    "Leg": ("leg", "loleg", "lowerleg", "lowleg", "calf", "shin", "knee"),
    "Foot": ("foot", "ankle"),
    "ToeBase": ("toebase", "toe", "toes", "ball"),
}
_KNOWN_WORDS = frozenset(word for group in _JOINT_WORDS.values() for word in group)
_SIDES = {"left": "Left", "l": "Left", "right": "Right", "r": "Right"}
_FINGER = re.compile(
    r"(?:hand)?f?(thumb|index|middle|mid|ring|pinky|pinkie|little)(?:finger)?(proximal|intermediate|distal)?"
)
_FINGER_NAMES = {"mid": "Middle", "pinkie": "Pinky", "little": "Pinky"}
_PHALANGES = {"proximal": 1, "intermediate": 2, "distal": 3}
_PREFIX = re.compile(
    r"^(?:.*[:|]|character\d*_|(?:j_)?bip(?:ed)?\d*[ _]|valvebiped_?|def[-_]|org[-_]|bone[-_]|joint_|jnt_|j_)", re.I
)
COMMON_AFFIX_SHARE = 0.6
"""The share of names that begin or end alike for that to say nothing: neither side of a body has so many joints."""

MIN_NAMES_ALIKE = 5
"""What fewer names have in common is no habit of the file."""

COUNTER_SHARE = 0.8
"""The share of different numbers among those behind names, from which on they count the joints of the file."""


@dataclass(frozen=True)
class ParsedName:
    """What a name says: the side ("Left", "Right" or ""), the words in small letters, the number behind them, and how that is
    written."""

    side: str
    words: str
    number: int
    digits: str = ""


def read_name(name: str) -> ParsedName:
    """Take a joint's name apart."""
    return _spoken(_tokens(name))


def _tokens(name: str) -> list[str]:
    """The words and numbers of a name, in small letters, without what known programs write before it."""
    before = None
    while before != name:
        before, name = name, _PREFIX.sub("", name) or name
    split = re.sub(r"([a-z0-9])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3 \2\4", name)
    return [token.lower() for token in re.findall(r"[A-Za-z]+|\d+", split)]


def _without_common(names: list[list[str]]) -> list[list[str]]:
    """Names, as their tokens, without what most of them begin with or end in."""
    names = _without_counts(names)
    for end in (0, -1):
        while len(names) >= MIN_NAMES_ALIKE:
            word, times = Counter(name[end] for name in names if name).most_common(1)[0]
            if (
                times < COMMON_AFFIX_SHARE * len(names)
                or word in _SIDES
                or word in _KNOWN_WORDS
                or _FINGER.fullmatch(word)
            ):
                break
            shorter = [
                (name[1:] if end == 0 else name[:-1]) if len(name) > 1 and name[end] == word else name for name in names
            ]
            if shorter == names:  # it is all that most have
                break
            names = shorter
    return names


def _without_counts(names: list[list[str]]) -> list[list[str]]:
    """Without the numbers behind names, where these count through all joints."""
    numbers = [name[-1] for name in names if len(name) > 1 and name[-1].isdigit()]
    if len(numbers) < max(COMMON_AFFIX_SHARE * len(names), MIN_NAMES_ALIKE) or len(set(numbers)) < COUNTER_SHARE * len(
        numbers
    ):
        return names
    return [name[:-1] if len(name) > 1 and name[-1].isdigit() else name for name in names]


def _spoken(tokens: Sequence[str]) -> ParsedName:
    digits = tokens[-1] if tokens and tokens[-1].isdigit() else ""
    if not int(digits or 0):
        digits = next((token for token in tokens if token.isdigit() and len(token) < 4), digits)
    number = int(digits or 0) if len(digits) < 9 else 0
    words = [word for word in tokens if not word.isdigit() and word != "c"]  # c: centre
    side = ""
    for token, meaning in _SIDES.items():
        if token in words:
            side = meaning
            words.remove(token)
            break
    joined = "".join(words)
    if not side:
        for start, meaning in (("left", "Left"), ("right", "Right"), ("l", "Left"), ("r", "Right")):
            rest = joined.removeprefix(start)
            if rest != joined and (rest in _KNOWN_WORDS or _FINGER.fullmatch(rest)):
                return ParsedName(meaning, rest, number, digits)
    return ParsedName(side, joined, number, digits)


def match_names(names: Sequence[str]) -> dict[str, int]:
    """`{our joint: index of the source's joint}` for those whose names are understood; the spine is left out, for
    its names say little about which joint is where."""
    told = [index for index, name in enumerate(names) if not name.startswith("__")]
    tokens = _without_common([_tokens(names[index]) for index in told])
    spoken: list[ParsedName | None] = [None] * len(names)
    for index, of in zip(told, tokens, strict=True):
        spoken[index] = _spoken(of)
    found: dict[str, int] = {}
    fingers: dict[tuple[str, str], list[tuple[int, int]]] = {}
    for index, said in enumerate(spoken):
        if said is None:
            continue
        if said.side and said.words == "finger" and 0 < len(said.digits) < 3 and said.digits[0] in "01234":
            # 3ds Max: Finger0, Finger01, Finger02 are the thumb, Finger1, Finger11, Finger12 the index finger
            label, phalanx = FINGER_NAMES[int(said.digits[0])], int(said.digits[1:] or 0) + 1
            fingers.setdefault((said.side, label), []).append((phalanx, index))
            continue
        if said.side and (finger := _FINGER.fullmatch(said.words)):
            label = _FINGER_NAMES.get(finger.group(1), finger.group(1).capitalize())
            phalanx = _PHALANGES.get(finger.group(2) or "", said.number)
            fingers.setdefault((said.side, label), []).append((phalanx, index))
            continue
        for part, words in _JOINT_WORDS.items():
            sided = part in SIDED_JOINTS
            if said.words in words and sided == bool(said.side) and (sided or said.number <= 1 or part != "Head"):
                found.setdefault(said.side + part, index)
                break
    for side in SIDE_NAMES:
        _tell_shoulders(spoken, side, found)
    for (hand, label), joints in fingers.items():
        for phalanx, index in joints:
            if phalanx in (1, 2, 3):
                found.setdefault(f"{hand}Hand{label}{phalanx}", index)
    return found


def _tell_shoulders(spoken: Sequence[ParsedName | None], side: str, found: dict[str, int]) -> None:
    """`LeftShoulder` is the collar bone beside a `LeftArm`, but the upper arm beside a `LeftCollar` or alone."""
    here = {said.words: index for index, said in enumerate(spoken) if said and said.side == side}
    if f"{side}Arm" in found or "shoulder" not in here:
        return
    found[f"{side}Arm"] = here["shoulder"]
    collar = next((here[word] for word in _JOINT_WORDS["Shoulder"][1:] if word in here), None)
    if collar is None:
        found.pop(f"{side}Shoulder", None)
    else:
        found[f"{side}Shoulder"] = collar
