"""What the names of joints say, in the habits of the programs that write them.

Known habits: Mixamo (`mixamorig:LeftUpLeg`), MotionBuilder (`Character1_LeftUpLeg`), CMU in two spellings
(`LeftUpLeg`, `LeftHip`), Bandai (`UpperLeg_L`), MakeHuman (`UpLeg_L`), Blender (`thigh.L`), Unreal (`thigh_l`), 3ds Max
(`Bip01 L Thigh`), VRM (`J_Bip_L_UpperLeg`), Poser (`lThigh`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

FINGERS = ("Thumb", "Index", "Middle", "Ring", "Pinky")

SIDED = ("Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase")

TARGET_NAMES: tuple[str, ...] = (
    *("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"),
    *(f"{side}{part}" for side in ("Left", "Right") for part in SIDED),
    *(f"{side}Hand{f}{n}" for side in ("Left", "Right") for f in FINGERS for n in (1, 2, 3)),
)
"""The joints of our skeletons that a motion can move, by their Mixamo names."""

_WORDS: Mapping[str, tuple[str, ...]] = {
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
_FINGER = re.compile(
    r"(?:hand)?(thumb|index|middle|mid|ring|pinky|pinkie|little)(?:finger)?(proximal|intermediate|distal)?"
)
_FINGER_NAMES = {"mid": "Middle", "pinkie": "Pinky", "little": "Pinky"}
_PHALANGES = {"proximal": 1, "intermediate": 2, "distal": 3}
_PREFIX = re.compile(
    r"^(?:.*[:|]|character\d*_|(?:j_)?bip(?:ed)?\d*[ _]|valvebiped_?|def[-_]|org[-_]|bone[-_]|joint_|jnt_|j_)", re.I
)


@dataclass(frozen=True)
class Spoken:
    """What a name says: the side ("Left", "Right" or ""), the words in small letters, and the number behind them."""

    side: str
    words: str
    number: int


def read_name(name: str) -> Spoken:
    """Take a joint's name apart."""
    before = None
    while before != name:
        before, name = name, _PREFIX.sub("", name) or name
    split = re.sub(r"([a-z0-9])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3 \2\4", name)
    tokens = [token.lower() for token in re.findall(r"[A-Za-z]+|\d+", split)]
    number = int(tokens[-1]) if tokens and tokens[-1].isdigit() else 0
    if not number:
        number = next((int(token) for token in tokens if token.isdigit() and len(token) < 4), 0)
    words = [word for word in tokens if not word.isdigit() and word != "c"]  # c: centre
    side = ""
    for token, meaning in (("left", "Left"), ("l", "Left"), ("right", "Right"), ("r", "Right")):
        if token in words:
            side = meaning
            words.remove(token)
            break
    joined = "".join(words)
    known = {word for group in _WORDS.values() for word in group}
    if not side:
        for start, meaning in (("left", "Left"), ("right", "Right"), ("l", "Left"), ("r", "Right")):
            rest = joined.removeprefix(start)
            if rest != joined and (rest in known or _FINGER.fullmatch(rest)):
                return Spoken(meaning, rest, number)
    return Spoken(side, joined, number)


def match_names(names: Sequence[str]) -> dict[str, int]:
    """`{our joint: index of the source's joint}` for those whose names are understood; the spine is left out, for
    its names say little about which joint is where."""
    spoken = [None if name.startswith("__") else read_name(name) for name in names]
    found: dict[str, int] = {}
    fingers: dict[tuple[str, str], list[tuple[int, int]]] = {}
    for index, said in enumerate(spoken):
        if said is None:
            continue
        if said.side and (finger := _FINGER.fullmatch(said.words)):
            label = _FINGER_NAMES.get(finger.group(1), finger.group(1).capitalize())
            phalanx = _PHALANGES.get(finger.group(2) or "", said.number)
            fingers.setdefault((said.side, label), []).append((phalanx, index))
            continue
        for part, words in _WORDS.items():
            sided = part in SIDED
            if said.words in words and sided == bool(said.side) and (sided or said.number <= 1 or part != "Head"):
                found.setdefault(said.side + part, index)
                break
    for side in ("Left", "Right"):
        _tell_shoulders(spoken, side, found)
    for (side, label), joints in fingers.items():
        for phalanx, index in joints:
            if phalanx in (1, 2, 3):
                found.setdefault(f"{side}Hand{label}{phalanx}", index)
    return found


def _tell_shoulders(spoken: Sequence[Spoken | None], side: str, found: dict[str, int]) -> None:
    """`LeftShoulder` is the collar bone beside a `LeftArm`, but the upper arm beside a `LeftCollar` or alone."""
    here = {said.words: index for index, said in enumerate(spoken) if said and said.side == side}
    if f"{side}Arm" in found or "shoulder" not in here:
        return
    found[f"{side}Arm"] = here["shoulder"]
    collar = next((here[word] for word in _WORDS["Shoulder"][1:] if word in here), None)
    if collar is None:
        found.pop(f"{side}Shoulder", None)
    else:
        found[f"{side}Shoulder"] = collar
