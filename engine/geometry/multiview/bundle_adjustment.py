"""Bundle adjustment: cameras, lenses and points together, so that every point is seen where it was seen.

Levenberg and Marquardt's method on the reduced camera system: the points are eliminated first (Schur's complement), for
each is seen by a few cameras only. Outliers are kept down by Cauchy's loss.

Source: B. Triggs, P. McLauchlan, R. Hartley, A. Fitzgibbon, Bundle Adjustment - A Modern Synthesis, 2000, sections 4.3
(robust losses), 6.1 (Schur complement), 4.4 (parametrisation of turns by small ones).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from scipy.spatial.transform import Rotation

from engine.geometry.multiview.bundle import Bundle, Observations, reprojection_errors
from engine.geometry.multiview.schur_complement import back_substitute, eliminate_points

LOSS_SCALE_PIXELS = 1.0
"""Pixels of error from which on an observation is doubted."""
FIRST_DAMPING_SHARE = 1e-4
"""Share of the system's diagonal that is added to it in the beginning."""
MIN_DAMPING_SHARE = 1e-10
"""Share of the diagonal that is added, at least."""
MAX_DAMPING_SHARE = 1e8
"""Share of the diagonal with which the search is given up."""
CAMERA_PARAMETERS, LENS_PARAMETERS = 6, 3


@dataclass(frozen=True)
class PosePrior:
    """Poses that cameras are expected to have, normally distributed about them.

    rotations : (C, 3, 3) float64, from the world to each camera.
    translations : (C, 3) float64, likewise.
    turn, shift : radians, and units of length, that count as much as one pixel of error of one observation.
    """

    rotations: NDArray[np.float64]
    translations: NDArray[np.float64]
    turn: float
    shift: float

    def residuals(self, bundle: Bundle) -> NDArray[np.float64]:
        """(C, 6) how far the cameras are turned and shifted from what is expected, in pixels of error."""
        rotated_by = bundle.rotations @ self.rotations.transpose(0, 2, 1)
        shifts = bundle.translations - np.einsum("cij,cj->ci", rotated_by, self.translations)
        return np.concatenate([Rotation.from_matrix(rotated_by).as_rotvec() / self.turn, shifts / self.shift], axis=1)


@dataclass(frozen=True)
class Freedom:
    """What may change beside the points, which always do.

    cameras : (C,) bool, which of them may move.
    lens : whether focal length, k1 and k2 may.
    prior : what is known of the cameras beforehand.
    """

    cameras: NDArray[np.bool_]
    lens: tuple[bool, bool, bool] = (False, False, False)
    prior: PosePrior | None = None


@dataclass(frozen=True)
class Adjustment:
    """The `bundle` adjusted; `cost`, half the sum of the losses in square pixels; `steps` that were taken."""

    bundle: Bundle
    cost: float
    steps: int


def adjust(
    bundle: Bundle,
    seen: Observations,
    freedom: Freedom,
    loss_scale: float = LOSS_SCALE_PIXELS,
    most_steps: int = 50,
    converged: float = 1e-6,
) -> Adjustment:
    """The bundle with the least robust reprojection error.

    Parameters
    ----------
    seen : observations of points that each of two cameras or more see; points without stay where they are.
    freedom : what may change. With all cameras free the frame is free, too; it hardly drifts, by the damping.
    loss_scale : pixels; Cauchy's loss is scale^2 / 2 log(1 + (error / scale)^2).
    converged : the relative decrease of the cost at which the search ends.

    Raises ValueError where there is no observation.
    """
    if not len(seen):
        raise ValueError("nothing was observed")
    seen = seen[np.argsort(seen.point, kind="stable")]
    cost = _cost(bundle, seen, freedom, loss_scale)
    damping, steps = FIRST_DAMPING_SHARE, 0
    while steps < most_steps and damping < MAX_DAMPING_SHARE:
        candidate = _step(bundle, seen, freedom, loss_scale, damping)
        there = np.inf if candidate is None else _cost(candidate, seen, freedom, loss_scale)
        if candidate is None or not there <= cost:
            damping *= 10
            continue
        steps += 1
        settled = cost - there <= converged * cost
        bundle, cost, damping = candidate, there, max(damping / 5, MIN_DAMPING_SHARE)
        if settled:
            break
    return Adjustment(bundle, cost, steps)


