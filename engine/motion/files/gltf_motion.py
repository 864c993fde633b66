"""Motions of skeletons in GLB and glTF files, such as characters from Mixamo."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from engine.errors import InputError
from engine.motion import rotation
from engine.motion.files.gltf_accessors import Accessors
from engine.motion.files.gltf_file import GltfFile, unreadable
from engine.motion.files.gltf_skeleton import (
    MIN_JOINTS,
    NodeTree,
    at_rest,
    bind_pose,
    find_skeletons,
    node_tree,
    skeleton_nodes,
)
from engine.motion.files.source_motion import MAX_MOTION_FRAMES, MAX_NUMBERS, Array, SourceMotion, unique_names

DEFAULT_FPS = 30.0
"""For clips whose keys are sparse."""

INTERPOLATIONS = (None, "LINEAR", "STEP", "CUBICSPLINE")
"""None stands for LINEAR."""


@dataclass(frozen=True)
class _Track:
    """What moves one property of one joint: keys' times (K,), values (K, n), or (3 K, n) with tangents."""

    path: str
    times: Array
    values: Array
    interpolation: str


def gltf_clips(source: Path | bytes) -> tuple[str, ...]:
    """The names of the file's animations, in its order; nameless ones are called by their number.

    Raises
    ------
    InputError : `motion_unreadable`, `motion_too_large`.
    """
    return _clip_names(GltfFile(source))


def read_gltf_motion(source: Path | bytes, clip: str | None = None, name: str = "") -> SourceMotion:
    """Read an animation of a skeleton: the one named `clip`, or the first in which something moves. Of several skeletons it
    is the one of which that moves most.

    Sampled at the clip's own rate, LINEAR, STEP and CUBICSPLINE alike. The rest pose is the one that the skin is bound
    in. Scales are applied to lengths, and not animated.

    Raises
    ------
    InputError : `motion_unreadable`, `motion_too_large`, `motion_not_finite`, `motion_extension`, `motion_without_skeleton`,
        `motion_without_animation`, `motion_clip_unknown` (`found["clips"]` are there).
    """
    file = GltfFile(source)
    accessors, tree = Accessors(file), node_tree(file.parts)
    skinned = {joint for skin in file.parts.skins or [] for joint in skin.joints}
    animations = list(file.parts.animations or [])
    if not animations:
        raise InputError("motion_without_animation", "The glTF file has no animation: export it with one.")
    if not skinned and max(len(_turned(animation)) for animation in animations) < MIN_JOINTS:
        raise InputError("motion_without_skeleton", "The glTF file has no skeleton: export a character with its bones.")
    names = _clip_names(file)
    if clip is not None and clip not in names:
        raise InputError(
            "motion_clip_unknown",
            f"The file has no animation “{clip[:40]}”: choose one of those that it has.",
            ("motion_clip",),
            {"clips": list(names)},
        )
    number, moving = _chosen(file, accessors, tree, None if clip is None else names.index(clip))
    chosen = animations[number]
    skeletons = find_skeletons(tree, skinned, _turned(chosen))
    counts = [(len(joints & moving), len(joints & _turned(chosen))) for joints in skeletons]
    own = counts.index(max(counts))
    nodes = skeleton_nodes(tree, skeletons[own])
    index = {node: joint for joint, node in enumerate(nodes)}
    own_parents = np.array([index.get(tree.parents[node], -1) for node in nodes], np.int32)
    held, offsets, scales = at_rest(file.parts, nodes, own_parents)
    tracks = _tracks(file, accessors, chosen, index)
    fps, times = _sampling(tracks, len(nodes))
    rotations = np.tile(held, (len(times), 1, 1))
    translations = np.tile(offsets, (len(times), 1, 1))
    for joint, track in tracks:
        if track.path == "rotation":
            rotations[:, joint] = _sampled(track, times)
        else:
            translations[:, joint] = _sampled(track, times) * scales[joint]
    rest_rotations, rest_offsets = bind_pose(file, accessors, nodes, own_parents, held, offsets)
    return SourceMotion(
        name=name or names[number],
        fps=fps,
        names=unique_names(_name(file.parts.nodes[node], f"node {node}") for node in nodes),
        parents=own_parents,
        rest_rotations=rest_rotations,
        rest_offsets=rest_offsets,
        ends=np.full((len(nodes), 3), np.nan),
        rotations=rotations,
        translations=translations,
        up=(0.0, 1.0, 0.0),
        unit="metre",
        unit_metres=1.0,
        loops=_loops(chosen),
        skeletons=tuple(
            _topmost(file, tree, joints) for joints in (skeletons[own], *skeletons[:own], *skeletons[own + 1 :])
        ),
    )


def _loops(animation: Any) -> bool | None:
    """What the animation's extras say, as `engine.export.gltf.glb` writes them."""
    said = animation.extras.get("loops") if isinstance(animation.extras, dict) else None
    return said if isinstance(said, bool) else None


def _clip_names(file: GltfFile) -> tuple[str, ...]:
    return unique_names(_name(a, f"clip {i}") for i, a in enumerate(file.parts.animations or []))


def _name(part: Any, otherwise: str) -> str:
    return part.name if isinstance(part.name, str) and part.name else otherwise


def _topmost(file: GltfFile, tree: NodeTree, joints: set[int]) -> str:
    """The name of the first joint of a skeleton."""
    node = next(node for node in tree.order if node in joints)
    return _name(file.parts.nodes[node], f"node {node}")[:128]


