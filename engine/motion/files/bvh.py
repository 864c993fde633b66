"""Motion capture in BVH files, from any skeleton.

Programs do not agree on capitals, tabs and empty lines: words mean the same however they are spelt and spaced. The joints
are read line by line, after size and depth were looked at; the numbers of the frames by numpy.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.motion import rotation
from engine.motion.files.source_motion import (
    MAX_JOINT_DEPTH,
    MAX_JOINTS,
    MAX_MOTION_BYTES,
    MAX_MOTION_FRAMES,
    MAX_NUMBERS,
    Array,
    SourceMotion,
    unique_names,
)

CHANNEL_MEANINGS = {f"{axis}{kind}": (kind, axis) for kind in ("position", "rotation") for axis in "xyz"}
"""What channels mean by their names in small letters: programs do not agree on which letters are large."""

UNIT_METRES = {
    "metre": 1.0,
    "foot": 0.3048,
    "decimetre": 0.1,
    "CMU unit": 0.0254 / 0.45,
    "inch": 0.0254,
    "centimetre": 0.01,
    "millimetre": 0.001,
}

MAX_HIERARCHY_CHARACTERS = 1 << 20
"""Characters: 512 joints need a tenth of it."""

MAX_MAGNITUDE = 1e7
"""No number of a BVH file is larger: ten kilometres in millimetres."""

_MOTION_HEADER = re.compile(
    r"^[^\S\n]*+(?:MOTION\s++)?+Frames[\s:]*+(\S++)\s++Frame\s*+Time[\s:]*+(\S++)[^\S\n]*+$",
    re.MULTILINE | re.IGNORECASE,
)
"""The word itself is missing in some files; nothing is tried twice, however long it is."""


def read_bvh(source: Path | bytes, name: str = "") -> SourceMotion:
    """Read a BVH file, or its bytes.

    The unit is guessed from the skeleton's size (`guess_unit`); which way is up, BVH does not say.

    Raises
    ------
    InputError : `motion_unreadable`, `motion_truncated`, `motion_empty` (no frames), `motion_channels` (channels that
        BVH does not know), `motion_too_large`, `motion_not_finite`.
    """
    text = _read_text(source)
    found = _MOTION_HEADER.search(text, 0, MAX_HIERARCHY_CHARACTERS)
    if found is None:
        _refuse_text(text)
    assert found is not None
    joints = _read_hierarchy(text[: found.start()])
    parents = np.array([joint.parent for joint in joints], np.int32)
    channels = [
        (index, *CHANNEL_MEANINGS[channel.lower()]) for index, joint in enumerate(joints) for channel in joint.channels
    ]
    frames, fps = _frame_header(found.group(1), found.group(2))
    _require_few_numbers(frames, len(joints), len(channels))
    offsets = np.array([joint.offset for joint in joints], np.float64)
    ends = np.array([joint.end for joint in joints], np.float64)
    ends[parents[parents >= 0]] = np.nan
    values = _read_frames(text[found.end() :], frames, len(channels))
    rotations, translations = _to_local(values, channels, offsets)
    if not all((np.abs(numbers) < MAX_MAGNITUDE).all() for numbers in (values, offsets)):  # false for NaN as well
        raise InputError("motion_not_finite", "The BVH file holds numbers that are not finite: export it again.")
    unit, metres = guess_unit(parents, offsets, ends)
    return SourceMotion(
        name=name or (source.stem if isinstance(source, Path) else "motion"),
        fps=fps,
        names=unique_names(joint.name for joint in joints),
        parents=parents,
        rest_rotations=rotation.identity(len(joints)),
        rest_offsets=offsets,
        ends=ends,
        rotations=rotations,
        translations=translations,
        unit=unit,
        unit_metres=metres,
    )


def guess_unit(parents: NDArray[np.integer], offsets: Array, ends: Array) -> tuple[str, float]:
    """The file's unit, and its length in metres.

    From fingertip to toe along the bones a grown-up measures about 1.3 times their height: the unit is the one that
    makes this height most like 1.7 m. If none makes it lie between 1.2 and 2.2 m, the unit is `unknown`, and such that
    the person is 1.7 m tall.
    """
    height = _longest_way(parents, offsets, ends) / 1.3
    if height <= 0:
        return "unknown", float("nan")
    unit = min(UNIT_METRES, key=lambda key: abs(np.log(height * UNIT_METRES[key] / 1.7)))
    if 1.4 <= height * UNIT_METRES[unit] <= 2.1:
        return unit, UNIT_METRES[unit]
    return "unknown", 1.7 / height


def _longest_way(parents: NDArray[np.integer], offsets: Array, ends: Array) -> float:
    """The length of the longest way along bones from one joint to another; bones between the root and the first joint
    that branches only say where the person stood."""
    lengths = np.linalg.norm(offsets, axis=1)
    children = np.bincount(parents[parents >= 0], minlength=len(parents))
    joint = 0
    while children[joint] == 1:
        joint += 1
        lengths[joint] = 0
    deepest = np.nan_to_num(np.linalg.norm(ends, axis=1))
    longest = float(deepest.max(initial=0.0))
    for joint in range(len(parents) - 1, 0, -1):
        way, parent = deepest[joint] + lengths[joint], parents[joint]
        longest = max(longest, float(deepest[parent] + way))
        deepest[parent] = max(deepest[parent], way)
    return longest


@dataclass
class _Joint:
    """A joint as the hierarchy lists it."""

    name: str
    parent: int
    offset: tuple[float, ...] | None = None
    channels: list[str] = field(default_factory=list)
    end: tuple[float, ...] = (float("nan"),) * 3


def _read_text(source: Path | bytes) -> str:
    size = source.stat().st_size if isinstance(source, Path) else len(source)
    if size > MAX_MOTION_BYTES:
        raise InputError("motion_too_large", f"A motion file can have {MAX_MOTION_BYTES >> 20} MB: cut the recording.")
    data = source.read_bytes() if isinstance(source, Path) else source
    if b"\0" in data[:4096] or not re.match(rb"(\xef\xbb\xbf)?\s*HIERARCHY\b", data[:4096], re.I):
        raise InputError("motion_unreadable", "This is no BVH file: it must begin with the word HIERARCHY.")
    text = data.decode("utf-8-sig", errors="replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _refuse_text(text: str) -> None:
    if len(text) > MAX_HIERARCHY_CHARACTERS and not re.search(
        r"^[^\S\n]*+(?:MOTION|Frames)\b", text[:MAX_HIERARCHY_CHARACTERS], re.MULTILINE | re.IGNORECASE
    ):
        raise InputError("motion_too_large", f"A motion's skeleton can have {MAX_JOINTS} joints: use a simpler one.")
    raise InputError("motion_truncated", "The BVH file ends before its frames begin: export or upload it again.")


def _read_hierarchy(text: str) -> list[_Joint]:
    """The joints, parents before children."""
    lines = [line.split() for line in text.replace("{", "\n{\n").replace("}", "\n}\n").split("\n")]
    lines = [line for line in lines if line]
    heads = [line[0].upper() for line in lines]
    depths = np.cumsum([(head == "{") - (head == "}") for head in heads])
    if heads.count("JOINT") >= MAX_JOINTS or depths.max(initial=0) > MAX_JOINT_DEPTH:
        raise InputError("motion_too_large", f"A motion's skeleton can have {MAX_JOINTS} joints: use a simpler one.")
    if heads.count("ROOT") > 1:
        raise InputError("motion_unreadable", "The BVH file holds several skeletons: export each to a file of its own.")
    joints = _list_joints(lines, heads)
    unknown = sorted({name for joint in joints for name in joint.channels if name.lower() not in CHANNEL_MEANINGS})
    if unknown:
        raise InputError(
            "motion_channels", f"The BVH file has channels that BVH does not know, such as {unknown[0][:40]!r}."
        )
    return joints


_BONE_END = -1
"""In the place of a joint's number: where a bone ends."""


