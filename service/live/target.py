"""What a live portrait is made of: a picture of the owner's, and options that fit."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from engine.portrait.live.options import LiveOptions
from service.auth.quotas import require_job
from service.context import Context
from service.files import repository as files
from service.job_records.owned import own_job
from service.live.schemas import LiveIn
from service.problems import Problem, invalid

OF_A_JOB = ("crop", "face_index", "landmarks", "strength", "follow", "head_3d")
"""Options of a portrait job that hold for its live portrait, too."""


def live_target(context: Context, owner: str, requested: LiveIn, under_way: int) -> tuple[str, dict[str, Any]]:
    """The storage's key of the picture, and the options. `under_way` are the owner's live portraits.

    Raises 404, 422 and 429 problems.
    """
    if (requested.image is None) == (requested.job is None):
        raise Problem(422, "live_target_missing", "Name the picture: the id of an `image`, or of a portrait `job`.")
    given: dict[str, Any] = {}
    with context.database.write() as session:
        require_job(session, context.settings, owner, under_way)
        image = requested.image
        if requested.job is not None:
            job = own_job(session, owner, requested.job)
            source = (job.sources or {}).get("image")
            if job.kind != "portrait" or not isinstance(source, dict) or "file" not in source:
                raise Problem(422, "live_job_unsuitable", "The job has no picture of its own: name a portrait job.")
            image = source["file"]
            given = {name: job.options[name] for name in OF_A_JOB if name in job.options}
        file = files.get(session, owner, image or "")
        if file is None:
            raise Problem(404, "file_not_found", "There is no such file: it was erased, or it never was.")
        if not file.content_type.startswith("image/"):
            raise Problem(422, "live_target_missing", "The file is no picture: name the id of one.")
        key = file.key
    try:
        options = LiveOptions.model_validate({**given, **requested.options})
    except ValidationError as error:
        raise invalid(error, "invalid_options", "/options", LiveOptions) from error
    return key, options.model_dump(mode="json")
