"""Clips as animations of a GLB. Specification: Khronos, glTF 2.0, 3.11 (animations)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pygltflib as gl
from numpy.typing import NDArray

from engine.export.animation_tracks import tracks
from engine.export.gltf.buffer import Buffer
from engine.export.gltf.joints import axes_above
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip


def add_animation(
    gltf: gl.GLTF2, buffer: Buffer, clip: Clip, skeleton: Skeleton, axes: NDArray[np.float64] | None = None
) -> None:
    """Add a clip as an animation of its name, for joints of these `axes` (as of `engine.export.gltf.joints.add_skeleton`)."""
    keys = tracks(clip, skeleton)
    if axes is not None:
        keys = replace(keys, rotations=_between_axes(keys.rotations, skeleton, axes))
    shared = f"animation {clip.name}"
    animation = gl.Animation(name=clip.name, extras={"loops": True} if clip.loops else None)
    times = buffer.add(keys.times, bounds=True, shared=f"{shared} times")

    def track(node: int, path: str, clock: int, values: NDArray[np.float32]) -> None:
        animation.samplers.append(
            gl.AnimationSampler(
                input=clock, output=buffer.add(values, shared=f"{shared} {values.shape[1]}"), interpolation="LINEAR"
            )
        )
        target = gl.AnimationChannelTarget(node=node, path=path)
        animation.channels.append(gl.AnimationChannel(sampler=len(animation.samplers) - 1, target=target))

    track(int(np.flatnonzero(skeleton.parents < 0)[0]), "translation", times, keys.root)
    held = None
    for joint in np.flatnonzero(keys.turning):
        if keys.moving[joint]:
            track(int(joint), "rotation", times, np.ascontiguousarray(keys.rotations[:, joint]))
        else:  # turned once and for all: one key says it
            if held is None:
                held = buffer.add(keys.times[:1], bounds=True, shared=f"{shared} times")
            track(int(joint), "rotation", held, np.ascontiguousarray(keys.rotations[:1, joint]))
    gltf.animations.append(animation)


def add_expressions(gltf: gl.GLTF2, buffer: Buffer, clip: Clip, weights: NDArray[np.float32], node: int) -> None:
    """Add weights (F, M) of all morph targets of a mesh's node to the animation that was added last, which is that of the clip.

    Raises ValueError where they have another number of frames than the clip.
    """
    if len(weights) != len(clip.rotations):
        raise ValueError(f"the clip {clip.name!r} has {len(clip.rotations)} frames, its expressions {len(weights)}")
    animation = gltf.animations[-1]
    if clip.loops or len(weights) == 1:
        weights = np.concatenate([weights, weights[:1]])  # as `tracks` closes a loop, and holds a single frame
    clock = animation.samplers[0].input
    animation.samplers.append(
        gl.AnimationSampler(input=clock, output=buffer.add(weights.ravel()), interpolation="LINEAR")
    )
    target = gl.AnimationChannelTarget(node=node, path="weights")
    animation.channels.append(gl.AnimationChannel(sampler=len(animation.samplers) - 1, target=target))


def _between_axes(rotations: NDArray[np.float32], skeleton: Skeleton, axes: NDArray[np.float64]) -> NDArray[np.float32]:
    """Turns (K, J, 4) of joints whose axes are the world's, for joints that have these `axes` (J, 3, 3) at rest."""
    above = rotation.from_matrix(axes_above(skeleton, axes))
    turned = rotation.chain(rotation.inverse(above), rotations, rotation.from_matrix(axes))
    return turned.astype(np.float32)
