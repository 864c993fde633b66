"""The queue: hints to the workers that a job waits. It may forget them; SQL is the truth and the sweep sends again.

A message makes a worker look, and no more: which job of that kind it takes is decided in SQL (`fair_queue.claim_next`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import redis
import structlog
from celery import Celery
from kombu.entity import Exchange
from kombu.entity import Queue as KombuQueue
from kombu.exceptions import OperationalError

from service.breaker import Breaker
from service.redis_server import socket_path
from service.settings import Settings

TASK_NAME = "galatea.run_job"
VISIBILITY_MARGIN_SECONDS = 120.0
"""Seconds by which an unacknowledged message outlives the longest job: the job is asked to stop, then its process is
killed, and only then may the message come back."""

SEND_TIMEOUTS = {"socket_timeout": 2, "socket_connect_timeout": 1}
"""Seconds that sending waits for a Redis that does not answer: a client waits meanwhile, and the sweep sends again."""


Answer = TypeVar("Answer")


def queue_name(kind: str) -> str:
    """The queue of a job kind: one each, so that a long kind does not hold up a short one."""
    return f"galatea.{kind}"


def _queue(kind: str) -> KombuQueue:
    # The anonymous exchange routes by the queue's name alone: other exchanges keep their bindings in Redis, and a
    # Redis that lost its data would swallow messages.
    return KombuQueue(queue_name(kind), Exchange(""), routing_key=queue_name(kind))


class _Hints(Celery):  # type: ignore[misc]  # Celery tells no types
    """Sends with less patience than it listens."""

    def connection_for_write(self, url: str | None = None, **more: Any) -> Any:
        return super().connection_for_write(url, **{**more, "transport_options": SEND_TIMEOUTS})


class Queue:
    """Sends messages that carry a job's id and kind, and nothing else. While Redis is known not to answer, nobody waits
    for it."""

    def __init__(self, settings: Settings, kinds: Iterable[str]):
        url = settings.redis_url or f"unix://{socket_path(settings.data_dir)}"
        self._redis = redis.Redis.from_url(url, **SEND_TIMEOUTS)
        self._breaker = Breaker("redis", self._answers)
        self.celery = _Hints("galatea", broker=url.replace("unix://", "redis+socket://"))
        self.celery.conf.update(
            task_queues=[_queue(kind) for kind in kinds],
            task_create_missing_queues=False,
            task_acks_late=True,
            task_ignore_result=True,
            worker_prefetch_multiplier=1,
            worker_pool="threads",
            worker_concurrency=settings.concurrency,
            worker_enable_remote_control=False,
            worker_send_task_events=False,
            worker_hijack_root_logger=False,
            worker_redirect_stdouts=False,
            worker_cancel_long_running_tasks_on_connection_loss=False,
            broker_connection_retry_on_startup=True,
            broker_connection_max_retries=None,
            broker_transport_options={
                "visibility_timeout": int(settings.job_seconds + VISIBILITY_MARGIN_SECONDS),
                "socket_timeout": 10,
                "socket_connect_timeout": 2,
                "health_check_interval": 10,
                # Sending does not wait for a Redis that is away: the sweep sends again.
                "max_retries": 1,
                "interval_start": 0,
                "interval_step": 0.1,
            },
        )

    def send(self, job_id: str, kind: str) -> bool:
        """Tell the workers that a job waits; False if the queue cannot be reached now."""
        if self._breaker.open:
            return False
        try:
            self.celery.send_task(TASK_NAME, args=[job_id, kind], queue=_queue(kind), retry=False, ignore_result=True)
        except (OperationalError, redis.RedisError, OSError) as error:
            self._breaker.trip()
            structlog.get_logger().warning("message_not_sent", job=job_id, reason=str(error))
            return False
        return True

    def waiting(self, kind: str) -> int:
        """How many messages of a kind wait. Raises `redis.RedisError` if the queue cannot be reached."""
        return int(self.ask(lambda client: client.llen(queue_name(kind))))

    def reachable(self) -> bool:
        """Whether Redis answers."""
        try:
            return bool(self.ask(lambda client: client.ping()))
        except redis.RedisError:
            return False

    def ask(self, question: Callable[[redis.Redis], Answer]) -> Answer:
        """What Redis answers to anything. Raises `redis.RedisError` if it does not: at once where that is known."""
        if self._breaker.open:
            raise redis.ConnectionError("Redis does not answer")
        try:
            return question(self._redis)
        except (redis.ConnectionError, redis.TimeoutError):
            self._breaker.trip()
            raise

    def _answers(self) -> bool:
        try:
            return bool(self._redis.ping())
        except redis.RedisError:
            return False

    def close(self) -> None:
        self._breaker.end()
        self._redis.close()
        self.celery.close()
