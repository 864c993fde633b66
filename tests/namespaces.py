"""Hosts on a network of their own, on one machine: network namespaces, joined by a bridge in a further one.

Nothing of it is seen from outside: the addresses exist in these namespaces only. Making them takes root.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

NETWORK = "10.213.77"
CLONE_NEWNET = 0x40000000


class NotPermitted(Exception):
    """This machine lets nobody make network namespaces, or lacks what makes them."""


class Host:
    """A host with an address of its own. Processes started with `wrapper` before their command run on it."""

    def __init__(self, namespace: str, address: str, plug: str):
        self.namespace, self.address, self.plug = namespace, address, plug
        self.wrapper = ["nsenter", f"--net=/run/netns/{namespace}", "--"]
        self._thread = ThreadPoolExecutor(1, initializer=self._enter)

    def here(self, ask: Callable[[], T]) -> T:
        """Call something as if from this host: sockets that it opens are this host's."""
        return self._thread.submit(ask).result()

    def _enter(self) -> None:
        with Path(f"/run/netns/{self.namespace}").open() as file:
            if ctypes.CDLL(None, use_errno=True).setns(file.fileno(), CLONE_NEWNET) != 0:
                raise OSError(ctypes.get_errno(), "setns failed")


class Network:
    """The bridge and the hosts on it."""

    def __init__(self) -> None:
        self._name = f"galatea-{os.getpid()}"
        self._hosts: list[Host] = []
        self._switch = f"{self._name}-switch"
        _ip("netns", "add", self._switch)
        _ip("-n", self._switch, "link", "add", "bridge", "type", "bridge")
        _ip("-n", self._switch, "link", "set", "bridge", "up")

    def host(self, name: str) -> Host:
        """A further host."""
        number = len(self._hosts) + 1
        host = Host(f"{self._name}-{name}", f"{NETWORK}.{number}", f"plug{number}")
        self._hosts.append(host)
        _ip("netns", "add", host.namespace)
        _ip("-n", host.namespace, "link", "add", "eth0", "type", "veth", "peer", host.plug, "netns", self._switch)
        _ip("-n", self._switch, "link", "set", host.plug, "master", "bridge")
        _ip("-n", self._switch, "link", "set", host.plug, "up")
        _ip("-n", host.namespace, "addr", "add", f"{host.address}/24", "dev", "eth0")
        for device in ("lo", "eth0"):
            _ip("-n", host.namespace, "link", "set", device, "up")
        return host

    def pull(self, host: Host) -> None:
        """Pull the host's plug."""
        _ip("-n", self._switch, "link", "set", host.plug, "down")

    def plug_in(self, host: Host) -> None:
        _ip("-n", self._switch, "link", "set", host.plug, "up")

    def close(self) -> None:
        for namespace in (*(host.namespace for host in self._hosts), self._switch):
            _ip("netns", "del", namespace)


def _ip(*arguments: str) -> None:
    try:
        subprocess.run(["ip", *arguments], check=True, capture_output=True, text=True)
    except FileNotFoundError as error:
        raise NotPermitted("ip is not installed (Debian: iproute2)") from error
    except subprocess.CalledProcessError as error:
        raise NotPermitted(f"ip {' '.join(arguments)}: {error.stderr.strip()}") from error