def robust_cost(errors: NDArray[np.floating], scale: float) -> float:
    """Half the sum of Cauchy's losses of errors (O,) in pixels."""
    return float(scale**2 / 2 * np.log1p((errors / scale) ** 2).sum())


def _cost(bundle: Bundle, seen: Observations, freedom: Freedom, loss_scale: float) -> float:
    cost = robust_cost(reprojection_errors(bundle, seen), loss_scale)
    if freedom.prior is not None:
        cost += float((freedom.prior.residuals(bundle)[freedom.cameras] ** 2).sum() / 2)
    return cost


def _step(bundle: Bundle, seen: Observations, freedom: Freedom, loss_scale: float, damping: float) -> Bundle | None:
    """The bundle after one damped step; None where the system cannot be solved."""
    slots = np.where(freedom.cameras, np.cumsum(freedom.cameras) - 1, -1)
    first_lens = CAMERA_PARAMETERS * int(freedom.cameras.sum())
    size = first_lens + LENS_PARAMETERS * len(bundle.lenses)
    offsets = seen.pixels - bundle.centres[bundle.lens_of[seen.camera]]
    starts = np.flatnonzero(np.r_[True, np.diff(seen.point) > 0, True]).astype(np.intp)
    geometry = (bundle.rotations, bundle.translations, bundle.lenses, bundle.lens_of, bundle.points)
    layout = (seen.camera, seen.point, offsets, starts, slots, first_lens)
    system, right = np.zeros((size, size)), np.zeros(size)
    own = np.zeros(size)  # the diagonal before elimination, by which damping is measured
    inverses, gradients = np.zeros((len(starts) - 1, 3, 3)), np.zeros((len(starts) - 1, 3))
    eliminate_points(geometry, layout, loss_scale, damping, (system, right, own, inverses, gradients))
    if freedom.prior is not None:
        _expect(freedom, bundle, system, right, own)
    kept = np.r_[np.ones(first_lens, np.bool_), np.tile(freedom.lens, len(bundle.lenses))]
    change = np.zeros(size)
    if kept.any():
        system[np.diag_indices(size)] += damping * np.maximum(own, 1e-12)
        try:
            factor = cho_factor(system[np.ix_(kept, kept)], lower=True, overwrite_a=True)
        except LinAlgError:
            return None
        change[kept] = cho_solve(factor, right[kept])
    shifts = np.zeros((len(starts) - 1, 3))
    back_substitute(geometry, layout, loss_scale, (change, inverses, gradients), shifts)
    if not (np.isfinite(change).all() and np.isfinite(shifts).all()):
        return None
    points = bundle.points.copy()
    points[seen.point[starts[:-1]]] += shifts
    moved = _moved(bundle, freedom, change[:first_lens].reshape(-1, CAMERA_PARAMETERS))
    lenses = bundle.lenses + change[first_lens:].reshape(-1, LENS_PARAMETERS)
    return replace(moved, points=points, lenses=lenses) if (lenses[:, 0] > 0).all() else None


def _expect(
    freedom: Freedom,
    bundle: Bundle,
    system: NDArray[np.float64],
    right: NDArray[np.float64],
    own: NDArray[np.float64],
) -> None:
    """Add what is known of the cameras beforehand; turns being small, each of the six counts by itself."""
    assert freedom.prior is not None
    off = freedom.prior.residuals(bundle)[freedom.cameras]
    slope = np.repeat([1 / freedom.prior.turn, 1 / freedom.prior.shift], 3)
    diagonal = np.arange(off.size)
    system[diagonal, diagonal] += np.tile(slope**2, len(off))
    own[diagonal] += np.tile(slope**2, len(off))
    right[diagonal] -= (off * slope).ravel()


def _moved(bundle: Bundle, freedom: Freedom, change: NDArray[np.float64]) -> Bundle:
    """The free cameras turned and shifted by (F, 6)."""
    rotations, translations = bundle.rotations.copy(), bundle.translations.copy()
    rotated_by = Rotation.from_rotvec(change[:, :3]).as_matrix()
    rotations[freedom.cameras] = rotated_by @ rotations[freedom.cameras]
    translations[freedom.cameras] = np.einsum("cij,cj->ci", rotated_by, translations[freedom.cameras]) + change[:, 3:]
    return replace(bundle, rotations=rotations, translations=translations)
