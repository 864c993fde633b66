"""The service's figures for Prometheus, read from SQL and the queue whenever they are asked for."""

from __future__ import annotations

from collections.abc import Iterator

import redis
from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from service.context import Context
from service.disk import free_mb
from service.jobs import repository
from service.jobs.models import Status
from service.settings import MEGABYTE


class ServiceCollector(Collector):
    """Jobs by kind and status, messages that wait, free space."""

    def __init__(self, context: Context):
        self._context = context

    def collect(self) -> Iterator[Metric]:
        jobs = GaugeMetricFamily("galatea_jobs", "Jobs by kind and status.", labels=["kind", "status"])
        with self._context.database.read() as session:
            counts = repository.count_by_kind_and_status(session)
        for kind in self._context.kinds:
            for status in Status:
                jobs.add_metric([kind, status.value], counts.get((kind, status.value), 0))
        yield jobs
        messages = GaugeMetricFamily("galatea_queue_messages", "Messages that wait in the queue.", labels=["kind"])
        try:
            for kind in self._context.kinds:
                messages.add_metric([kind], self._context.queue.waiting(kind))
            up = 1
        except redis.RedisError:
            up = 0
        yield messages
        yield GaugeMetricFamily("galatea_redis_up", "Whether Redis answers.", value=up)
        free = free_mb(self._context.settings) * MEGABYTE
        yield GaugeMetricFamily("galatea_disk_free_bytes", "Free space where the data lie.", value=free)
