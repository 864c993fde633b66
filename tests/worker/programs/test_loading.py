"""What is loaded is not looked through for rubbish, then or later; what comes after it is."""

from __future__ import annotations

import gc
import weakref

import pytest

from worker.programs.loading import loading


class Ring:
    """Rubbish that only the collector finds: it holds itself."""

    def __init__(self) -> None:
        self.itself = self


def test_what_was_loaded_is_left_alone_and_what_comes_later_is_not() -> None:
    try:
        with loading():
            assert not gc.isenabled()
            loaded = weakref.ref(Ring())
        assert gc.isenabled()
        later = weakref.ref(Ring())
        gc.collect()
        assert loaded() is not None and later() is None
    finally:
        gc.unfreeze()
    gc.collect()
    assert loaded() is None


def test_whoever_collects_nothing_goes_on_so() -> None:
    gc.disable()
    try:
        with pytest.raises(ZeroDivisionError), loading():
            _ = 1 / 0
        assert not gc.isenabled()
    finally:
        gc.unfreeze()
        gc.enable()