def _turned(animation: Any) -> set[int]:
    return {c.target.node for c in animation.channels if c.target.path == "rotation" and c.target.node is not None}


def _tracks(file: GltfFile, accessors: Accessors, animation: Any, index: dict[int, int]) -> list[tuple[int, _Track]]:
    found: dict[tuple[int, str], _Track] = {}
    for channel in animation.channels:
        path, joint = channel.target.path, index.get(channel.target.node, -1)
        width = {"rotation": 4, "translation": 3}.get(path)
        if width is None or joint < 0:
            continue
        sampler = _sampler(file, animation, channel)
        times, values = accessors.numbers(sampler.input)[:, 0], accessors.numbers(sampler.output)
        spline = sampler.interpolation == "CUBICSPLINE"
        if values.shape != (len(times) * (3 if spline else 1), width) or (np.diff(times) < 0).any():
            raise unreadable("an animation's keys are broken")
        found.setdefault((joint, path), _Track(path, times, values, sampler.interpolation or "LINEAR"))
    if not found:
        raise InputError("motion_without_animation", "The file's animation does not move the skeleton: choose another.")
    return [(joint, track) for (joint, _), track in found.items()]


def _sampler(file: GltfFile, animation: Any, channel: Any) -> Any:
    """The sampler of a channel, of which everything that must be known is known."""
    number = channel.sampler
    if type(number) is not int or not 0 <= number < len(animation.samplers):
        raise unreadable("a sampler is not there")
    sampler = animation.samplers[number]
    for part in (animation, channel, channel.target, sampler):
        file.require_known(part)
    if sampler.interpolation not in INTERPOLATIONS:
        raise unreadable("an animation goes from key to key in a way that glTF does not know")
    return sampler


def _chosen(file: GltfFile, accessors: Accessors, tree: NodeTree, wanted: int | None) -> tuple[int, set[int]]:
    """Which animation is played: the one that is wanted, or the first by which a joint turns; and what it moves."""
    animations = file.parts.animations
    if wanted is not None:
        return wanted, _moving(file, accessors, animations[wanted])
    joints = {joint for skin in file.parts.skins or [] for joint in skin.joints}
    first: tuple[int, set[int]] | None = None
    for number, animation in enumerate(animations):
        moving = _moving(file, accessors, animation)
        if moving & joints if joints else moving:
            return number, moving
        first = first or (number, moving) if moving else first
    return first or (0, set())


def _moving(file: GltfFile, accessors: Accessors, animation: Any) -> set[int]:
    """The nodes that an animation turns or moves, and does not only hold."""
    found: set[int] = set()
    for channel in animation.channels:
        node = channel.target.node
        if node is None or node in found or channel.target.path not in ("rotation", "translation"):
            continue
        if accessors.varies(_sampler(file, animation, channel).output):
            found.add(node)
    return found


def _sampling(tracks: list[tuple[int, _Track]], joints: int) -> tuple[float, Array]:
    """Frames a second, and the times of the frames: the rate at which the keys lie, if they lie as close as frames."""
    first = min(track.times[0] for _, track in tracks)
    last = max(track.times[-1] for _, track in tracks)
    dense = max((track.times for _, track in tracks), key=len)
    steps = np.diff(dense)
    step = float(np.median(steps[steps > 0])) if (steps > 0).any() else 1.0
    fps = 1 / step if 1 / 240 <= step <= 1 / 20 else DEFAULT_FPS
    fps = round(fps) if abs(fps - round(fps)) < 0.05 else fps
    count = int(np.floor((last - first) * fps + 1e-3)) + 1
    if count > MAX_MOTION_FRAMES or count * joints * 3 > MAX_NUMBERS:
        raise InputError("motion_too_large", f"A motion can have {MAX_MOTION_FRAMES} frames: cut the recording.")
    return float(fps), np.minimum(first + np.arange(count) / fps, last)


def _sampled(track: _Track, times: Array) -> Array:
    """The track's values at `times`, by glTF 2.0, appendix C."""
    keys = track.times
    before = np.clip(np.searchsorted(keys, times + 1e-6, side="right") - 1, 0, len(keys) - 1)
    after = np.minimum(before + 1, len(keys) - 1)
    span = keys[after] - keys[before]
    share = np.clip(np.where(span > 0, (times - keys[before]) / np.where(span > 0, span, 1), 0), 0, 1)
    values = track.values
    if track.interpolation == "CUBICSPLINE":
        t, step = share[:, None], span[:, None]
        leaving, arriving = values[3 * before + 2], values[3 * after]
        start, end = values[3 * before + 1], values[3 * after + 1]
        mixed = (2 * t**3 - 3 * t**2 + 1) * start + (3 * t**2 - 2 * t**3) * end
        mixed = mixed + step * ((t**3 - 2 * t**2 + t) * leaving + (t**3 - t**2) * arriving)
    elif track.interpolation == "STEP":
        mixed = values[before]
    elif track.path == "rotation":
        mixed = rotation.slerp(rotation.normalize(values[before]), rotation.normalize(values[after]), share)
    else:
        mixed = values[before] * (1 - share[:, None]) + values[after] * share[:, None]
    return rotation.normalize(mixed) if track.path == "rotation" else np.asarray(mixed)
