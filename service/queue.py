"""The queue: hints to the workers that a job waits. It may forget them; SQL is the truth and the sweep sends again.

A message makes a worker look, and no more: which job of that kind it takes is decided in SQL (`leases.claim_next`).
"""

from __future__ import annotations

from collections.abc import Iterable

import redis
import structlog
from celery import Celery
from kombu import Exchange
from kombu import Queue as KombuQueue
from kombu.exceptions import OperationalError

from service.redis_server import socket_path
from service.settings import Settings

TASK = "galatea.run_job"
VISIBILITY_MARGIN = 120.0
"""Seconds by which an unacknowledged message outlives the longest job: the job is asked to stop, then its process is
killed, and only then may the message come back."""


def queue_name(kind: str) -> str:
    """The queue of a job kind: one each, so that a long kind does not hold up a short one."""
    return f"galatea.{kind}"


def _queue(kind: str) -> KombuQueue:
    # The anonymous exchange routes by the queue's name alone: other exchanges keep their bindings in Redis, and a
    # Redis that lost its data would swallow messages.
    return KombuQueue(queue_name(kind), Exchange(""), routing_key=queue_name(kind))


class Queue:
    """Sends messages that carry a job's id and kind, and nothing else."""

    def __init__(self, settings: Settings, kinds: Iterable[str]):
        url = settings.redis_url or f"unix://{socket_path(settings.data_dir)}"
        self.redis = redis.Redis.from_url(url, socket_timeout=5, socket_connect_timeout=2)
        self.celery = Celery("galatea", broker=url.replace("unix://", "redis+socket://"))
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
                "visibility_timeout": int(settings.job_seconds + VISIBILITY_MARGIN),
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
        try:
            self.celery.send_task(TASK, args=[job_id, kind], queue=_queue(kind), retry=False, ignore_result=True)
        except (OperationalError, redis.RedisError, OSError) as error:
            structlog.get_logger().warning("message_not_sent", job=job_id, reason=str(error))
            return False
        return True

    def waiting(self, kind: str) -> int:
        """How many messages of a kind wait. Raises `redis.RedisError` if the queue cannot be reached."""
        return int(self.redis.llen(queue_name(kind)))

    def reachable(self) -> bool:
        """Whether Redis answers."""
        try:
            return bool(self.redis.ping())
        except redis.RedisError:
            return False

    def close(self) -> None:
        self.redis.close()
        self.celery.close()
