"""Motions of skeletons in GLB and glTF files, such as characters from Mixamo."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.motion import rotation
from engine.motion.gltf_file import GltfFile, unreadable
from engine.motion.source_motion import MAX_FRAMES, MAX_JOINTS, MAX_NUMBERS, Array, SourceMotion, place, unique_names

FEWEST_JOINTS = 10
"""Animated nodes without a skin are a skeleton if they are at least this many: hips, limbs, head."""

USUAL_FPS = 30.0
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
    """Read an animation of a skeleton: the one named `clip`, or the first in which something moves.

    Sampled at the clip's own rate, LINEAR, STEP and CUBICSPLINE alike. The rest pose is the one that the skin is bound
    in. Scales are applied to lengths, and not animated.

    Raises
    ------
    InputError : `motion_unreadable`, `motion_too_large`, `motion_not_finite`, `motion_without_skeleton`,
        `motion_without_animation`, `motion_clip_unknown` (`found["clips"]` are there).
    """
    file = GltfFile(source)
    parents, order = _tree(file.parts)
    skinned = {joint for skin in file.parts.skins or [] for joint in skin.joints}
    animations = list(file.parts.animations or [])
    if not animations:
        raise InputError("motion_without_animation", "The glTF file has no animation: export it with one.")
    if not skinned and max(len(_turned(animation)) for animation in animations) < FEWEST_JOINTS:
        raise InputError("motion_without_skeleton", "The glTF file has no skeleton: export a character with its bones.")
    names = _clip_names(file)
    if clip is not None and clip not in names:
        raise InputError(
            "motion_clip_unknown",
            f"The file has no animation “{clip[:40]}”: choose one of those that it has.",
            ("motion_clip",),
            {"clips": list(names)},
        )
    chosen = names.index(clip) if clip is not None else _first_that_moves(file, animations)
    nodes = _skeleton_nodes(parents, order, skinned or _turned(animations[chosen]))
    if len(nodes) > MAX_JOINTS:
        raise InputError("motion_too_large", f"A motion's skeleton can have {MAX_JOINTS} joints: use a simpler one.")
    index = {node: joint for joint, node in enumerate(nodes)}
    own_parents = np.array([index.get(parents[node], -1) for node in nodes], np.int32)
    turns, offsets, scales = _at_rest(file.parts, nodes, own_parents)
    tracks = _tracks(file, animations[chosen], index)
    fps, times = _sampling(tracks, len(nodes))
    rotations = np.tile(turns, (len(times), 1, 1))
    translations = np.tile(offsets, (len(times), 1, 1))
    for joint, track in tracks:
        if track.path == "rotation":
            rotations[:, joint] = _sampled(track, times)
        else:
            translations[:, joint] = _sampled(track, times) * scales[joint]
    rest_turns, rest_offsets = _bind_pose(file, nodes, own_parents, turns, offsets)
    return SourceMotion(
        name=name or names[chosen],
        fps=fps,
        names=unique_names(str(file.parts.nodes[node].name or f"node {node}") for node in nodes),
        parents=own_parents,
        rest_rotations=rest_turns,
        rest_offsets=rest_offsets,
        ends=np.full((len(nodes), 3), np.nan),
        rotations=rotations,
        translations=translations,
        up=(0.0, 1.0, 0.0),
        unit="metre",
        unit_metres=1.0,
        loops=_loops(animations[chosen]),
    )


def _loops(animation: Any) -> bool | None:
    """What the animation's extras say, as `engine.export.glb` writes them."""
    said = animation.extras.get("loops") if isinstance(animation.extras, dict) else None
    return said if isinstance(said, bool) else None


def _clip_names(file: GltfFile) -> tuple[str, ...]:
    return unique_names(str(a.name or f"clip {i}") for i, a in enumerate(file.parts.animations or []))


def _turned(animation: Any) -> set[int]:
    return {c.target.node for c in animation.channels if c.target.path == "rotation" and c.target.node is not None}


def _tree(parts: Any) -> tuple[list[int], list[int]]:
    """Each node's parent (-1: none), and all nodes, parents first."""
    nodes = list(parts.nodes or [])
    parents = [-1] * len(nodes)
    for index, node in enumerate(nodes):
        for child in node.children or []:
            if not 0 <= child < len(nodes) or parents[child] != -1 or child == index:
                raise unreadable("its nodes are no tree")
            parents[child] = index
    order = [index for index, parent in enumerate(parents) if parent == -1]
    for index in order:
        order.extend(nodes[index].children or [])
    if len(order) != len(nodes):
        raise unreadable("its nodes are no tree")
    return parents, order


def _skeleton_nodes(parents: list[int], order: list[int], joints: set[int]) -> list[int]:
    """The joints, what they hang on, and what hangs on them, parents first."""
    if not all(0 <= joint < len(parents) for joint in joints):
        raise unreadable("a joint is not there")
    kept = set(joints)
    for joint in joints:
        while (joint := parents[joint]) >= 0 and joint not in kept:
            kept.add(joint)
    below = set(joints)
    for node in order:
        if parents[node] in below:
            below.add(node)
    kept |= below
    return [node for node in order if node in kept]


