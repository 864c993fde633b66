"""BVH files: real ones, one by hand, and hostile ones."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import bvhio
import numpy as np
import pytest

from engine.errors import InputError
from engine.motion import rotation
from engine.motion.files.bvh import read_bvh

DEADLINE_SECONDS = 60
"""Seconds: a dead man's handle, no measure."""

Media = Callable[[str], Path]

REAL = {
    "bandai_kick": (22, 358, 30.0, "centimetre"),
    "bandai_run_active": (22, 72, 30.0, "centimetre"),
    "cmu_02_01_walk": (31, 343, 120.0, "CMU unit"),
    "cmu_05_06_dance": (31, 885, 120.0, "CMU unit"),
    "cmu_131_03_hop": (31, 1102, 120.0, "CMU unit"),
    "cmu_jumping_jacks": (31, 125, 30.0, "CMU unit"),
    "fair_jumping": (27, 654, 120.0, "unknown"),
    "fair_wave_hello": (27, 839, 120.0, "unknown"),
    "makehuman_walk_cycle": (75, 14, 24.0, "decimetre"),
}

ARM = """HIERARCHY
ROOT Upper Arm
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Fore
  { OFFSET 10 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 5 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 0 0 0 0 0 0
1 2 3 90 0 0 0 0 90
"""


@pytest.mark.parametrize("name", REAL)
def test_real_files_are_read(media: Media, name: str) -> None:
    joints, frames, fps, unit = REAL[name]
    motion = read_bvh(media(f"mocap/{name}.bvh"))
    assert (len(motion.names), len(motion.rotations), motion.unit) == (joints, frames, unit)
    assert motion.fps == pytest.approx(fps, rel=2e-3)
    assert motion.rotations.shape == (frames, joints, 4)
    assert motion.translations.shape == (frames, joints, 3)
    assert np.allclose(np.linalg.norm(motion.rotations, axis=-1), 1)


@pytest.mark.parametrize("name", ["cmu_jumping_jacks", "makehuman_walk_cycle", "fair_jumping"])
def test_turns_are_those_that_bvhio_reads(media: Media, name: str) -> None:
    path = media(f"mocap/{name}.bvh")
    motion = read_bvh(path)
    layout = bvhio.readAsBvh(str(path)).Root.layout()
    for frame in (0, len(motion.rotations) - 1):
        theirs = np.array(
            [[*list(joint.Keyframes[frame].Rotation)[1:], joint.Keyframes[frame].Rotation.w] for joint, _, _ in layout]
        )
        apart = rotation.angle(rotation.multiply(rotation.inverse(theirs), motion.rotations[frame]))
        assert np.degrees(apart.max()) < 0.1


def test_a_file_by_hand_is_read_as_it_is_meant() -> None:
    motion = read_bvh(ARM.encode())
    assert motion.names == ("Upper_Arm", "Fore")
    assert motion.fps == 25
    assert motion.parents.tolist() == [-1, 0]
    assert motion.ends[1].tolist() == [5, 0, 0]
    turns, places = motion.world()
    assert np.allclose(places[0], [[0, 0, 0], [10, 0, 0]])
    assert np.allclose(places[1], [[1, 2, 3], [1, 12, 3]])  # the upper arm turned up, from x to y
    tip = places[1, 1] + rotation.rotate(turns[1, 1], motion.ends[1])
    assert np.allclose(tip, [1, 12, -2])  # the forearm about its own y, which then lies along -x


@pytest.mark.parametrize(
    ("unit", "metres"),
    [("metre", 1.0), ("centimetre", 0.01), ("decimetre", 0.1), ("inch", 0.0254), ("millimetre", 0.001)],
)
def test_the_unit_is_guessed_from_the_persons_size(media: Media, unit: str, metres: float) -> None:
    from engine.motion.files.bvh import guess_unit

    motion = read_bvh(media("mocap/makehuman_walk_cycle.bvh"))
    factor = 0.1 / metres
    assert guess_unit(motion.parents, motion.rest_offsets * factor, motion.ends * factor) == (unit, metres)


def test_names_may_be_long_and_of_many_words_and_come_twice() -> None:
    text = ARM.replace("Upper Arm", "x" + " " * 900_000 + "y").replace("JOINT Fore", "JOINT " + "bip_" * 20_000)
    assert [len(name) for name in read_bvh(text.encode()).names] == [3, 128]
    assert read_bvh(ARM.replace("Upper Arm", "ROOT").replace("Fore", "ROOT").encode()).names == ("ROOT", "ROOT #2")


def test_line_ends_and_spaces_do_not_matter() -> None:
    windows = ARM.replace("\n", "\r\n").replace("Frames: 2", "Frames:\t2")
    spaced = ARM.replace("Frames:", "Frames :").replace("Time:", "Time  :")
    for text in (windows, spaced):
        assert np.allclose(read_bvh(text.encode()).rotations, read_bvh(ARM.encode()).rotations)