def _list_joints(lines: list[list[str]], heads: list[str]) -> list[_Joint]:
    """The joints of lines, which begin with `heads`."""
    joints: list[_Joint] = []
    open_: list[int] = []
    named: int | None = None
    for line, head in zip(lines, heads, strict=True):
        inside = open_[-1] if open_ else None
        if (named is None) == (head == "{"):
            raise _broken()
        if head == "{":
            open_.append(named if named is not None else _BONE_END)
            named = None
        elif head == "}" and inside is not None:
            open_.pop()
        elif head in ("END", "ENDSITE") and inside not in (None, _BONE_END):
            named = _BONE_END
        elif (
            head in ("ROOT", "JOINT") and (inside is None) == (head == "ROOT") and inside != _BONE_END and len(line) > 1
        ):
            named = len(joints)
            joints.append(_Joint("_".join(line[1:]), -1 if inside is None else inside))
        elif head == "OFFSET" and inside == _BONE_END:
            joints[open_[-2]].end = _offset(line)
        elif head == "OFFSET" and inside is not None:
            joints[inside].offset = _offset(line)
        elif head == "CHANNELS" and inside not in (None, _BONE_END) and line[1:2] == [str(len(line) - 2)]:
            joints[inside].channels = line[2:]
        elif head != "HIERARCHY" or joints:
            raise _broken()
    if open_ or named is not None or not joints or any(joint.offset is None for joint in joints):
        raise _broken()
    return joints


