"""All tables, in one place: who imports one of them imports all, since they refer to each other by name.

A table knows of columns and nothing of what is done with its rows."""

from service.tables.artifacts import Artifact
from service.tables.base import Base
from service.tables.counters import Counter
from service.tables.events import Event
from service.tables.files import File
from service.tables.jobs import IdempotencyKey, Job, JobFile
from service.tables.kept import Driver, Motion
from service.tables.keys import Key
from service.tables.links import PublicLink
from service.tables.uploads import Upload
from service.tables.webhooks import Delivery, DeliveryAttempt, Webhook

__all__ = [
    "Artifact",
    "Base",
    "Counter",
    "Delivery",
    "DeliveryAttempt",
    "Driver",
    "Event",
    "File",
    "IdempotencyKey",
    "Job",
    "JobFile",
    "Key",
    "Motion",
    "PublicLink",
    "Upload",
    "Webhook",
]
