"""Files by key in a bucket of any service that speaks S3."""

from __future__ import annotations

from datetime import timedelta
from typing import Any
from urllib.parse import urlsplit

import obstore
from obstore.store import S3Store

from service.settings import Settings
from service.storage.files import Storage, StorageUnavailable, translate_errors

RETRY_TIMEOUT = timedelta(seconds=30)
"""How long a request is tried again, at most, before the storage counts as unavailable: tries that are refused at once
are used up within seconds."""

PROBE_TIMEOUT = timedelta(seconds=2)


class Bucket(Storage):
    """S3 shows an object only once all its parts are there: what is put appears whole or not at all."""

    def __init__(self, settings: Settings):
        self.folder = None
        self._store = _store(settings, retries=8, retry_timeout=RETRY_TIMEOUT, timeout=2 * RETRY_TIMEOUT)
        self._probe = _store(settings, retries=0, retry_timeout=PROBE_TIMEOUT, timeout=PROBE_TIMEOUT)

    def reachable(self) -> bool:
        """Whether it answers, and there is such a bucket."""
        try:
            with translate_errors():
                next(iter(obstore.list(self._probe, prefix="nothing", chunk_size=1)), None)
        except (StorageUnavailable, OSError):
            return False
        return True


def _store(settings: Settings, retries: int, retry_timeout: timedelta, timeout: timedelta) -> S3Store:
    """Credentials and region are the settings', or those of AWS's own variables (`AWS_ACCESS_KEY_ID`, ...)."""
    place = urlsplit(settings.storage_url or "")
    given: dict[str, Any] = {"endpoint": settings.storage_endpoint, "region": settings.storage_region}
    if settings.storage_access_key is not None and settings.storage_secret_key is not None:
        given["access_key_id"] = settings.storage_access_key.get_secret_value()
        given["secret_access_key"] = settings.storage_secret_key.get_secret_value()
    plain = (settings.storage_endpoint or "").startswith("http://")
    return S3Store(
        place.netloc,
        prefix=place.path.strip("/") or None,
        client_options={"allow_http": plain, "timeout": timeout, "connect_timeout": min(timeout, timedelta(seconds=5))},
        retry_config={"max_retries": retries, "retry_timeout": retry_timeout},
        **{name: value for name, value in given.items() if value is not None},
    )
