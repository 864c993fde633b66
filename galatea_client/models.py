"""What the service answers, as typed values. A test holds them against its OpenAPI document.

Names that a newer service adds are passed over, so that an older client goes on working.
"""

from __future__ import annotations

from datetime import datetime
from enum import StrEnum
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationInfo


def _absolute(link: str, info: ValidationInfo) -> str:
    base = (info.context or {}).get("base", "")
    return base + link if link.startswith("/") else link


Address = Annotated[str, AfterValidator(_absolute)]
"""A link of the service's, which begins with "/" in its answers; joined to the address that the client was given."""


class Model(BaseModel):
    """The base of all."""

    model_config = ConfigDict(frozen=True)


class Status(StrEnum):
    """Where a job stands."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELED = "canceled"

    @property
    def final(self) -> bool:
        """Whether the job has ended."""
        return self not in (Status.QUEUED, Status.RUNNING)


class File(Model):
    """An uploaded file."""

    id: str
    name: str
    content_type: str
    size: int
    sha256: str
    created_at: datetime


class Progress(Model):
    """How far a job is: the stage's name, the fraction of all [0, 1], the seconds left where they are known, and the
    stages that have begun so far."""

    stage: str | None = None
    fraction: float = 0.0
    message: str = ""
    eta_seconds: float | None = None
    stages: list[str] = []


class JobError(Model):
    """Why a job failed, the names of corrections that could mend it, and what was found that helps with them."""

    code: str
    detail: str
    correctable: list[str] = []
    found: dict[str, Any] = {}


class Artifact(Model):
    """A result: `size` in bytes, `sha256` in hex. Anybody can read `signed_url` until it expires."""

    url: Address
    signed_url: Address | None = None
    size: int
    sha256: str
    content_type: str


class Input(Model):
    """A named input of a job kind."""

    name: str
    media: str
    description: str
    required: bool
    many: bool
    library: str | None
    trimmed_by: str | None
    spared_by: str | None
    spared_by_input: str | None
    artifact: str | None
    corrects: bool


class KindLimits(Model):
    """The most that a job may take: seconds of work, millions of bytes of memory, cores (None: all that there are)."""

    seconds: float
    memory_mb: float
    cores: int | None


class Kind(Model):
    """A job kind: its inputs, the JSON schemas of inputs and options, and whether a job usually takes seconds."""

    name: str
    summary: str
    inputs: list[Input]
    inputs_schema: dict[str, Any]
    options_schema: dict[str, Any]
    correctable: list[str]
    short: bool
    limits: KindLimits


class Moment(Model):
    """A moment of one's own driver that holds an emotion or a gesture: a job's driver as `DRIVER/MOMENT`."""

    name: str
    state: str
    strength: str
    start: float
    end: float
    seconds: float
    apex: float
    score: float
    url: Address
    poster: Address


class Driver(Model):
    """A driving video that a job can name: a built-in performance, or one's own."""

    name: str
    source: Literal["built-in", "own"]
    url: Address
    poster: Address | None = None
    title: str | None = None
    state: str | None = None
    emotion: str | None = None
    strength: str | None = None
    seconds: float | None = None
    loops: bool | None = None
    size: int | None = None
    content_type: str | None = None
    created_at: datetime | None = None
    moments: list[Moment] = []
    moments_status: Literal["none", "pending", "ready", "failed"] = "none"
    moments_job: str | None = None


class MotionJoint(Model):
    """A joint of a motion's skeleton; `parent` is None for a root."""

    name: str
    parent: str | None


class MotionError(Model):
    """What is wrong with a motion."""

    code: str
    detail: str


class Motion(Model):
    """A motion that a character's job can name: a built-in one, or one's own with what a check found in it.

    `mapping` says which of its joints moves which of a character's (a character's first), `missing` which of those
    were not found: the option `motion_joints` of a job mends both. `clips` are the animations of a GLB, one of which the
    option `motion_clip` chooses.
    """

    name: str
    source: Literal["built-in", "own"]
    title: str | None = None
    seconds: float | None = None
    loops: bool | None = None
    url: Address | None = None
    size: int | None = None
    content_type: str | None = None
    created_at: datetime | None = None
    fps: float | None = None
    frames: int | None = None
    clips: list[str] = []
    joints: list[MotionJoint] = []
    mapping: dict[str, str] = {}
    missing: list[str] = []
    error: MotionError | None = None
    check_status: Literal["none", "pending", "ready", "failed"] = "none"
    check_job: str | None = None


class Key(Model):
    """A key, without its token."""

    id: str
    name: str
    hint: str
    scopes: list[str]
    requests_per_minute: float | None
    jobs_at_once: int | None
    stored_mb: int | None
    created_at: datetime
    expires_at: datetime | None
    revoked_at: datetime | None
    last_used_at: datetime | None


class NewKey(Key):
    """A key that was just made: its token cannot be had again."""

    token: str = Field(repr=False)


class OwnKey(Model):
    """The key that this client uses: its limits, and how much of them is used."""

    id: str
    name: str
    scopes: list[str]
    signing_secret: str | None = Field(repr=False)
    requests_per_minute: float | None
    jobs_at_once: int | None
    stored_mb: int | None
    expires_at: datetime | None
    jobs_under_way: int
    stored_bytes: int


class Link(Model):
    """A public link to a job's results; `url` and `page` are told when it is made, and never again."""

    id: str
    owner: str
    job_id: str
    url: Address | None
    page: Address | None
    hint: str
    artifacts: list[str] | None
    created_at: datetime
    expires_at: datetime | None


class Disabled(Model):
    """Why an endpoint takes no messages: `gone` (it answered 410), `failing` (for days), `by_owner`."""

    code: Literal["gone", "failing", "by_owner"]
    at: datetime | None


class Webhook(Model):
    """An endpoint that is told of jobs."""

    id: str
    url: str
    events: list[str]
    description: str
    enabled: bool
    disabled: Disabled | None
    failing_since: datetime | None
    created_at: datetime


class NewWebhook(Webhook):
    """An endpoint that was just made, with the secret that signs what it is told."""

    secret: str = Field(repr=False)


class WebhookSecret(Model):
    """The secrets that sign for an endpoint; the previous one until `previous_until`."""

    secret: str = Field(repr=False)
    previous_secret: str | None = Field(repr=False)
    previous_until: datetime | None


class DeliveryError(Model):
    """Why an attempt failed."""

    code: str
    detail: str


class Attempt(Model):
    """One attempt to deliver a message; `response_status` is null where there was no answer."""

    started_at: datetime
    seconds: float
    response_status: int | None
    response_excerpt: str
    error: DeliveryError | None


class Delivery(Model):
    """A message for one address; its id is the message's `webhook-id`."""

    id: str
    webhook_id: str | None
    job_id: str | None
    event: str
    url: str
    status: str
    created_at: datetime
    next_attempt_at: datetime | None
    delivered_at: datetime | None
    attempts: int
    last_attempt: Attempt | None


class Live(Model):
    """A portrait that follows a camera. `stream` is the path of the WebSocket that takes the camera's frames, `view` of one for those
    who look on; `code` and `detail` say why it has ended."""

    id: str
    status: Literal["preparing", "calibrating", "live", "ended"]
    stream: str
    view: str
    code: str | None
    detail: str | None
