"""Motions from GLB: a real Mixamo character, our own clips written by the test, and hostile files."""

from __future__ import annotations

import base64
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygltflib as gltf
import pytest

from engine.errors import InputError
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.files.gltf_file import MAX_JSON_BYTES
from engine.motion.files.gltf_motion import gltf_clips, read_gltf_motion
from engine.motion.files.reading import motion_clips, read_motion
from engine.motion.kinematics import joint_places, world_rotations
from engine.motion.library import built_in
from engine.motion.retargeting.joint_map import map_joints
from engine.motion.retargeting.retarget import retarget

Media = Callable[[str], Path]
SOLDIER = "scans3d/body_soldier/soldier.glb"


class Writer:
    """A GLB in the making."""

    def __init__(self) -> None:
        self.file = gltf.GLTF2(scene=0, scenes=[gltf.Scene(nodes=[0])])
        self.data = b""

    def numbers(self, values: np.ndarray, kind: str, normalized: bool = False) -> int:
        codes = {"f": gltf.FLOAT, "h": gltf.SHORT}
        raw = np.ascontiguousarray(values).tobytes()
        self.file.bufferViews.append(gltf.BufferView(buffer=0, byteOffset=len(self.data), byteLength=len(raw)))
        self.data += raw + b"\0" * (-len(raw) % 4)
        self.file.accessors.append(
            gltf.Accessor(
                bufferView=len(self.file.bufferViews) - 1,
                componentType=codes[values.dtype.char],
                count=len(values),
                type=kind,
                normalized=normalized,
            )
        )
        return len(self.file.accessors) - 1

    def bytes(self) -> bytes:
        self.file.buffers = [gltf.Buffer(byteLength=len(self.data))]
        self.file.set_binary_blob(self.data)
        return b"".join(self.file.save_to_bytes())


def character(
    skeleton: Skeleton,
    clip: Clip,
    interpolation: str = "LINEAR",
    skin: bool = True,
    scale: float = 0.01,
    short: bool = False,
) -> Writer:
    """A clip as a character of centimetre bones under a scaled, turned node, as Mixamo's come out of converters."""
    writer = Writer()
    turn = rotation.about("x", -np.pi / 2)
    offsets = skeleton.offsets() / scale
    back = rotation.inverse(turn)
    offsets[0] = rotation.rotate(back, offsets[0])
    nodes = [gltf.Node(name="Armature", rotation=turn.tolist(), scale=[scale] * 3, children=[1])]
    for joint, name in enumerate(skeleton.names):
        children = [int(c) + 1 for c in np.flatnonzero(skeleton.parents == joint)]
        own = rotation.multiply(back, clip.rotations[0, 0]) if joint == 0 else clip.rotations[0, joint]
        nodes.append(
            gltf.Node(
                name=f"mixamorig:{name}", translation=offsets[joint].tolist(), rotation=own.tolist(), children=children
            )
        )
    writer.file.nodes = nodes
    if skin:
        binds = np.tile(np.eye(4, dtype=np.float32), (len(skeleton.names), 1, 1))
        binds[:, :3, 3] = -skeleton.heads / scale
        binds[:, :3, :3] = np.eye(3)
        writer.file.skins = [
            gltf.Skin(
                joints=list(range(1, len(nodes))),
                inverseBindMatrices=writer.numbers(binds.swapaxes(1, 2).reshape(-1, 16), "MAT4"),
            )
        ]
    animation = gltf.Animation(name=clip.name)
    times = writer.numbers((np.arange(len(clip.root)) / clip.fps).astype(np.float32)[:, None], "SCALAR")
    for joint in range(-1, len(skeleton.names)):
        if joint < 0:
            values = rotation.rotate(back, clip.root / scale).astype(np.float32)
        else:
            turns = clip.rotations[:, joint]
            values = (rotation.multiply(back, turns) if joint == 0 else turns).astype(np.float32)
            values[1:] *= np.cumprod(np.where(np.sum(values[1:] * values[:-1], -1) < 0, -1, 1))[:, None]
        kind = "VEC3" if joint < 0 else "VEC4"
        if interpolation == "CUBICSPLINE":
            tangents = (np.gradient(values, axis=0) * clip.fps).astype(np.float32)
            values = np.stack([tangents, values, tangents], 1).reshape(-1, values.shape[-1])
        if short and joint >= 0:
            output = writer.numbers(np.round(values * 32767).astype(np.int16), kind, normalized=True)
        else:
            output = writer.numbers(values.astype(np.float32), kind)
        animation.samplers.append(gltf.AnimationSampler(input=times, output=output, interpolation=interpolation))
        animation.channels.append(
            gltf.AnimationChannel(
                sampler=len(animation.samplers) - 1,
                target=gltf.AnimationChannelTarget(
                    node=max(joint, 0) + 1, path="translation" if joint < 0 else "rotation"
                ),
            )
        )
    writer.file.animations = [animation]
    return writer


