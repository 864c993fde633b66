"""A client for the HTTP API of Galatea: portraits brought to life.

    from galatea_client import Client

    with Client("http://127.0.0.1:8000") as galatea:
        job = galatea.submit("portrait", {"image": Path("portrait.jpg"), "driver": "happy"})
        job.wait().download("animation.mp4", "out")

`AsyncClient` is the same for asyncio.

It needs httpx and pydantic, and nothing else of this repository.
"""

from galatea_client.async_client import AsyncClient
from galatea_client.client import Client
from galatea_client.errors import (
    ApiError,
    Conflict,
    DownloadBroken,
    GalateaError,
    InvalidAddress,
    InvalidRequest,
    JobFailed,
    LimitReached,
    NotAllowed,
    NotAName,
    NotFound,
    Unavailable,
    Unreachable,
)
from galatea_client.events import ArtifactEvent, Event, ProgressEvent, StatusEvent
from galatea_client.job import AsyncJob, Job
from galatea_client.models import (
    Artifact,
    Attempt,
    Delivery,
    DeliveryError,
    Disabled,
    Driver,
    File,
    Input,
    JobError,
    Key,
    Kind,
    Link,
    Moment,
    Motion,
    MotionError,
    MotionJoint,
    NewKey,
    NewWebhook,
    OwnKey,
    Progress,
    Status,
    Webhook,
    WebhookSecret,
)

__version__ = "0.1.0"

__all__ = [
    "ApiError",
    "Artifact",
    "ArtifactEvent",
    "AsyncClient",
    "AsyncJob",
    "Attempt",
    "Client",
    "Conflict",
    "Delivery",
    "DeliveryError",
    "Disabled",
    "DownloadBroken",
    "Driver",
    "Event",
    "File",
    "GalateaError",
    "Input",
    "InvalidAddress",
    "InvalidRequest",
    "Job",
    "JobError",
    "JobFailed",
    "Key",
    "Kind",
    "LimitReached",
    "Link",
    "Moment",
    "Motion",
    "MotionError",
    "MotionJoint",
    "NewKey",
    "NewWebhook",
    "NotAName",
    "NotAllowed",
    "NotFound",
    "OwnKey",
    "Progress",
    "ProgressEvent",
    "Status",
    "StatusEvent",
    "Unavailable",
    "Unreachable",
    "Webhook",
    "WebhookSecret",
]
