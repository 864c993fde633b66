"""Frames that show something else where a face should be: a floor beside the foot, an arm before the trunk.

Source: section 3.1 of M. Waechter, N. Moehrle, M. Goesele, Let There Be Color! Large-Scale Texturing of 3D Reconstructions, ECCV
2014: a frame is left out at a face whose colour there most frames contradict.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.avatar.texture.view_samples import ViewSamples

MIN_FRAMES_SHOWING_FACE = 4
"""That show a face, for most of them to be right."""
MAX_MEDIAN_DEVIATIONS = 3.0
"""Median distances of frames from what they agree on, beyond which one contradicts the others."""
MIN_CONTRADICTION_GREY_LEVELS = 28.0
"""Grey levels, all three channels together, up to which nothing is a contradiction: shadows and highlights."""
FACES_AT_ONCE = 4096
"""Faces that are looked at together: they are as many times frames numbers."""


def consistent(
    samples: ViewSamples, gains: NDArray[np.floating], doubted: NDArray[np.bool_] | None = None
) -> ViewSamples:
    """What frames show, but for faces at which most frames contradict them, and for `doubted` ones (T,) that too few show to contradict
    any; `gains` (N, 3) of the frames."""
    faces, frames = samples.cosine.shape
    edges = len(samples.pairs)
    means = samples.colours.mean(2, dtype=np.float32) * np.asarray(gains, np.float32)
    ends = (samples.pairs.ravel(), np.arange(edges).repeat(2))
    of_face = sp.csr_array((np.ones(2 * edges, np.float32), ends), (faces, edges))
    number = np.maximum(np.asarray(of_face.sum(1)).ravel(), 1)
    cosine = samples.cosine.copy()
    for start in range(0, faces, FACES_AT_ONCE):
        part = slice(start, start + FACES_AT_ONCE)
        colours = (of_face[part] @ means.reshape(edges, -1)).reshape(-1, frames, 3) / number[part, None, None]
        seen = cosine[part] > 0
        cosine[part] = np.where(_contradicted(colours, seen), 0, cosine[part])
    if doubted is not None:
        cosine[doubted & ((samples.cosine > 0).sum(1) < MIN_FRAMES_SHOWING_FACE)] = 0
    return replace(samples, cosine=cosine)


def _contradicted(colours: NDArray[np.float32], seen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(T, N) where the colours (T, N, 3) of frames that have `seen` (T, N) a face are not those that most have."""
    enough = seen.sum(1) >= MIN_FRAMES_SHOWING_FACE
    out = np.zeros(seen.shape, np.bool_)
    shown = np.where(seen[enough, :, None], colours[enough], np.nan)
    away = np.linalg.norm(shown - np.nanmedian(shown, axis=1, keepdims=True), axis=2)
    limit = np.maximum(MAX_MEDIAN_DEVIATIONS * np.nanmedian(away, axis=1, keepdims=True), MIN_CONTRADICTION_GREY_LEVELS)
    out[enough] = seen[enough] & (away > limit)
    return out