def apart(first: Clip, second: Clip, skeleton: Skeleton) -> float:
    turns = (world_rotations(skeleton.parents, clip.rotations) for clip in (first, second))
    return float(np.degrees(rotation.angle(rotation.multiply(rotation.inverse(next(turns)), next(turns))).max()))


@pytest.mark.parametrize("interpolation", ["LINEAR", "CUBICSPLINE", "STEP"])
@pytest.mark.parametrize("skin", [True, False])
def test_a_clip_of_our_own_comes_back(skeleton: Skeleton, interpolation: str, skin: bool) -> None:
    """With a skin, its bind pose is our T-pose, whatever pose the nodes are in; without, the nodes' own must do, and
    the clip begins standing."""
    clip = built_in("bow", skeleton)
    motion = read_gltf_motion(character(skeleton, clip, interpolation, skin).bytes())
    assert (motion.fps, len(motion.rotations)) == (30, len(clip.root))
    back = retarget(motion, skeleton, facing="keep", feet=False).clip
    if skin:
        assert apart(back, clip, skeleton) < 0.1
    hands = [skeleton.index("LeftHand"), skeleton.index("RightHand")]
    places = [joint_places(skeleton, c)[:, hands] - c.root[:, None] for c in (back, clip)]
    assert np.linalg.norm(places[0] - places[1], axis=-1).max() < 0.12
    assert np.allclose(back.root - back.root[0], clip.root - clip.root[0], atol=0.01)


@pytest.mark.parametrize(
    ("extras", "loops"), [({"loops": True}, True), ({"loops": False}, False), ({}, None), ({"loops": "yes"}, None)]
)
def test_a_loop_may_be_marked(skeleton: Skeleton, extras: dict[str, object], loops: bool | None) -> None:
    """Of a clip that comes back to rest, which is not taken for a loop without a word."""
    clip = built_in("wave", skeleton)
    writer = character(skeleton, clip)
    writer.file.animations[0].extras = extras
    motion = read_gltf_motion(writer.bytes())
    assert motion.loops is loops
    back = retarget(motion, skeleton, facing="keep", feet=False).clip
    assert (back.loops, len(back.root)) == (bool(loops), len(clip.root) - bool(loops))


def test_short_integers_are_fractions(skeleton: Skeleton) -> None:
    clip = built_in("wave", skeleton)
    motion = read_gltf_motion(character(skeleton, clip, short=True).bytes())
    assert apart(retarget(motion, skeleton, facing="keep", feet=False).clip, clip, skeleton) < 0.5


def test_splines_meet_their_keys_and_go_smoothly_between(skeleton: Skeleton) -> None:
    clip = built_in("dance", skeleton, 12.0)
    motion = read_gltf_motion(character(skeleton, clip, "CUBICSPLINE").bytes())
    assert motion.fps == 30  # sparse keys
    fine = built_in("dance", skeleton, 30.0)
    back = retarget(motion, skeleton, facing="keep", feet=False).clip
    hand = skeleton.index("LeftHand")
    places = [joint_places(skeleton, c)[: len(back.root), hand] for c in (back, fine)]
    assert np.linalg.norm(places[0] - places[1], axis=-1).mean() < 0.03


def test_a_real_character_from_mixamo(media: Media, skeleton: Skeleton) -> None:
    path = media(SOLDIER)
    assert gltf_clips(path) == ("Idle", "Run", "TPose", "Walk")
    motion = read_gltf_motion(path, "Walk")
    assert motion.fps == 30
    assert len(map_joints(motion)) == 52
    clip = retarget(motion, skeleton, facing="main").clip
    places = joint_places(skeleton, clip)
    assert (places[:, skeleton.index("Head"), 1] > 1.4).all()
    left = places[:, skeleton.index("LeftFoot"), 2]
    assert np.ptp(left) > 0.6  # it strides


