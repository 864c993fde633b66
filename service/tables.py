"""All tables, for whoever needs their whole description (the database's sessions, the migrations)."""

from service.artifacts.models import Artifact
from service.database import Base
from service.drivers.models import Driver
from service.events.models import Event
from service.files.models import File
from service.jobs.models import IdempotencyKey, Job, JobFile

__all__ = ["Artifact", "Base", "Driver", "Event", "File", "IdempotencyKey", "Job", "JobFile"]
