"""The built-in performances, as the service offers them."""

from __future__ import annotations

from service.drivers.schemas import DriverOut


def names() -> tuple[str, ...]:
    """The names of the built-in performances."""
    return ()


def shown() -> list[DriverOut]:
    """The built-in performances as the API shows them."""
    return []
