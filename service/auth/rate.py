"""How often a key may ask: counted in Redis, so that several API hosts count together.

Each key has a bucket that holds a quarter of a minute's requests and fills evenly (the generic cell rate
algorithm: one moment per key says when the bucket will be full again).
"""

from __future__ import annotations

import math

import redis
import structlog
from redis.commands.core import Script

from service.problems import Problem

BURST_SECONDS = 15.0

SCRIPT = """
local time = redis.call('TIME')
local now = tonumber(time[1]) + tonumber(time[2]) / 1e6
local full = tonumber(redis.call('GET', KEYS[1]) or now)
if full < now then full = now end
local wait = full + tonumber(ARGV[1]) - now - tonumber(ARGV[2])
if wait > 0 then return tostring(wait) end
redis.call('SET', KEYS[1], string.format('%.6f', full + tonumber(ARGV[1])), 'PX', math.ceil(tonumber(ARGV[2]) * 2000))
return '0'
"""


def take_one(client: redis.Redis, key_id: str, per_minute: float) -> None:
    """Count one request. Raises a 429 problem that says when the next one will be answered.

    While Redis is away nothing is counted: the service goes on without it, and so do its callers.
    """
    try:
        count = Script(client, SCRIPT)  # sent whole only where Redis does not know it yet
        waited = count([f"galatea:rate:{key_id}"], [60 / per_minute, max(BURST_SECONDS, 60 / per_minute)])
    except redis.RedisError as error:
        structlog.get_logger().warning("rate_not_counted", reason=str(error))
        return
    seconds = math.ceil(float(waited))  # type: ignore[arg-type]
    if seconds > 0:
        raise Problem(
            429,
            "rate_limited",
            f"The key may send {per_minute:g} requests a minute: go on in {seconds} s.",
            headers={"Retry-After": str(seconds)},
        )
