"""The Python client against a service that runs."""

from __future__ import annotations

import hashlib
import zipfile
from pathlib import Path

import pytest
from broken_line import BrokenLine
from made_motion import bvh
from running import Running, eventually

from galatea_client import (
    ArtifactEvent,
    Client,
    Conflict,
    DownloadBroken,
    InvalidRequest,
    JobFailed,
    LimitReached,
    NotAllowed,
    NotFound,
    ProgressEvent,
    Status,
    StatusEvent,
)

WHOLE = bytes(range(256)) * 400
"""What the tiny kind leaves as animation.mp4."""


def test_from_a_picture_to_its_results(galatea: Client, picture: Path, tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    file = galatea.upload(picture, lambda done, whole: seen.append((done, whole)))
    size = picture.stat().st_size
    assert seen[-1] == (size, size)
    assert file.sha256 == hashlib.sha256(picture.read_bytes()).hexdigest() and galatea.file(file.id) == file
    job = galatea.submit("tiny", {"image": file.id, "driver": "happy"}, {"seconds": 0.2}, metadata={"order": 7})
    done = job.wait()
    assert done.status is Status.SUCCEEDED and done.metadata == {"order": 7}
    got = done.download("animation.mp4", tmp_path / "out")
    assert got == tmp_path / "out" / "animation.mp4" and got.read_bytes() == WHOLE
    assert {path.name for path in done.download_all(tmp_path / "all")} == set(done.artifacts)
    with zipfile.ZipFile(galatea.download_archive(job.id, tmp_path)) as archive:
        assert archive.read("animation.mp4") == WHOLE
    assert galatea.download_file(file, tmp_path / "again.png").read_bytes() == picture.read_bytes()


def test_files_are_uploaded_where_paths_are_given(galatea: Client, picture: Path) -> None:
    job = galatea.submit("tiny", {"image": picture}, wait=30)
    assert job.status is Status.SUCCEEDED
    assert galatea.file(str(job.inputs["image"])).name == "picture.png"


def test_a_file_may_be_bytes_or_open(galatea: Client, picture: Path) -> None:
    told: list[tuple[int, int]] = []
    with picture.open("rb") as opened:
        opened.read(3)
        for given in (picture, picture.read_bytes(), opened):
            file = galatea.upload(given, progress=lambda sent, size: told.append((sent, size)))
            assert file.sha256 == hashlib.sha256(picture.read_bytes()).hexdigest()
            assert told[-1] == (picture.stat().st_size,) * 2
    job = galatea.submit("tiny", {"image": picture.read_bytes()})
    assert job.wait().status == "succeeded"


def test_events_tell_the_whole_story(galatea: Client, picture: Path) -> None:
    events = list(galatea.submit("tiny", {"image": picture}, {"seconds": 0.5}).follow())
    assert [event.id for event in events] == sorted({event.id for event in events})
    assert [event.status for event in events if isinstance(event, StatusEvent)] == ["queued", "running", "succeeded"]
    assert any(isinstance(event, ProgressEvent) and event.progress.stage == "rest" for event in events)
    assert {event.name for event in events if isinstance(event, ArtifactEvent)} >= {"preview.jpg", "animation.mp4"}


def test_a_broken_stream_of_events_is_taken_up_after_the_last_one(running: Running, picture: Path) -> None:
    line = BrokenLine("/events", after_bytes=500, times=3)
    with Client(str(running.client.base_url), transport=line) as galatea:
        job = galatea.submit("tiny", {"image": picture}, {"seconds": 1.5})
        events = list(job.follow())
        assert events == list(job.follow())  # what comes over a whole line
    asked = [request.headers.get("Last-Event-ID") for request in line.requests if "/events" in request.url.path]
    assert len(asked) >= 4 and asked[0] is None and asked[-1] is None
    assert [int(after or 0) for after in asked[:-1]] == sorted({int(after or 0) for after in asked[:-1]})


def test_a_broken_download_is_taken_up_by_a_range(running: Running, picture: Path, tmp_path: Path) -> None:
    line = BrokenLine("/artifacts/animation.mp4", after_bytes=30_000, times=2)
    with Client(str(running.client.base_url), transport=line) as galatea:
        job = galatea.submit("tiny", {"image": picture}).wait()
        assert job.download("animation.mp4", tmp_path).read_bytes() == WHOLE
    ranges = [request.headers.get("Range") for request in line.requests if "/artifacts/" in request.url.path]
    assert ranges[0] is None and len(ranges) == 3
    assert all(int(part.removeprefix("bytes=").rstrip("-")) > 0 for part in ranges[1:] if part)
    assert [path.name for path in tmp_path.glob("*.part")] == []


def test_a_download_that_was_left_is_taken_up_and_a_wrong_one_is_noticed(
    galatea: Client, picture: Path, tmp_path: Path
) -> None:
    job = galatea.submit("tiny", {"image": picture}).wait()
    part = tmp_path / "animation.mp4.part"
    part.write_bytes(WHOLE[:50_000])
    assert job.download("animation.mp4", tmp_path).read_bytes() == WHOLE
    part.write_bytes(b"x" * 50_000)
    (tmp_path / "animation.mp4").unlink()
    with pytest.raises(DownloadBroken):
        job.download("animation.mp4", tmp_path)
    assert list(tmp_path.glob("animation*")) == []
    assert job.download("animation.mp4", tmp_path).read_bytes() == WHOLE


def test_who_waits_so_long_for_a_job_of_which_nothing_is_heard_is_told_then(galatea: Client, picture: Path) -> None:
    """The one worker has another job; of this one there is nothing to tell before that has ended."""
    first = galatea.submit("tiny", {"image": picture}, {"seconds": 3000})
    second = galatea.submit("tiny", {"image": picture})
    try:
        with pytest.raises(TimeoutError, match=second.id):
            second.wait(seconds=1)
        assert second.refresh().status is Status.QUEUED
    finally:
        first.cancel()
    assert second.wait().status is Status.SUCCEEDED


def test_a_submission_whose_answer_was_lost_makes_one_job(running: Running, picture: Path) -> None:
    line = BrokenLine("/v1/jobs", after_bytes=10, times=0)
    with Client(str(running.client.base_url), transport=line) as galatea:
        file = galatea.upload(picture)
        before = len(list(galatea.jobs()))
        line.times = 1
        job = galatea.submit("tiny", {"image": file.id})
        sent = [request for request in line.requests if request.method == "POST" and request.url.path == "/v1/jobs"]
        assert len(sent) == 2 and sent[0].headers["Idempotency-Key"] == sent[1].headers["Idempotency-Key"]
        jobs = list(galatea.jobs())
    assert len(jobs) == before + 1 and jobs[0].id == job.id


def test_jobs_are_listed_revised_canceled_and_erased(galatea: Client, picture: Path) -> None:
    first = galatea.submit("tiny", {"image": picture}).wait()
    second = first.revise(corrections={"level": 2}, options={"seconds": 0.1}).wait()
    assert second.revision_of == first.id and second.options == {"level": 2.0, "seconds": 0.1}
    assert [job.id for job in second.revisions()] == [first.id, second.id]
    listed = [job.id for job in galatea.jobs(status=[Status.SUCCEEDED], kind=["tiny"], created_after=first.created_at)]
    assert second.id in listed and first.id not in listed
    assert galatea.rename(second.id, "Aunt Mary").title == first.refresh().title == "Aunt Mary"
    assert [job.id for job in galatea.jobs(q="aunt")] == [second.id, first.id]
    long = galatea.submit("tiny", {"image": picture}, {"seconds": 3000}, title="A long one")
    assert long.title == "A long one"
    assert long.cancel().status is Status.CANCELED
    with pytest.raises(JobFailed, match="canceled"):
        long.wait()
    with pytest.raises(Conflict):
        second.cancel()
    second.delete()
    with pytest.raises(NotFound) as error:
        second.refresh()
    assert error.value.code == "job_not_found" and error.value.request_id


def test_a_correction_may_be_a_file_of_this_machine(galatea: Client, picture: Path) -> None:
    job = galatea.submit("tiny", {"image": picture}).wait()
    assert {"level", "mask"} <= set(galatea.kinds()[0].correctable)
    revised = job.revise({"mask": picture, "level": 2.0}).wait()
    assert set(revised.inputs) == {"image", "mask"} and revised.options == {"level": 2.0}
    assert galatea.file(str(revised.inputs["mask"])).size == picture.stat().st_size
    assert revised.revise({"mask": None}).inputs == job.inputs


def test_motions(galatea: Client, tmp_path: Path) -> None:
    file = tmp_path / "mine.bvh"
    file.write_bytes(bvh(frames=4))
    made = galatea.create_motion("mine", file)
    assert (made.source, made.size, made.check_status) == ("own", file.stat().st_size, "none")  # no such kind here
    assert made in galatea.motions() and made == galatea.motion("mine")
    assert galatea.download_motion(made, tmp_path / "again.bvh").read_bytes() == file.read_bytes()
    again = galatea.create_motion("other", galatea.upload(file).id)
    assert (again.name, again.content_type) == ("other", "text/x-bvh")
    assert galatea.rename_motion("other", "another").name == "another"
    for name in ("mine", "another"):
        galatea.delete_motion(name)
    assert {motion.source for motion in galatea.motions()} == {"built-in"}
    walk = galatea.motion("walk")
    assert walk.loops and walk.url is None


def test_errors_say_what_to_do(galatea: Client, picture: Path, tmp_path: Path) -> None:
    with pytest.raises(InvalidRequest) as error:
        galatea.submit("tiny", {"image": picture}, {"seconds": -1})
    assert (error.value.status, error.value.code) == (422, "invalid_options")
    assert error.value.errors[0]["pointer"] == "/options/seconds"
    text = tmp_path / "a.txt"
    text.write_text("no picture")
    with pytest.raises(InvalidRequest) as error:
        galatea.upload(text)
    assert error.value.code in ("media_type_unsupported", "media_type_mismatch")
    with pytest.raises(JobFailed, match="No face") as failed:
        galatea.submit("tiny", {"image": picture}, {"crash": "refuse"}).wait()
    assert failed.value.code == "no_face" and failed.value.job.error.correctable == ["landmarks"]


def test_kinds_drivers_links_and_keys(galatea: Client, running: Running, picture: Path, tmp_path: Path) -> None:
    assert [kind.name for kind in galatea.kinds()] == ["tiny"]
    video = tmp_path / "mine.mp4"
    video.write_bytes(b"\x00\x00\x00\x18ftypisom\x00\x00\x02\x00isomiso2" + bytes(5000))
    galatea.create_driver("mine", video)
    assert {"happy", "mine"} <= {driver.name for driver in galatea.drivers()}
    assert galatea.rename_driver("mine", "yours").name == "yours"
    galatea.delete_driver("yours")
    assert "mine" not in {driver.name for driver in galatea.drivers()}
    job = galatea.submit("tiny", {"image": picture}).wait()
    link = job.link(expires_in_hours=1)
    assert link.url and link.page
    assert galatea.links(job.id) == [link.model_copy(update={"url": None, "page": None})]
    assert job.link(lasting=True).expires_at is None
    assert link.id in [one.id for one in galatea.all_links()]
    for one in galatea.links(job.id):
        galatea.revoke_link(one.id)
    assert galatea.links(job.id) == []
    made = galatea.create_key("Picture shop", requests_per_minute=240)
    with Client(str(running.client.base_url), key=made.token) as shop:
        assert shop.own_key().name == "Picture shop" and list(shop.jobs()) == []
        with pytest.raises(NotAllowed, match="scope_missing"):
            shop.keys()
    galatea.revoke_key(made.id, erase=True)
    with pytest.raises(NotAllowed, match="key_unknown"), Client(str(running.client.base_url), key=made.token) as shop:
        shop.own_key()


def test_webhooks(galatea: Client, picture: Path) -> None:
    made = galatea.create_webhook("http://127.0.0.1:9/told", ["job.succeeded"])
    assert made.secret.startswith("whsec_") and [one.id for one in galatea.webhooks()] == [made.id]
    rotated = galatea.rotate_webhook_secret(made.id)
    assert rotated.previous_secret == made.secret and galatea.webhook_secret(made.id) == rotated
    job = galatea.submit("tiny", {"image": picture}, priority="high").wait()
    assert job.priority == "high"
    eventually(lambda: any(one.attempts for one in galatea.deliveries(job_id=job.id)), "it was tried")
    (delivery,) = galatea.deliveries(webhook_id=made.id)
    assert delivery.event == "job.succeeded" and delivery.last_attempt is not None
    assert delivery.last_attempt.error is not None and delivery.last_attempt.response_status is None
    assert galatea.replay(delivery.id).id == delivery.id
    assert not galatea.change_webhook(made.id, enabled=False).enabled
    galatea.delete_webhook(made.id)
    assert galatea.webhooks() == []


def test_it_waits_as_long_as_it_is_asked_to(galatea: Client, running: Running) -> None:
    made = galatea.create_key("Hurried", requests_per_minute=60)
    with Client(str(running.client.base_url), key=made.token) as hurried:
        for _ in range(17):  # one more than its bucket holds
            hurried.own_key()
    with Client(str(running.client.base_url), key=made.token, patience=0) as impatient:
        with pytest.raises(LimitReached) as error:
            for _ in range(17):
                impatient.own_key()
        assert error.value.code == "rate_limited"
