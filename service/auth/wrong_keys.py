"""Wrong keys: counted by the address that they come from, and all together, and answered with 429 beyond a limit.

Only what was found to be wrong is counted, so that a good key is answered whatever else comes from its address. A key
is 256 random bits: nobody finds one by trying. What is bounded here is what the trying costs.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from ipaddress import IPv6Address, IPv6Network, ip_address

from starlette.requests import HTTPConnection

from service.auth.rate import take_from_bucket
from service.context import Context
from service.outbound.address import Network
from service.problems import Problem

ADDRESS_BUCKETS = 4096
"""Addresses are counted in so many buckets: who shares one with a stranger is slowed down with them, and Redis holds no
more than these however many addresses there are."""

TOTAL_TO_ADDRESS_RATIO = 20
"""How many times what one address may send all may send together."""

WRONG_KEYS_BURST_SECONDS = 60.0


def count_wrong_key(context: Context, request: HTTPConnection) -> None:
    """Count a key that opened nothing. Raises a 429 problem where there are too many."""
    most = context.settings.wrong_keys_per_minute
    place = zlib.crc32(caller_address(request, context.settings.trusted_proxies).encode()) % ADDRESS_BUCKETS
    seconds = max(
        take_from_bucket(context.queue, f"galatea:wrong:{place}", most, WRONG_KEYS_BURST_SECONDS),
        take_from_bucket(context.queue, "galatea:wrong:all", most * TOTAL_TO_ADDRESS_RATIO, WRONG_KEYS_BURST_SECONDS),
    )
    if seconds > 0:
        raise Problem(
            429,
            "too_many_wrong_keys",
            f"Too many wrong keys have come: correct the key, and try again in {seconds} s.",
            headers={"Retry-After": str(seconds)},
        )


def caller_address(request: HTTPConnection, proxies: Sequence[Network]) -> str:
    """Where a request comes from: of IPv6, the network of 64 bits. Of what trusted proxies passed on, the last address
    that is none of theirs: what stands before it anybody may have written."""
    came = [request.client.host if request.client is not None else ""]
    came += [one.strip() for one in reversed(request.headers.get("x-forwarded-for", "").split(","))]
    address = came[0]
    for one in came:
        try:
            parsed = ip_address(one)
        except ValueError:
            break
        wide = isinstance(parsed, IPv6Address)
        address = str(IPv6Network((parsed, 64), strict=False)) if wide else str(parsed)
        if not any(parsed in network for network in proxies):
            break
    return address
