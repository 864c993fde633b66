"""The service's figures for Prometheus, read from SQL and the queue whenever they are asked for."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from itertools import groupby
from operator import itemgetter

import redis
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from service.clock import now
from service.context import Context
from service.disk import free_mb
from service.figures.counters import COUNTER_DESCRIPTIONS, all_counters
from service.job_records import jobs as repository
from service.settings import BYTES_PER_MEGABYTE
from service.tables.jobs import Status
from service.webhooks import repository as webhooks


class ServiceCollector(Collector):
    """Jobs by kind and status, what waits, what was counted, free space."""

    def __init__(self, context: Context):
        self._context = context

    def collect(self) -> Iterator[Metric]:
        jobs = GaugeMetricFamily("galatea_jobs", "Jobs by kind and status.", labels=["kind", "status"])
        with self._context.database.read() as session:
            counts = repository.count_by_kind_and_status(session)
            waiting = repository.oldest_queued(session)
            backlog = webhooks.backlog(session)
            figures = {name: list(group) for name, group in groupby(all_counters(session), key=itemgetter(0))}
        for kind in self._context.kinds:
            for status in Status:
                jobs.add_metric([kind, status.value], counts.get((kind, status.value), 0))
        yield jobs
        oldest = GaugeMetricFamily("galatea_queue_oldest_seconds", "How long the oldest has waited.", labels=["kind"])
        for kind in self._context.kinds:
            since = waiting.get(kind)
            oldest.add_metric([kind], max(0.0, (now() - since).total_seconds()) if since else 0.0)
        yield oldest
        for name, (description, labels) in COUNTER_DESCRIPTIONS.items():
            counter = CounterMetricFamily(name, description, labels=labels)
            for _, values, value in figures.get(name, ()):
                counter.add_metric(values, value)
            yield counter
        messages = GaugeMetricFamily("galatea_queue_messages", "Messages that wait in the queue.", labels=["kind"])
        try:
            for kind in self._context.kinds:
                messages.add_metric([kind], self._context.queue.waiting(kind))
            up = 1
        except redis.RedisError:
            up = 0
        yield messages
        yield from _webhooks(backlog)
        yield GaugeMetricFamily("galatea_redis_up", "Whether Redis answers.", value=up)
        free = free_mb(self._context.settings) * BYTES_PER_MEGABYTE
        yield GaugeMetricFamily("galatea_disk_free_bytes", "Free space where the data lie.", value=free)


def _webhooks(backlog: webhooks.Backlog) -> Iterator[Metric]:
    """What is still to be told, and how late it is: lag is the service's own, age also that of receivers that fail."""

    def since(moment: datetime | None) -> float:
        return max(0.0, (now() - moment).total_seconds()) if moment is not None else 0.0

    yield GaugeMetricFamily("galatea_webhooks_pending", "Webhooks still to be delivered.", value=backlog.pending)
    yield GaugeMetricFamily(
        "galatea_webhook_lag_seconds", "How long the first that is due has waited for its attempt.", since(backlog.due)
    )
    yield GaugeMetricFamily("galatea_webhook_oldest_seconds", "How old the oldest of them is.", since(backlog.oldest))
