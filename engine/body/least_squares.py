"""Nonlinear least squares for models of which many parameters are evaluated at once.

Source: D. Marquardt, An Algorithm for Least-Squares Estimation of Nonlinear Parameters, J. SIAM 11, 1963.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

TINY = 1e-4
"""The difference from which derivatives come."""
STEPS = 40
"""Most steps of the search ..."""
LEAST_GAIN = 1e-5
"""... which ends when a step makes less of a difference than this share of the sum of squares."""


def descend(
    residuals: Callable[[NDArray[np.float64]], NDArray[np.float64]], start: NDArray[np.float64], steps: int = STEPS
) -> NDArray[np.float64]:
    """The parameters (P,) near `start` for which the sum of squares of `residuals`, (N, P) to (N, R), is least, as far as so
    many `steps` lead.

    By Levenberg and Marquardt's method, with the derivatives from differences: all of them come out of one evaluation.
    """
    parameters, damping = start, 1e-2
    now = residuals(parameters[None])[0]
    for _ in range(steps):
        jacobian = (residuals(parameters + TINY * np.eye(len(parameters))) - now).T / TINY
        gradient, hessian = jacobian.T @ now, jacobian.T @ jacobian
        gain = 0.0
        for _ in range(6):
            step = np.linalg.solve(hessian + damping * np.diag(np.diag(hessian) + 1e-6), -gradient)
            tried = residuals((parameters + step)[None])[0]
            if tried @ tried < now @ now:
                gain = float(1 - (tried @ tried) / (now @ now))
                parameters, now, damping = parameters + step, tried, damping / 3
                break
            damping *= 4
        if gain < LEAST_GAIN:
            break
    return parameters