@pytest.mark.parametrize("spelt", [str.lower, str.upper])
def test_channels_mean_the_same_however_they_are_spelt(spelt: Callable[[str], str]) -> None:
    text = ARM
    for channel in ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"):
        text = text.replace(channel, spelt(channel))
    read, known = read_bvh(text.encode()), read_bvh(ARM.encode())
    assert np.array_equal(read.rotations, known.rotations) and np.array_equal(read.translations, known.translations)


SPELT = {
    "PyMO's end sites": ("End Site", "End site"),
    "large end sites": ("End Site", "END SITE"),
    "end sites in one word": ("End Site", "EndSite"),
    "ends without a site": ("End Site", "End"),
    "tabs": (" ", "\t"),
    "small words": ("OFFSET", "offset"),
    "small joints": ("JOINT", "joint"),
    "empty lines": ("\n", "\n\n  \n"),
    "small motion": ("MOTION", "Motion"),
    "no motion": ("MOTION\n", ""),
    "small frames": ("Frames:", "frames:"),
    "one word for the time": ("Frame Time", "FrameTime"),
    "small hierarchy": ("HIERARCHY", "Hierarchy"),
    "braces behind": ("\n{", " {"),
    "a mark of its bytes": ("HIERARCHY", "\ufeffHIERARCHY"),
    "lines of an old Mac": ("\n", "\r"),
    "lines of Windows": ("\n", "\r\n"),
}


@pytest.mark.parametrize("how", SPELT)
def test_words_mean_the_same_however_they_are_spelt_and_spaced(how: str) -> None:
    old, new = SPELT[how]
    assert old in ARM
    read, known = read_bvh(ARM.replace(old, new).encode()), read_bvh(ARM.encode())
    assert (read.names, read.parents.tolist(), read.fps) == (known.names, known.parents.tolist(), known.fps)
    assert np.array_equal(read.rotations, known.rotations) and np.array_equal(read.translations, known.translations)
    assert np.array_equal(read.ends, known.ends, equal_nan=True)


def test_channels_come_in_any_order_and_places_on_any_joint() -> None:
    text = ARM.replace("CHANNELS 3 Zrotation Xrotation Yrotation", "CHANNELS 4 Yrotation Zposition Xrotation Xposition")
    motion = read_bvh(
        text.replace("0 0 0 0 0 0 0 0 0", "0 0 0 0 0 0 90 7 90 8").replace("90 0 0 0 0 90", "0 0 0 0 0 0 0").encode()
    )
    expected = rotation.multiply(rotation.about("y", np.pi / 2), rotation.about("x", np.pi / 2))
    assert np.allclose(motion.rotations[0, 1], expected)
    assert np.allclose(motion.translations[0, 1], (8, 0, 7))


def test_a_bone_ends_where_no_joint_goes_on() -> None:
    """A joint that has both an end and a joint below has none."""
    motion = read_bvh(ARM.replace("  JOINT Fore", "  End Site\n  {\n  OFFSET 9 9 9\n  }\n  JOINT Fore").encode())
    assert np.isnan(motion.ends[0]).all() and motion.ends[1].tolist() == [5, 0, 0]


def test_numbers_behind_the_last_frame_are_left_aside() -> None:
    assert np.array_equal(read_bvh((ARM + "7 7 7\n").encode()).rotations, read_bvh(ARM.encode()).rotations)


def joints(count: int, nested: bool) -> str:
    line = "JOINT j\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    inner = line * count + "}\n" * count if nested else (line + "}\n") * count
    return ARM.replace("  JOINT Fore", inner + "  JOINT Fore")


