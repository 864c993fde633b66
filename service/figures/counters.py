"""Counting, in the same transaction as what is counted, so that no figure is lost or counted twice."""

from __future__ import annotations

import json
from collections.abc import Iterator

from sqlalchemy import bindparam, select, update
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from service.tables.counters import Counter

COUNTER_DESCRIPTIONS = {
    "galatea_uploaded_bytes": ("Bytes of the files that were uploaded.", ("media",)),
    "galatea_jobs_ended": ("Jobs that ended, with the code of their error.", ("kind", "status", "code")),
    "galatea_stage_seconds": ("Seconds that stages of jobs that succeeded took.", ("kind", "stage")),
    "galatea_stage_runs": ("How often they ran.", ("kind", "stage")),
    "galatea_webhook_attempts": ("Attempts to deliver a webhook, with what came of them.", ("event", "outcome")),
    "galatea_webhook_deliveries": ("Webhooks that were delivered.", ("event",)),
    "galatea_webhook_seconds": ("Seconds between what they told of and their delivery.", ("event",)),
}
"""What is counted: the description and the labels."""

ADD_TO_COUNTER = (
    update(Counter)
    .where(Counter.name == bindparam("its_name"), Counter.labels == bindparam("its_labels"))
    .values(value=Counter.value + bindparam("amount"))
)
BY_THE_DATABASE = {"synchronize_session": False}
"""No counter that a session has loaded is used after it has grown."""


def add(session: Session, name: str, *labels: str, amount: float = 1.0) -> None:
    """Let a counter of `COUNTER_DESCRIPTIONS` grow, for the values of its labels in their order."""
    assert len(labels) == len(COUNTER_DESCRIPTIONS[name][1])
    key = json.dumps(["".join(filter(str.isprintable, label))[:50] for label in labels], ensure_ascii=False)
    grown = {"its_name": name, "its_labels": key, "amount": amount}
    if session.execute(ADD_TO_COUNTER, grown, execution_options=BY_THE_DATABASE).rowcount:  # type: ignore[attr-defined]
        return
    try:
        with session.begin_nested():
            session.add(Counter(name=name, labels=key, value=amount))
    except IntegrityError:  # another process began it in this very moment
        session.execute(ADD_TO_COUNTER, grown, execution_options=BY_THE_DATABASE)


def all_counters(session: Session) -> Iterator[tuple[str, list[str], float]]:
    """All counters: name, values of the labels, value."""
    for counter in session.scalars(select(Counter).order_by(Counter.name, Counter.labels)):
        if counter.name in COUNTER_DESCRIPTIONS:
            yield counter.name, json.loads(counter.labels), counter.value