def _offset(line: list[str]) -> tuple[float, ...]:
    try:
        x, y, z = (float(word) for word in line[1:])
    except ValueError:
        raise _broken() from None
    return x, y, z


def _broken() -> InputError:
    return InputError("motion_unreadable", "The BVH file's skeleton cannot be read: export it again.")


def _frame_header(count: str, seconds: str) -> tuple[int, float]:
    try:
        frames, step = int(count), float(seconds)
    except ValueError:
        raise InputError(
            "motion_unreadable",
            "The BVH file's count of frames or its frame time is no number: export it again, with points in decimals.",
        ) from None
    if frames <= 0:
        raise InputError("motion_empty", "The BVH file has no frames: export the motion, not the skeleton alone.")
    if frames > MAX_MOTION_FRAMES:
        raise InputError("motion_too_large", f"A motion can have {MAX_MOTION_FRAMES} frames: cut the recording.")
    if not 1e-3 <= step <= 2:
        raise InputError("motion_unreadable", "The BVH file's frame time must lie between 0.001 and 2 seconds.")
    return frames, 1 / step


def _require_few_numbers(frames: int, joints: int, width: int) -> None:
    if width == 0:
        raise InputError("motion_channels", "The BVH file's joints have no channels: nothing in it moves.")
    if frames * max(width, 3 * joints) > MAX_NUMBERS:  # a joint without channels has its turn in every frame, too
        raise InputError("motion_too_large", "The motion has too many frames for so many joints: cut the recording.")


def _read_frames(text: str, frames: int, width: int) -> Array:
    """(F, width) numbers of the frames; those behind the stated count of frames are left aside."""
    values = _numbers(text)
    if values is None:
        *before, _ = text.rsplit(maxsplit=1)  # half a number, where a file breaks off
        values = _numbers("".join(before))
    if values is None:
        raise InputError(
            "motion_unreadable",
            "The BVH file's frames hold something that is no number: export it again, with points in decimals.",
        )
    if len(values) < frames * width:
        raise InputError(
            "motion_truncated",
            f"The BVH file breaks off in frame {len(values) // width + 1} of {frames}: export or upload it again.",
        )
    return values[: frames * width].reshape(frames, width)


def _numbers(text: str) -> Array | None:
    """The numbers in a text; None where something else is among them."""
    if not text or text.isspace():
        return np.empty(0)  # numpy finds a number there
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # what is an error in newer versions of numpy
        try:
            return np.fromstring(text, np.float64, sep=" ")
        except (ValueError, DeprecationWarning):
            return None


def _to_local(values: Array, channels: list[tuple[int, str, str]], offsets: Array) -> tuple[Array, Array]:
    """Turns (F, J, 4) and places (F, J, 3) in parents' axes; a joint's position channels replace its offset."""
    frames, joints = len(values), len(offsets)
    rotations = rotation.identity(frames, joints)
    translations = np.broadcast_to(offsets, (frames, joints, 3))
    if any(kind == "position" for _, kind, _ in channels):
        translations = translations.copy()
    radians = np.radians(values)
    for column, (joint, kind, axis) in enumerate(channels):
        if kind == "position":
            translations[:, joint, "xyz".index(axis)] = values[:, column]
        else:
            turn = rotation.about(axis, radians[:, column])
            rotations[:, joint] = rotation.multiply(rotations[:, joint], turn)
    return rotations, translations