HOSTILE = {
    "no bytes": (b"", "motion_unreadable"),
    "binary": (bytes(range(256)) * 40, "motion_unreadable"),
    "binary after the first word": (b"HIERARCHY\n" + bytes(range(1, 256)) * 999, "motion_truncated"),
    "another text": (b"ply\nformat ascii 1.0\n", "motion_unreadable"),
    "ends in the skeleton": (ARM[: ARM.index("End Site")].encode(), "motion_truncated"),
    "ends before the frames": (ARM[: ARM.index("Frame Time")].encode(), "motion_truncated"),
    "ends in a frame": (ARM[:-4].encode(), "motion_truncated"),
    "no frames": (ARM.replace("Frames: 2", "Frames: 0").encode(), "motion_empty"),
    "fewer than no frames": (ARM.replace("Frames: 2", "Frames: -5").encode(), "motion_empty"),
    "a word for a number": (ARM.replace("Frames: 2", "Frames: two").encode(), "motion_unreadable"),
    "no time between frames": (ARM.replace("0.04", "0").encode(), "motion_unreadable"),
    "time not a number": (ARM.replace("0.04", "nan").encode(), "motion_unreadable"),
    "two seconds and a half between frames": (ARM.replace("0.04", "2.5").encode(), "motion_unreadable"),
    "a frame too many": (ARM.replace("Frames: 2", "Frames: 72001").encode(), "motion_too_large"),
    "frames beyond measure": (ARM.replace("Frames: 2", "Frames: 99999999999").encode(), "motion_too_large"),
    "channels unknown": (ARM.replace("Xposition", "Wposition").encode(), "motion_channels"),
    "channels miscounted": (ARM.replace("CHANNELS 6", "CHANNELS 600000").encode(), "motion_unreadable"),
    "no channels": (ARM.replace("6 Xposition Yposition Zposition Zrotation Xrotation Yrotation", "0").replace("3 Zrotation Xrotation Yrotation", "0").encode(), "motion_channels"),
    "not a number": (ARM.replace("1 2 3 90", "1 nan 3 90").encode(), "motion_not_finite"),
    "infinite": (ARM.replace("1 2 3 90", "1 1e999 3 90").encode(), "motion_not_finite"),
    "an offset not a number": (ARM.replace("OFFSET 1 2 3", "OFFSET 1 nan 3").encode(), "motion_not_finite"),
    "a word among numbers": (ARM.replace("1 2 3 90", "1 two 3 90").encode(), "motion_unreadable"),
    "commas in decimals": (ARM.replace("1 2 3 90", "1,0 2,0 3,0 90,0").encode(), "motion_unreadable"),
    "commas in the time": (ARM.replace("0.04", "0,04").encode(), "motion_unreadable"),
    "ends in a number": (ARM[: ARM.index("90 0 0 0 0 90")].encode() + b"-", "motion_truncated"),
    "ends before the first frame": (ARM[: ARM.index("0 0 0 0 0 0 0 0 0")].encode(), "motion_truncated"),
    "braces missing": (ARM.replace("}", "", 1).encode(), "motion_unreadable"),
    "braces too many": (ARM.replace("}", "}\n}\n}\n", 1).encode(), "motion_unreadable"),
    "a joint in an end": (ARM.replace("OFFSET 5 0 0", "JOINT x\n{\nOFFSET 0 0 0\n}").encode(), "motion_unreadable"),
    "a joint without an offset": (ARM.replace("OFFSET 10 0 0", "").encode(), "motion_unreadable"),
    "an offset of two numbers": (ARM.replace("OFFSET 10 0 0", "OFFSET 10 0").encode(), "motion_unreadable"),
    "colons beyond measure": (ARM.replace("Frames:", "Frames" + ":" * 900_000).replace("0.04", "").encode(), "motion_truncated"),
    "words that nobody knows": (ARM.replace("OFFSET 10", "WEIGHT 10\nOFFSET 10").encode(), "motion_unreadable"),
    "a joint without a name": (ARM.replace("JOINT Fore", "JOINT").encode(), "motion_unreadable"),
    "two skeletons": (ARM.replace("MOTION", ARM[10 : ARM.index("MOTION")] + "MOTION").encode(), "motion_unreadable"),
    "more turns than numbers": (joints(500, nested=False).replace("CHANNELS 3 Zrotation Xrotation Yrotation", "CHANNELS 0").replace("Frames: 2", "Frames: 70000").encode(), "motion_too_large"),
    "a thousand joints": (joints(1000, nested=False).encode(), "motion_too_large"),
    "a million joints": (joints(1_000_000, nested=False).encode(), "motion_too_large"),
    "lines beyond measure": (b"HIERARCHY" + b"\n" * 30_000_000, "motion_too_large"),
    "blanks beyond measure": (ARM.replace("Upper Arm", "x" + " " * 900_000 + "y").replace("0.04", "").encode(), "motion_truncated"),
    "joints nested deeply": (joints(400, nested=True).encode(), "motion_too_large"),
    "braces nested deeply": (ARM.replace("OFFSET 1 2 3", "{" * 200_000).encode(), "motion_too_large"),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_files_are_refused_soon_and_by_name(name: str) -> None:
    data, code = HOSTILE[name]
    begin = time.monotonic()
    with pytest.raises(InputError) as error:
        read_bvh(data)
    assert error.value.code == code
    assert time.monotonic() - begin < DEADLINE_SECONDS


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.bvh"
    with path.open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(InputError, match="motion_too_large"):
        read_bvh(path)


@pytest.mark.parametrize("cut", range(0, 100, 7))
def test_a_real_file_cut_anywhere_is_refused_or_read(media: Media, cut: int) -> None:
    data = media("mocap/makehuman_walk_cycle.bvh").read_bytes()
    with pytest.raises(InputError) as error:
        read_bvh(data[: len(data) * cut // 100])
    assert error.value.code in ("motion_truncated", "motion_unreadable")
