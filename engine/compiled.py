"""Loops compiled by numba: kept between processes, and loaded there without all that only compiling needs."""

# ruff: noqa: E402 - what numba is not to load is hidden before it is loaded

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable, Iterator
from types import CodeType
from typing import Any

import numpy as np

CONSTANT_TYPES = (bool, int, float, str, tuple, np.generic)
"""What a compiled function holds as it was when it was compiled."""

UNUSED_MODULES = [name for name in ("colorama", "coverage", "yaml") if name not in sys.modules]
"""What numba loads only because it is there; its settings come from the environment here, not from a file."""

for name in UNUSED_MODULES:
    sys.modules[name] = None  # type: ignore[assignment]
import numba
from numba.core.caching import FunctionCache
from numba.core.runtime.nrt import rtsys

for name in UNUSED_MODULES:
    del sys.modules[name]


def njit(**flags: Any) -> Callable[[Callable[..., Any]], Any]:
    """`numba.njit` with these flags; what is compiled is kept beside the source, or where `NUMBA_CACHE_DIR` says."""

    flags = flags | {"no_cfunc_wrapper": True}  # nobody calls one from C

    def compiled(function: Callable[..., Any]) -> Any:
        dispatcher = numba.njit(**flags)(function)
        dispatcher._cache = _Kept(function)  # type: ignore[no-untyped-call]
        return dispatcher

    return compiled


class _Kept(FunctionCache):
    """Numba readies its whole compiler, SciPy's linear algebra included, before it looks for what was kept: a third of a
    second in which a short clip is half drawn. Machine code needs its memory's manager alone."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The function for these types from the disk; None where it has to be compiled, for which all is ready then."""
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            kept = self._load_overload(sig, target_context)  # type: ignore[no-untyped-call]
        if kept is not None:
            return kept
        return super().load_overload(sig, target_context)  # type: ignore[no-untyped-call]

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        """Numba looks at the function's own file alone; but what it calls is compiled into it, and constants of other files are."""
        key = super()._index_key(sig, codegen)  # type: ignore[no-untyped-call]
        return (*key, _fingerprint(self._py_func))


def _fingerprint(function: Any) -> str:
    """Of a function's code, of all compiled functions that it calls, and of the constants that they are compiled with."""
    digest = hashlib.sha256()
    seen: set[Any] = set()
    open_ends = [function]
    while open_ends:
        one = open_ends.pop()
        if one in seen:
            continue
        seen.add(one)
        for code in _codes(one.__code__):
            digest.update(code.co_code + repr([c for c in code.co_consts if not isinstance(c, CodeType)]).encode())
            for name in code.co_names:
                value = one.__globals__.get(name)
                if isinstance(value, numba.core.dispatcher.Dispatcher):
                    open_ends.append(value.py_func)
                elif isinstance(value, CONSTANT_TYPES):
                    digest.update(f"{name}={value!r}".encode())
                elif isinstance(value, np.ndarray):
                    digest.update(name.encode() + value.tobytes())
    return digest.hexdigest()


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)
