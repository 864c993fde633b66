"""Every setting of the service, read from the environment (prefix `GALATEA_`); all have a default."""

from __future__ import annotations

import re
from ipaddress import IPv4Network, IPv6Network, ip_network
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, SecretStr, field_validator, model_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from engine.media.limits import Limits
from service.installed import page_folder
from service.loopback import is_loopback
from service.vault import Vault

BYTES_PER_MEGABYTE = 1_000_000


def _listed(value: object) -> object:
    return [part.strip() for part in value.split(",") if part.strip()] if isinstance(value, str) else value


class Settings(BaseSettings):
    """What an operator can choose. `docs/settings.md` is held against these fields by a test."""

    model_config = SettingsConfigDict(env_prefix="GALATEA_", frozen=True, extra="ignore", hide_input_in_errors=True)

    data_dir: Path = Field(Path("~/.local/share/galatea"), description="Where everything is kept.")
    database_url: str | None = Field(None, description="Where jobs are recorded; a file in DATA_DIR if not set.")
    database_connections: int = Field(20, ge=2, description="The most connections of one process to PostgreSQL.")
    secrets_key: Annotated[list[SecretStr], NoDecode] = Field(
        [],
        description="Keys, separated by commas, that encrypt the secrets in the database: the first encrypts, all "
        "decrypt; in clear if not set.",
    )
    redis_url: str | None = Field(None, description="A Redis of your own; the embedded one if not set.")
    storage_url: str | None = Field(None, description="Where files and artifacts lie; a folder in DATA_DIR if not set.")
    storage_endpoint: str | None = Field(None, description="The address of an S3 service other than Amazon's.")
    storage_region: str | None = Field(None, description="Its region; AWS_REGION if not set.")
    storage_access_key: SecretStr | None = Field(None, description="Its access key; AWS_ACCESS_KEY_ID if not set.")
    storage_secret_key: SecretStr | None = Field(
        None, description="The secret that belongs to it; AWS_SECRET_ACCESS_KEY if not set."
    )

    host: str = Field("127.0.0.1", description="The address `galatea serve` binds; only loopback needs no key.")
    port: int = Field(8000, ge=0, le=65535, description="Its port; 0 takes a free one.")
    require_keys: bool = Field(False, description="Ask for a key on loopback too; elsewhere it always is.")
    requests_per_minute: int = Field(
        600, ge=1, description="The most requests a minute of a key without a limit of its own."
    )
    jobs_at_once: int = Field(20, ge=0, description="The most jobs under way of such a key.")
    uploads_at_once: int = Field(20, ge=0, description="The most unfinished uploads of a key.")
    stored_mb: int = Field(20_000, ge=0, description="The most that files and results of such a key may take.")
    link_hours: float = Field(1, gt=0, description="How long the signed links in a job are good.")
    public_link_hours: float = Field(
        720, ge=0, description="How long a public link is good of which nothing else was said; 0 until it is revoked."
    )
    wrong_keys_per_minute: int = Field(
        60, ge=1, description="Wrong keys a minute from one address after which it is answered with 429."
    )
    cors_origins: Annotated[list[str], NoDecode] = Field(
        [], description="Origins, separated by commas, of web pages that may call the API with a key."
    )
    trusted_proxies: Annotated[list[IPv4Network | IPv6Network], NoDecode] = Field(
        [], description="Networks, separated by commas, of proxies that may pass requests on."
    )
    allowed_networks: Annotated[list[IPv4Network | IPv6Network], NoDecode] = Field(
        [], description="Networks, separated by commas, that addresses given by users may lead to beside public ones."
    )
    public_url: str | None = Field(None, description="The service's own address, for links in what it sends.")
    connections: int = Field(1000, ge=8, description="The most connections at once; beyond, some are answered 503.")
    head_seconds: float = Field(20, gt=0, description="How long a request's address and headers may take.")
    body_seconds: float = Field(60, gt=0, description="How long a request's body may stand still.")
    body_bytes_per_second: float = Field(500, gt=0, description="The slowest that a body may come for long.")
    idle_seconds: float = Field(15, gt=0, description="How long a connection is kept for a next request.")
    send_seconds: float = Field(300, gt=0, description="How long nothing may be taken of an answer.")
    web_dir: Path = Field(page_folder(), description="The built web page.")
    wait_seconds: float = Field(60, ge=0, description="The longest that `Prefer: wait` holds an answer back.")
    log_level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = Field("INFO", description="How much is logged.")
    log_format: Literal["console", "json"] = Field("console", description="How it is written.")
    traces_url: str | None = Field(
        None, description="Where traces are sent to (OTLP over HTTP), such as http://collector:4318/v1/traces."
    )

    image_mb: float = Field(100, gt=0, description="The largest picture that is accepted.")
    image_megapixels: float = Field(40, gt=0, le=178, description="The most pixels of a picture.")
    video_mb: float = Field(2000, gt=0, description="The largest video that is accepted.")
    video_seconds: float = Field(180, gt=0, description="The longest video.")
    video_megapixels: float = Field(8.9, gt=0, description="The most pixels of a video's frame.")
    video_megapixels_per_second: float = Field(300, gt=0, description="The most pixels a second of a video.")
    video_frames: int = Field(21_600, gt=0, description="The most frames of a video.")
    upload_hours: float = Field(
        24, gt=0, description="How long an unfinished upload waits for more before it is erased."
    )
    upload_files: int = Field(200, gt=0, description="The most files in one request.")
    fetch_seconds: float = Field(300, gt=0, description="The longest that fetching one input by its address may take.")
    disk_reserve_mb: float = Field(500, ge=0, description="Free space below which nothing new is accepted (507).")
    cache_mb: float = Field(2000, gt=0, description="The space for analyses that jobs share.")
    job_days: float = Field(0, ge=0, description="How long an ended job is kept with its media; 0 keeps it for good.")
    erase_sources: bool = Field(
        False,
        description="Whether clips and photos of a person, of which an avatar or a persona is made, are erased once their job has succeeded.",
    )
    file_hours: float = Field(24, gt=0, description="How long an uploaded file waits for a job before it is erased.")

    webhook_connect_seconds: float = Field(5, gt=0, description="How long a receiver may take to be reached.")
    webhook_seconds: float = Field(15, gt=0, le=300, description="How long an attempt at a webhook may take in all.")
    webhook_concurrency: int = Field(8, ge=1, description="Attempts that one worker makes at once.")
    webhook_days: float = Field(30, ge=4, description="How long what was delivered, or not, is kept.")

    mark_synthetic: bool = Field(
        True, description="Whether results say of themselves, for machines to read, that they are synthetic."
    )
    concurrency: int = Field(1, ge=1, description="Jobs that one worker runs at once.")
    short_concurrency: int = Field(
        1,
        ge=0,
        description="Jobs of kinds that take seconds that it runs beside them; 0 lets those wait for their turn.",
    )
    job_seconds: float = Field(3600, gt=0, description="The longest a job may work.")
    job_memory_mb: float = Field(6000, gt=0, description="The most memory of a job.")
    job_file_mb: float = Field(4000, gt=0, description="The largest file a job may write.")
    worker: bool = Field(True, description="Whether `galatea serve` keeps a worker of its own.")
    silent_seconds: float = Field(
        20, ge=3, description="How long that worker, or the embedded Redis, may be silent before it is started again."
    )
    worker_kinds: Annotated[list[str], NoDecode] = Field(
        [], description="The job kinds that this machine's worker serves, separated by commas; all if not set."
    )
    job_cpu_seconds: float = Field(7200, ge=1, description="The most computing of a job, all cores together.")
    job_cores: int = Field(0, ge=0, description="Cores that a job may use; 0 is all.")
    job_niceness: int = Field(
        3, ge=0, le=19, description="How far jobs give way to what else computes; 0 not at all, 19 wholly."
    )
    job_user: str = Field("nobody", description="Who jobs work as where the worker is root; empty: root.")
    live_streams: int | None = Field(
        None, ge=0, description="Live portraits at once on this machine; one for each core if not set, 0 none."
    )
    live_seconds: float = Field(3600, gt=0, description="The longest a live portrait may last.")
    live_idle_seconds: float = Field(
        20, gt=0, description="After how long without a frame of the camera, or with nobody looking, it ends."
    )
    live_frame_mb: float = Field(2, gt=0, le=8, description="The largest frame of the camera.")
    live_frame_megapixels: float = Field(2.1, gt=0, description="The most pixels of a frame of the camera.")
    lease_seconds: float = Field(30, ge=2, le=900, description="How long a silent worker keeps its job.")
    sweep_seconds: float = Field(5, gt=0, description="How often lost messages and expired leases are looked for.")
    kinds: Annotated[list[str], NoDecode] = Field(
        ["engine.kinds:KINDS"],
        description="The job kinds on offer, `module:attribute` (a `Kind`, or a mapping of them), separated by commas.",
    )

    @field_validator("trusted_proxies", "allowed_networks", mode="before")
    @classmethod
    def _networks(cls, value: object) -> object:
        listed = _listed(value)
        return [ip_network(part, strict=False) for part in listed] if isinstance(listed, list) else listed

    @field_validator("secrets_key")
    @classmethod
    def _fernet_keys(cls, value: list[SecretStr]) -> list[SecretStr]:
        try:
            Vault([key.get_secret_value() for key in value])
        except ValueError:
            raise ValueError("a key is 32 bytes in url-safe base64; `galatea keys secrets-key` makes one") from None
        return value

    @field_validator("kinds", "cors_origins", "worker_kinds", "secrets_key", mode="before")
    @classmethod
    def _names(cls, value: object) -> object:
        return _listed(value)

    @field_validator("traces_url")
    @classmethod
    def _collector(cls, value: str | None) -> str | None:
        if value and not value.startswith(("http://", "https://")):
            raise ValueError("it must begin with http:// or https://")
        return value or None

    @field_validator("public_url")
    @classmethod
    def _own_address(cls, value: str | None) -> str | None:
        if value is not None and not value.startswith(("http://", "https://")):
            raise ValueError("it must begin with http:// or https://")
        return value.rstrip("/") if value is not None else None

    @field_validator("data_dir", "web_dir")
    @classmethod
    def _absolute(cls, value: Path) -> Path:
        return value.expanduser().absolute()

    @field_validator("database_url")
    @classmethod
    def _database(cls, value: str | None) -> str | None:
        if value is None or value.startswith("sqlite:///"):
            return value
        from service.database import postgresql  # SQLAlchemy with it, which only who serves needs

        if not postgresql.is_postgresql_url(value):
            raise ValueError("use sqlite:///PATH or postgresql://USER:PASSWORD@HOST/NAME")
        postgresql.address(value)
        return value

    @field_validator("storage_url")
    @classmethod
    def _bucket(cls, value: str | None) -> str | None:
        if value is not None and not re.fullmatch(r"s3://[a-z0-9][a-z0-9.-]+(/[\w./-]*)?", value):
            raise ValueError("use s3://BUCKET or s3://BUCKET/PREFIX")
        return value

    @model_validator(mode="after")
    def _both_halves(self) -> Settings:
        if (self.storage_access_key is None) != (self.storage_secret_key is None):
            raise ValueError("GALATEA_STORAGE_ACCESS_KEY and GALATEA_STORAGE_SECRET_KEY: set both or neither")
        return self

    @property
    def keys_required(self) -> bool:
        """Whether every caller needs a key."""
        return self.require_keys or not is_loopback(self.host)

    @property
    def database(self) -> str:
        return self.database_url or f"sqlite:///{self.data_dir / 'galatea.db'}"

    @property
    def vault(self) -> Vault:
        """What encrypts secrets and opens them."""
        return Vault([key.get_secret_value() for key in self.secrets_key])

    @property
    def limits(self) -> Limits:
        return Limits(
            image_bytes=int(self.image_mb * BYTES_PER_MEGABYTE),
            image_megapixels=self.image_megapixels,
            video_bytes=int(self.video_mb * BYTES_PER_MEGABYTE),
            video_seconds=self.video_seconds,
            video_megapixels=self.video_megapixels,
            video_megapixels_per_second=self.video_megapixels_per_second,
            video_frames=self.video_frames,
        )

    def job_folder(self, job_id: str) -> Path:
        """Where a job's stages and the drafts of its artifacts lie."""
        return self.data_dir / "jobs" / job_id
