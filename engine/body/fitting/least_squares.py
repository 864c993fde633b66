"""Nonlinear least squares for models of which many parameters are evaluated at once.

Source: D. Marquardt, An Algorithm for Least-Squares Estimation of Nonlinear Parameters, J. SIAM 11, 1963.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

DIFFERENCE_STEP = 1e-4
"""The difference of a parameter from which derivatives come."""
MAX_SEARCH_STEPS = 40
"""Most steps of a search."""
MIN_RELATIVE_GAIN = 1e-5
"""The share of the sum of squares that a step must gain for the search to go on."""


def levenberg_marquardt(
    residuals: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    start: NDArray[np.float64],
    steps: int = MAX_SEARCH_STEPS,
) -> NDArray[np.float64]:
    """The parameters (P,) near `start` for which the sum of squares of `residuals`, (N, P) to (N, R), is least, as far as so
    many `steps` lead.

    By Levenberg and Marquardt's method, with the derivatives from differences: all of them come out of one evaluation.
    """
    parameters, damping = start, 1e-2
    now = residuals(parameters[None])[0]
    for _ in range(steps):
        jacobian = (residuals(parameters + DIFFERENCE_STEP * np.eye(len(parameters))) - now).T / DIFFERENCE_STEP
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
        if gain < MIN_RELATIVE_GAIN:
            break
    return parameters