def _at_rest(parts: Any, nodes: list[int], parents: NDArray[np.int32]) -> tuple[Array, Array, Array]:
    """Turns (J, 4) and offsets (J, 3) as the nodes have them, in parents' axes, and by what their parents scale (J,)."""
    turns, offsets, scales = rotation.identity(len(nodes)), np.zeros((len(nodes), 3)), np.ones(len(nodes))
    own = np.ones(len(nodes))
    try:
        for joint, node in enumerate(parts.nodes[index] for index in nodes):
            if node.matrix is not None:
                matrix = np.array(node.matrix, np.float64).reshape(4, 4).T
                turns[joint], own[joint] = _turn_and_scale(matrix[:3, :3])
                offsets[joint] = matrix[:3, 3]
            else:
                turns[joint] = rotation.normalize(node.rotation or rotation.IDENTITY)
                offsets[joint] = node.translation or (0, 0, 0)
                own[joint] = np.mean(node.scale or (1, 1, 1))
            if parents[joint] >= 0:
                scales[joint] = scales[parents[joint]] * own[parents[joint]]
    except (TypeError, ValueError) as error:
        raise unreadable("a node is broken") from error
    offsets = offsets * scales[:, None]
    if not (np.isfinite(turns).all() and np.isfinite(offsets).all()):
        raise InputError("motion_not_finite", "The glTF file holds numbers that are not finite: export it again.")
    return turns, offsets, scales


def _turn_and_scale(matrix: Array) -> tuple[Array, float]:
    """The turn nearest to a matrix (3, 3), and its mean scale."""
    u, sizes, v = np.linalg.svd(matrix)
    sign = np.sign(np.linalg.det(u @ v))
    return rotation.from_matrix(u @ np.diag([1, 1, sign]) @ v), float(sizes.mean())


def _bind_pose(
    file: GltfFile, nodes: list[int], parents: NDArray[np.int32], turns: Array, offsets: Array
) -> tuple[Array, Array]:
    """Turns and offsets in parents' axes of the pose in which the skin was bound; joints outside of it stay at rest."""
    world, places = place(parents, turns, offsets)
    bound = np.zeros(len(nodes), bool)
    index = {node: joint for joint, node in enumerate(nodes)}
    for skin in file.parts.skins or []:
        if skin.inverseBindMatrices is None:
            continue
        matrices = file.numbers(skin.inverseBindMatrices).reshape(-1, 4, 4).swapaxes(1, 2)
        regular = np.abs(np.linalg.det(matrices)) > 1e-12
        for node, matrix, invertible in zip(skin.joints, matrices, regular, strict=False):
            joint = index[node]
            if invertible and not bound[joint]:
                bind = np.asarray(np.linalg.inv(matrix), np.float64)
                world[joint], places[joint], bound[joint] = _turn_and_scale(bind[:3, :3])[0], bind[:3, 3], True
    if not bound.any():
        return turns, offsets
    own_turns, own_offsets = turns.copy(), offsets.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0 and bound[joint]:
            back = rotation.inverse(world[parent])
            own_turns[joint] = rotation.multiply(back, world[joint])
            own_offsets[joint] = rotation.rotate(back, places[joint] - places[parent])
        elif parent >= 0:
            world[joint] = rotation.multiply(world[parent], turns[joint])
            places[joint] = places[parent] + rotation.rotate(world[parent], offsets[joint])
    return own_turns, own_offsets


def _tracks(file: GltfFile, animation: Any, index: dict[int, int]) -> list[tuple[int, _Track]]:
    found = []
    for channel in animation.channels:
        path, joint = channel.target.path, index.get(channel.target.node, -1)
        width = {"rotation": 4, "translation": 3}.get(path)
        if width is None or joint < 0:
            continue
        try:
            sampler = animation.samplers[channel.sampler]
        except (IndexError, TypeError) as error:
            raise unreadable("a sampler is not there") from error
        if sampler.interpolation not in INTERPOLATIONS:
            raise unreadable("an animation goes from key to key in a way that glTF does not know")
        times, values = file.numbers(sampler.input)[:, 0], file.numbers(sampler.output)
        spline = sampler.interpolation == "CUBICSPLINE"
        if values.shape != (len(times) * (3 if spline else 1), width) or (np.diff(times) < 0).any():
            raise unreadable("an animation's keys are broken")
        found.append((joint, _Track(path, times, values, sampler.interpolation or "LINEAR")))
    if not found:
        raise InputError("motion_without_animation", "The file's animation does not move the skeleton: choose another.")
    return found


def _first_that_moves(file: GltfFile, animations: list[Any]) -> int:
    for number, animation in enumerate(animations):
        everything = {node: node for node in _turned(animation)}
        if everything and any(
            np.ptp(track.values, axis=0).max() > 1e-3 for _, track in _tracks(file, animation, everything)
        ):
            return number
    return 0


def _sampling(tracks: list[tuple[int, _Track]], joints: int) -> tuple[float, Array]:
    """Frames a second, and the times of the frames: the rate at which the keys lie, if they lie as close as frames."""
    first = min(track.times[0] for _, track in tracks)
    last = max(track.times[-1] for _, track in tracks)
    dense = max((track.times for _, track in tracks), key=len)
    steps = np.diff(dense)
    step = float(np.median(steps[steps > 0])) if (steps > 0).any() else 1.0
    fps = 1 / step if 1 / 240 <= step <= 1 / 20 else USUAL_FPS
    fps = round(fps) if abs(fps - round(fps)) < 0.05 else fps
    count = int(np.floor((last - first) * fps + 1e-3)) + 1
    if count > MAX_FRAMES or count * joints * 3 > MAX_NUMBERS:
        raise InputError("motion_too_large", f"A motion can have {MAX_FRAMES} frames: cut the recording.")
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
