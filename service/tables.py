"""All tables, for whoever needs their whole description (the database's sessions, the migrations)."""

from service.artifacts.models import Artifact
from service.auth.models import Key
from service.database import Base
from service.drivers.models import Driver
from service.events.models import Event
from service.figures.models import Counter
from service.files.models import File
from service.jobs.models import IdempotencyKey, Job, JobFile
from service.links.models import PublicLink
from service.motions.models import Motion
from service.uploads.models import Upload
from service.webhooks.models import Delivery, DeliveryAttempt, Webhook

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
