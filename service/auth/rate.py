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
from service.queue import Queue

REQUESTS_BURST_SECONDS = 15.0

BUCKET_SCRIPT = """
local time = redis.call('TIME')
local now = tonumber(time[1]) + tonumber(time[2]) / 1e6
local full = tonumber(redis.call('GET', KEYS[1]) or now)
if full < now then full = now end
local wait = full + tonumber(ARGV[1]) - now - tonumber(ARGV[2])
if wait > 0 then return tostring(wait) end
redis.call('SET', KEYS[1], string.format('%.6f', full + tonumber(ARGV[1])), 'PX', math.ceil(tonumber(ARGV[2]) * 2000))
return '0'
"""


def take_from_bucket(queue: Queue, bucket: str, per_minute: float, burst_seconds: float) -> int:
    """Take one from a bucket. Returns 0, or in how many seconds there will be one; 0 while Redis is away."""
    try:
        # A script is sent whole only where Redis does not know it yet.
        limits = [60 / per_minute, max(burst_seconds, 60 / per_minute)]
        waited = queue.ask(lambda client: Script(client, BUCKET_SCRIPT)([bucket], limits))
    except redis.RedisError as error:
        structlog.get_logger().warning("rate_not_counted", reason=str(error))
        return 0
    return math.ceil(float(waited))


def take_one(queue: Queue, key_id: str, per_minute: float) -> None:
    """Count one request. Raises a 429 problem that says when the next one will be answered.

    While Redis is away nothing is counted: the service goes on without it, and so do its callers.
    """
    seconds = take_from_bucket(queue, f"galatea:rate:{key_id}", per_minute, REQUESTS_BURST_SECONDS)
    if seconds > 0:
        raise Problem(
            429,
            "rate_limited",
            f"The key may send {per_minute:g} requests a minute: go on in {seconds} s.",
            headers={"Retry-After": str(seconds)},
        )