def test_its_t_pose_is_ours(media: Media, skeleton: Skeleton) -> None:
    clip = retarget(read_gltf_motion(media(SOLDIER), "TPose"), skeleton).clip
    assert np.degrees(rotation.angle(clip.rotations[0]).max()) < 6


def test_the_first_clip_that_moves_is_taken(media: Media) -> None:
    assert read_gltf_motion(media(SOLDIER)).name == "Idle"
    with pytest.raises(InputError) as error:
        read_gltf_motion(media(SOLDIER), "Swim")
    assert error.value.code == "motion_clip_unknown"
    assert error.value.found["clips"] == ["Idle", "Run", "TPose", "Walk"]


def cube() -> Writer:
    writer = Writer()
    writer.file.nodes = [gltf.Node(name="cube")]
    times = writer.numbers(np.float32([[0], [1]]), "SCALAR")
    turns = writer.numbers(np.float32([[0, 0, 0, 1], [0, 1, 0, 0]]), "VEC4")
    writer.file.animations = [
        gltf.Animation(
            samplers=[gltf.AnimationSampler(input=times, output=turns)],
            channels=[gltf.AnimationChannel(sampler=0, target=gltf.AnimationChannelTarget(node=0, path="rotation"))],
        )
    ]
    return writer


def broken(skeleton: Skeleton, how: str) -> bytes:
    """A character whose file is spoiled in one way."""
    writer = character(skeleton, built_in("bow", skeleton, 5.0))
    file, animation = writer.file, writer.file.animations[0]
    match how:
        case "no animation":
            file.animations = []
        case "an accessor outside its buffer":
            file.accessors[animation.samplers[3].output].count = 1 << 40
        case "an accessor that is not there":
            animation.samplers[3].output = 9999
        case "an accessor before its buffer":
            file.bufferViews[2].byteOffset = -64
        case "a sampler that is not there":
            animation.channels[2].sampler = 9999
        case "keys that are joined by nobody knows what":
            animation.samplers[3].interpolation = "BEZIER"
        case "keys of the wrong kind":
            file.accessors[animation.samplers[3].output].type = "VEC2"
        case "a joint that is not there":
            file.skins[0].joints[4] = 9999
        case "nodes in a ring":
            file.nodes[5].children = [1]
        case "not a number":
            start = file.bufferViews[file.accessors[animation.samplers[3].output].bufferView].byteOffset
            writer.data = writer.data[:start] + np.float32(np.nan).tobytes() + writer.data[start + 4 :]
        case "a clip of a year":
            times = file.bufferViews[file.accessors[animation.samplers[0].input].bufferView]
            end = times.byteOffset + times.byteLength
            writer.data = writer.data[: end - 4] + np.float32(3.15e7).tobytes() + writer.data[end:]
        case "a thousand joints":
            file.nodes[4].children = [*(file.nodes[4].children or []), *range(len(file.nodes), len(file.nodes) + 1000)]
            file.nodes += [gltf.Node(name=f"tail {i}") for i in range(1000)]
        case "the same keys a million times":
            long = writer.numbers(np.zeros((1 << 20, 4), np.float32), "VEC4")
            animation.samplers[3].output = animation.samplers[3].input = long
            animation.channels += [animation.channels[3]] * 20_000
        case "numbers in another file":
            writer.bytes()
            file.set_binary_blob(None)
            file.buffers[0].uri = "numbers.bin"
            return file.to_json().encode()
        case "numbers that are no base64":
            file.buffers = [gltf.Buffer(byteLength=4, uri="data:application/octet-stream;base64,????")]
            return file.to_json().encode()
        case "cut in its numbers":
            return writer.bytes()[:-1000]
    return writer.bytes()


