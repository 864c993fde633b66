"""Every setting of the service, read from the environment (prefix `GALATEA_`); all have a default."""

from __future__ import annotations

from ipaddress import IPv4Network, IPv6Network, ip_network
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, field_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from engine.media.limits import Limits

ROOT = Path(__file__).parent.parent
MEGABYTE = 1_000_000


def _listed(value: object) -> object:
    return [part.strip() for part in value.split(",") if part.strip()] if isinstance(value, str) else value


class Settings(BaseSettings):
    """What an operator can choose. `docs/settings.md` is held against these fields by a test."""

    model_config = SettingsConfigDict(env_prefix="GALATEA_", frozen=True, extra="ignore")

    data_dir: Path = Field(Path("~/.local/share/galatea"), description="Where everything is kept.")
    database_url: str | None = Field(None, description="Where jobs are recorded; a file in DATA_DIR if not set.")
    redis_url: str | None = Field(None, description="A Redis of your own; the embedded one if not set.")

    host: str = Field("127.0.0.1", description="The address `galatea serve` binds; only loopback needs no key.")
    port: int = Field(8000, ge=0, le=65535, description="Its port; 0 takes a free one.")
    trusted_proxies: Annotated[list[IPv4Network | IPv6Network], NoDecode] = Field(
        [], description="Networks, separated by commas, of proxies that may pass requests on."
    )
    web_dir: Path = Field(ROOT / "web" / "dist", description="The built web page.")
    wait_seconds: float = Field(60, ge=0, description="The longest that `Prefer: wait` holds an answer back.")
    log_level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = Field("INFO", description="How much is logged.")
    log_format: Literal["console", "json"] = Field("console", description="How it is written.")

    image_mb: float = Field(100, gt=0, description="The largest picture that is accepted.")
    image_megapixels: float = Field(40, gt=0, le=178, description="The most pixels of a picture.")
    video_mb: float = Field(2000, gt=0, description="The largest video that is accepted.")
    video_seconds: float = Field(180, gt=0, description="The longest video.")
    video_megapixels: float = Field(8.9, gt=0, description="The most pixels of a video's frame.")
    video_megapixels_per_second: float = Field(300, gt=0, description="The most pixels a second of a video.")
    video_frames: int = Field(21_600, gt=0, description="The most frames of a video.")
    upload_files: int = Field(200, gt=0, description="The most files in one request.")
    disk_reserve_mb: float = Field(500, ge=0, description="Free space below which nothing new is accepted (507).")
    cache_mb: float = Field(2000, gt=0, description="The space for analyses that jobs share.")
    file_hours: float = Field(24, gt=0, description="How long an uploaded file waits for a job before it is erased.")

    concurrency: int = Field(1, ge=1, description="Jobs that one worker runs at once.")
    job_seconds: float = Field(3600, gt=0, description="The longest a job may work.")
    job_memory_mb: float = Field(6000, gt=0, description="The most memory of a job.")
    job_file_mb: float = Field(4000, gt=0, description="The largest file a job may write.")
    child_jobs: int = Field(50, ge=1, description="Jobs after which a job process is replaced by a fresh one.")
    child_memory_mb: float = Field(1500, gt=0, description="Memory kept between jobs above which it is replaced.")
    lease_seconds: float = Field(30, ge=2, description="How long a silent worker keeps its job.")
    sweep_seconds: float = Field(5, gt=0, description="How often lost messages and expired leases are looked for.")
    kinds: Annotated[list[str], NoDecode] = Field(
        ["engine.kinds:KINDS"],
        description="The job kinds on offer, `module:attribute` (a `Kind`, or a mapping of them), separated by commas.",
    )

    @field_validator("trusted_proxies", mode="before")
    @classmethod
    def _networks(cls, value: object) -> object:
        listed = _listed(value)
        return [ip_network(part, strict=False) for part in listed] if isinstance(listed, list) else listed

    @field_validator("kinds", mode="before")
    @classmethod
    def _names(cls, value: object) -> object:
        return _listed(value)

    @field_validator("data_dir", "web_dir")
    @classmethod
    def _absolute(cls, value: Path) -> Path:
        return value.expanduser().absolute()

    @field_validator("database_url")
    @classmethod
    def _sqlite(cls, value: str | None) -> str | None:
        if value is not None and not value.startswith("sqlite:///"):
            raise ValueError("only sqlite:///PATH is supported")
        return value

    @property
    def database(self) -> str:
        return self.database_url or f"sqlite:///{self.data_dir / 'galatea.db'}"

    @property
    def limits(self) -> Limits:
        return Limits(
            image_bytes=int(self.image_mb * MEGABYTE),
            image_megapixels=self.image_megapixels,
            video_bytes=int(self.video_mb * MEGABYTE),
            video_seconds=self.video_seconds,
            video_megapixels=self.video_megapixels,
            video_megapixels_per_second=self.video_megapixels_per_second,
            video_frames=self.video_frames,
        )

    def job_folder(self, job_id: str) -> Path:
        """Where a job's stages and the drafts of its artifacts lie."""
        return self.data_dir / "jobs" / job_id
