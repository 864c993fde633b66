"""Which hosts may be called on behalf of a user: public ones, and those in networks that the operator allows.

A user's address must not lead to what only this machine or its network can reach (server-side request forgery). A
name says nothing: it may point anywhere, and somewhere else a moment later. So names are resolved once, the addresses
found are judged, and the connection goes to one of them (see `client`).

Reserved addresses are those of the IANA special-purpose registries (RFC 6890) and multicast; of IPv6, only the
allocated global unicast block 2000::/3 counts as public, without what carries an IPv4 address in it (RFC 3056, 4380).
With that, addresses that stand for IPv4 ones by mapping or translation (::ffff:0:0/96, 64:ff9b::/96) are reserved too.
"""

from __future__ import annotations

import re
import socket
from collections.abc import Sequence
from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network, ip_address, ip_network
from queue import Empty, SimpleQueue
from threading import Thread

import httpx
import structlog

Address = IPv4Address | IPv6Address
Network = IPv4Network | IPv6Network

GLOBAL_UNICAST = IPv6Network("2000::/3")
RESERVED_NETWORKS = tuple(
    ip_network(network)
    for network in (
        "192.88.99.0/24",  # 6to4 relays
        "2001::/23",  # protocol assignments, Teredo among them
        "2001:db8::/32",  # documentation
        "2002::/16",  # 6to4
        "3fff::/20",  # documentation
    )
)
"""Reserved networks of which the standard library's `is_global` does not know, or did not in every version."""

MAX_URL_CHARACTERS = 2000
HOST_PATTERN = re.compile(r"[\w-]+(\.[\w-]+)*\.?")


class AddressRefused(Exception):
    """This host may not be called; the message says why."""


def is_public(address: Address) -> bool:
    """Whether an address is one of the public internet."""
    if address.is_multicast or not address.is_global:
        return False
    if isinstance(address, IPv6Address) and address not in GLOBAL_UNICAST:
        return False
    return not any(address in network for network in RESERVED_NETWORKS)


def may_call(address: Address, allowed: Sequence[Network], encrypted: bool) -> bool:
    """Whether a host at this address may be called: an allowed one in any way, a public one by TLS."""
    return any(address in network for network in allowed) or (encrypted and is_public(address))


def require_callable(url: str, allowed: Sequence[Network]) -> None:
    """Refuse an address that can be seen to lead nowhere, before anything is called. Raises `AddressRefused`.

    Names are not looked up here: what they point at is judged when they are called.
    """
    try:
        parsed = httpx.URL(url)
    except httpx.InvalidURL as error:
        raise AddressRefused(f"It is no address: {error}.") from error
    if len(url) > MAX_URL_CHARACTERS:
        raise AddressRefused(f"An address may have {MAX_URL_CHARACTERS} characters at most.")
    encrypted = parsed.scheme == "https"
    if parsed.scheme not in ("http", "https") or not parsed.host:
        raise AddressRefused("Only addresses that begin with https:// can be called.")
    if parsed.userinfo:
        raise AddressRefused("An address may not carry a user name or a password.")
    if not encrypted and not allowed:
        raise AddressRefused("Only addresses that begin with https:// can be called; http:// is for allowed networks.")
    literal = _literal(parsed.host)
    if literal is None and HOST_PATTERN.fullmatch(parsed.host) is None:
        raise AddressRefused(f"“{parsed.host[:80]}” is no name of a host.")
    if literal is not None and not may_call(literal, allowed, encrypted):
        raise _refusal(parsed.host, [literal], encrypted)


def resolve(
    host: str, port: int, allowed: Sequence[Network], encrypted: bool = True, seconds: float | None = None
) -> list[str]:
    """Look a host up once. Returns those of its addresses that may be called, in the resolver's order.

    Raises `AddressRefused` if there is none, TimeoutError after `seconds`, OSError if the name is not known.
    """
    found = list(dict.fromkeys(_looked_up(host, port, seconds)))
    callable_ = [str(address) for address in found if may_call(address, allowed, encrypted)]
    if not callable_:
        raise _refusal(host, found, encrypted)
    return callable_


def _looked_up(host: str, port: int, seconds: float | None) -> list[Address]:
    """All addresses of a host. The system's resolver knows no deadline: it is waited for no longer than `seconds`."""
    answers: SimpleQueue[list[Address] | Exception] = SimpleQueue()

    def look_up() -> None:
        try:
            found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
            answers.put([ip_address(str(sockaddr[0])) for *_, sockaddr in found])
        except UnicodeError:
            answers.put(OSError(f"“{host[:80]}” is no name of a host"))
        except Exception as error:
            answers.put(error)

    Thread(target=look_up, name="look_up", daemon=True).start()
    try:
        answer = answers.get(timeout=seconds)
    except Empty:
        raise TimeoutError(f"“{host}” could not be looked up in time") from None
    if isinstance(answer, Exception):
        raise answer
    return answer


def _literal(host: str) -> Address | None:
    """The address that a host is written as, in any way that the resolver reads (127.0.0.1, 127.1, 0x7f000001)."""
    if host.lower() == "localhost" or host.lower().endswith(".localhost"):
        return IPv4Address("127.0.0.1")
    try:
        return ip_address(host)
    except ValueError:
        pass
    try:
        return IPv4Address(socket.inet_aton(host))
    except OSError:
        return None


def _refusal(host: str, found: Sequence[Address], encrypted: bool) -> AddressRefused:
    """Why none of a host's addresses may be called. They are for the operator, in the log: whoever gave the host could
    else have the names of a private network looked up."""
    structlog.get_logger().info("address_refused", host=host, addresses=[str(address) for address in found])
    if not encrypted and all(map(is_public, found)):
        return AddressRefused(f"{host[:80]} is in no network that may be called without TLS: use https://.")
    return AddressRefused(
        f"{host[:80]} leads to a private network, and to none that the operator allows (GALATEA_ALLOWED_NETWORKS)."
    )