BROKEN = {
    "no animation": "motion_without_animation",
    "an accessor outside its buffer": "motion_unreadable",
    "an accessor that is not there": "motion_unreadable",
    "an accessor before its buffer": "motion_unreadable",
    "a sampler that is not there": "motion_unreadable",
    "keys that are joined by nobody knows what": "motion_unreadable",
    "keys of the wrong kind": "motion_unreadable",
    "a joint that is not there": "motion_unreadable",
    "nodes in a ring": "motion_unreadable",
    "not a number": "motion_not_finite",
    "a clip of a year": "motion_too_large",
    "a thousand joints": "motion_too_large",
    "the same keys a million times": "motion_too_large",
    "numbers in another file": "motion_unreadable",
    "numbers that are no base64": "motion_unreadable",
    "cut in its numbers": "motion_unreadable",
}


@pytest.mark.parametrize("how", BROKEN)
def test_broken_files_are_refused_soon_and_by_name(skeleton: Skeleton, how: str) -> None:
    data = broken(skeleton, how)
    begin = time.monotonic()
    with pytest.raises(InputError) as error:
        read_gltf_motion(data)
    assert error.value.code == BROKEN[how]
    assert time.monotonic() - begin < 60


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"glTF",
        b"glTF\x02\0\0\0\xff\xff\xff\xff",
        b"glTF" + bytes(range(256)),
        b"{",
        b"{}" * 50,
        b"[1, 2]",
        b'{"asset": 5}',
        b'{"nodes": [5]}',
        b'{"a":' * 50_000,
        bytes(range(256)),
    ],
)
def test_junk_is_refused(data: bytes) -> None:
    with pytest.raises(InputError) as error:
        read_gltf_motion(data)
    assert error.value.code in ("motion_unreadable", "motion_without_animation")


def test_a_cube_has_no_skeleton() -> None:
    with pytest.raises(InputError) as error:
        read_gltf_motion(cube().bytes())
    assert error.value.code == "motion_without_skeleton"


def as_text(writer: Writer, uri: str | None = None) -> bytes:
    """The file as JSON, its numbers in itself, or where `uri` says."""
    writer.bytes()
    writer.file.set_binary_blob(None)
    uri = uri or "data:application/octet-stream;base64," + base64.b64encode(writer.data).decode()
    writer.file.buffers = [gltf.Buffer(byteLength=len(writer.data), uri=uri)]
    return writer.file.to_json().encode()


@pytest.mark.parametrize("begin", [b"", b"\xef\xbb\xbf", b"\r\n  "])
def test_gltf_with_its_numbers_inside_is_read(skeleton: Skeleton, tmp_path: Path, begin: bytes) -> None:
    """Told by how it begins, as every motion, whatever it is called."""
    path = tmp_path / "bow.bvh"
    path.write_bytes(begin + as_text(character(skeleton, built_in("bow", skeleton))))
    assert read_motion(path).name == "bow"
    assert motion_clips(path) == ("bow",)


def test_gltf_with_its_numbers_elsewhere_says_what_to_do(skeleton: Skeleton, tmp_path: Path) -> None:
    path = tmp_path / "bow.gltf"
    path.write_bytes(as_text(character(skeleton, built_in("bow", skeleton)), "bow.bin"))
    with pytest.raises(InputError, match="in another file: export it as one GLB file") as error:
        read_motion(path)
    assert (error.value.code, error.value.correctable) == ("motion_unreadable", ("motion",))


def test_parts_of_a_text_are_counted_without_the_numbers_in_it(skeleton: Skeleton) -> None:
    writer = character(skeleton, built_in("bow", skeleton))
    writer.data += bytes(MAX_JSON_BYTES)
    assert read_gltf_motion(as_text(writer)).name == "bow"
    many = b'{"asset": {}, "extras": [' + b"[]," * (MAX_JSON_BYTES // 3) + b"0]}"
    with pytest.raises(InputError) as error:
        read_gltf_motion(many)
    assert error.value.code == "motion_too_large"


@pytest.mark.parametrize("how", ["bones without length", "a scale of nothing"])
def test_a_skeleton_without_size_moves_nobody(skeleton: Skeleton, how: str) -> None:
    writer = character(skeleton, built_in("walk", skeleton), skin=False)
    if how == "a scale of nothing":
        writer.file.nodes[0].scale = [0, 0, 0]
    else:
        for node in writer.file.nodes[2:]:
            node.translation = [0, 0, 0]
    with pytest.raises(InputError) as error:
        retarget(read_gltf_motion(writer.bytes()), skeleton)
    assert error.value.code == "motion_not_humanoid"
