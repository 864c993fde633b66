"""Who is connected. Beyond the most connections, whoever has waited longest without a request makes room.

A connection waits while no request of it is under way: it is idle, or its head has not come yet. Whoever behaves well
waits for milliseconds, so that connections that bring nothing make room for each other. Where none waits, the newcomer is
turned away. An address may not have all of them to itself.
"""

from __future__ import annotations

import resource
import time
from collections import Counter, OrderedDict
from typing import Protocol as Interface

import structlog

MAX_ADDRESS_SHARE = 0.75
"""The share of all connections that one address may hold."""

MAX_PARTING = 64
"""How many connections may be closed with care at the same time (see `service.connections.transport`). One more is cut off."""

SPARE_FILES = 128
"""File descriptors for all else than connections and what is read for them."""

LOG_SECONDS = 60.0


class Connected(Interface):
    """A connection."""

    address: str

    def make_room(self) -> None:
        """End: no request is under way."""


class ConnectionLimit:
    """All connections of a server."""

    def __init__(self, most: int):
        self.most = most
        self.parting = 0
        self._by_address: Counter[str] = Counter()
        self._waiting: dict[str, OrderedDict[Connected, None]] = {}
        self._turned_away = 0
        self._told_at: float | None = None

    def admit(self, newcomer: Connected) -> bool:
        """Count a connection in, for which another one may have to go. False where there is no room for it."""
        address = newcomer.address
        alone = self._by_address[address] >= max(1, int(MAX_ADDRESS_SHARE * self.most))
        if alone or self._by_address.total() >= self.most:
            self._tell(address)
            longest = self._longest_waiting(address if alone else self._fullest())
            if longest is None:
                return False
            longest.make_room()
        self._by_address[address] += 1
        return True

    def leave(self, connection: Connected) -> None:
        """Count a connection out that was admitted."""
        self.busy(connection)
        self._by_address[connection.address] -= 1
        if self._by_address[connection.address] <= 0:
            del self._by_address[connection.address]

    def wait(self, connection: Connected) -> None:
        """It waits from now on, unless it did already."""
        self._waiting.setdefault(connection.address, OrderedDict()).setdefault(connection)

    def busy(self, connection: Connected) -> None:
        """It does not wait (any more)."""
        there = self._waiting.get(connection.address)
        if there is not None:
            there.pop(connection, None)
            if not there:
                del self._waiting[connection.address]

    def _fullest(self) -> str | None:
        """The address that has most connections among those of which one waits."""
        return max(self._waiting, key=lambda address: self._by_address[address], default=None)

    def _longest_waiting(self, address: str | None) -> Connected | None:
        return next(iter(self._waiting.get(address or "", ())), None)

    def _tell(self, address: str) -> None:
        self._turned_away += 1
        moment = time.monotonic()
        if self._told_at is None or moment - self._told_at > LOG_SECONDS:
            structlog.get_logger().warning(
                "connections_full",
                open=self._by_address.total(),
                most=self.most,
                waiting=sum(map(len, self._waiting.values())),
                turned_away=self._turned_away,
                newcomer=address,
                of_newcomer=self._by_address[address],
            )
            self._told_at, self._turned_away = moment, 0


def raise_file_limit() -> int:
    """Let this process, and those that it starts, open as many files as it may at all; how many that is."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft != hard:
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    return hard if hard != resource.RLIM_INFINITY else 1 << 30


def most_connections(wanted: int, files: int) -> int:
    """How many connections there may be at once: each may read a file meanwhile."""
    most = min(wanted, max(1, (files - SPARE_FILES) // 2))
    if most < wanted:
        structlog.get_logger().warning("connections_bounded_by_open_files", most=most, wanted=wanted, files=files)
    return most
