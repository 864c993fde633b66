"""Resumable uploads over bad lines: dropped at random bytes, dead without a word, two at once, a service killed."""

from __future__ import annotations

import base64
import hashlib
import random
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import psutil
from raw_upload import PIECE, TUS, Media, add, create, line, standing, until_taken
from running import Running, eventually

MEGABYTE = 1_000_000
Start = Callable[..., Running]


def recorded(running: Running, address: str) -> int:
    """How much is recorded; unlike HEAD, asking this disturbs no other request."""
    return running.client.get(address).raise_for_status().json()["offset"]


def same(path: Path, media: Media) -> bool:
    with path.open("rb") as file:
        return all(file.read(len(block)) == block for block in media.blocks(0, media.size)) and not file.read(1)


class Memory:
    """The most memory that a process held while this was open, in megabytes."""

    def __init__(self, pid: int):
        self._process = psutil.Process(pid)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self.before = self.most = self._held()

    def __enter__(self) -> Memory:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _held(self) -> float:
        return self._process.memory_info().rss / MEGABYTE

    def _watch(self) -> None:
        while not self._ended.wait(0.02):
            self.most = max(self.most, self._held())


def test_100_megabytes_interrupted_ten_times_arrive_as_they_were_sent(start: Start) -> None:
    """Half of the lines break in a way that the service notices, the others just fall silent."""
    media = Media(100 * MEGABYTE, seed=3)
    running = start(worker="false")
    add(running, create(running, 2 * MEGABYTE), 0, Media(2 * MEGABYTE).bytes())  # what is loaded once is loaded
    address = create(running, media.size)
    cuts = sorted(random.Random(11).sample(range(media.size), 10))
    silent = []
    with Memory(running.process.pid) as memory:
        for number, cut in enumerate([*cuts, media.size]):
            offset = standing(running, address)
            assert offset <= cut, "nothing is there that was not sent"
            dropped = line(running, address, offset, media.size - offset)
            connection = dropped.__enter__()
            for block in media.blocks(offset, cut):
                connection.sendall(block)
            if cut == media.size:
                assert connection.recv(1000).startswith(b"HTTP/1.1 204")
            if number % 2:
                silent.append(dropped)
            else:
                dropped.__exit__(None, None, None)
    for dropped in silent:
        dropped.__exit__(None, None, None)
    file = running.client.get(address).json()["file"]
    assert (file["size"], file["content_type"]) == (media.size, "video/mp4")
    assert same(running.data_dir / "storage" / "files" / file["id"], media)
    assert memory.most - memory.before < 30, "memory stays flat"


def test_little_is_lost_with_a_line(running: Running) -> None:
    """What came is kept to the last byte, as far as it came (a reset may overtake what is still on its way)."""
    media = Media(1_900_000)
    address = create(running, media.size)
    with line(running, address, 0, media.size) as connection:
        connection.sendall(media.bytes(0, 1_234_567))
        until_taken(running, connection)
    assert standing(running, address) == 1_234_567
    assert add(running, address, 1_234_567, media.bytes(1_234_567)).status_code == 204
    assert running.client.get(address).json()["file"]["sha256"] == hashlib.sha256(media.bytes()).hexdigest()


def test_a_piece_with_a_checksum_is_kept_whole_or_not_at_all(running: Running) -> None:
    media = Media(400_000)
    address = create(running, media.size)
    checksum = "sha1 " + base64.b64encode(hashlib.sha1(media.bytes()).digest()).decode()
    with line(running, address, 0, media.size, Upload_Checksum=checksum) as connection:
        connection.sendall(media.bytes(0, 399_999))
        until_taken(running, connection)
    assert standing(running, address) == 0
    assert add(running, address, 0, media.bytes(), Upload_Checksum=checksum).status_code == 204


def test_a_half_piece_that_is_taken_over_is_not_called_damaged(running: Running) -> None:
    media = Media(400_000)
    address = create(running, media.size)
    checksum = "sha1 " + base64.b64encode(hashlib.sha1(media.bytes()).digest()).decode()
    with line(running, address, 0, media.size, Upload_Checksum=checksum) as dead:
        dead.sendall(media.bytes(0, 300_000))
        until_taken(running, dead)
        assert standing(running, address) == 0
        answer = dead.recv(4000)
        assert answer.startswith(b"HTTP/1.1 423") and b"upload_taken_over" in answer


def test_what_was_acknowledged_outlives_the_service(start: Start) -> None:
    media = Media(40 * MEGABYTE)
    running = start(worker="false")
    address = create(running, media.size)
    acknowledged = int(add(running, address, 0, media.bytes(0, 5 * MEGABYTE)).headers["upload-offset"])
    assert acknowledged == 5 * MEGABYTE
    sent = acknowledged
    with line(running, address, sent, media.size - sent) as connection:

        def more_is_recorded() -> bool:
            """A little more is sent whenever this is asked: what came is recorded with what comes some seconds later."""
            nonlocal sent
            connection.sendall(media.bytes(sent, sent + MEGABYTE // 20))
            sent += MEGABYTE // 20
            return recorded(running, address) > acknowledged

        eventually(more_is_recorded, "some of it is recorded on the way")
        told = recorded(running, address)
        running.process.kill()
        running.process.wait(90)
    again = start(running.data_dir, worker="false")
    offset = standing(again, address)
    assert told <= offset <= sent < media.size
    assert add(again, address, offset, media.bytes(offset)).status_code == 204
    file = again.client.get(address).json()["file"]
    assert file["sha256"] == hashlib.sha256(media.bytes()).hexdigest(), "of what the dead process saw, too"
    assert same(again.data_dir / "storage" / "files" / file["id"], media)


def test_a_line_that_died_in_silence_holds_nobody_up(running: Running) -> None:
    media = Media(900_000)
    address = create(running, media.size)
    with line(running, address, 0, media.size) as dead:
        dead.sendall(media.bytes(0, 300_000))
        until_taken(running, dead)
        offset = standing(running, address)
        assert offset == 300_000
        assert add(running, address, offset, media.bytes(offset)).status_code == 204
        answer = dead.recv(4000)
        assert answer.startswith(b"HTTP/1.1 423") and b"upload_taken_over" in answer
    assert running.client.get(address).json()["file"]["sha256"] == hashlib.sha256(media.bytes()).hexdigest()


def test_of_two_at_once_the_later_goes_on_and_no_byte_is_there_twice(running: Running) -> None:
    """Both claim the same place: one of them finds the upload elsewhere, or both sent the same bytes in turn."""
    media = Media(1_500_000)
    address = create(running, media.size)

    def send(_: int) -> int:
        with line(running, address, 0, media.size) as connection:
            connection.settimeout(20)
            try:
                for block in media.blocks(0, media.size):
                    connection.sendall(block)
                    time.sleep(0.02)
                return int(connection.recv(4000).split()[1])
            except OSError:
                return 0  # the service closed the line in mid-sentence

    with ThreadPoolExecutor(6) as pool:
        statuses = list(pool.map(send, range(6)))
    assert set(statuses) <= {0, 204, 409, 423}
    offset = standing(running, address)
    if offset < media.size:
        assert add(running, address, offset, media.bytes(offset)).status_code == 204
    assert running.client.get(address).json()["file"]["sha256"] == hashlib.sha256(media.bytes()).hexdigest()


def test_an_upload_ended_in_mid_piece_leaves_nothing(running: Running) -> None:
    media = Media(900_000)
    before = sorted((running.data_dir / "uploads").glob("*"))
    address = create(running, media.size)
    with line(running, address, 0, media.size) as connection:
        connection.sendall(media.bytes(0, 300_000))
        until_taken(running, connection)
        assert running.client.delete(address, headers=TUS).status_code == 204
        assert connection.recv(4000).startswith(b"HTTP/1.1 423")
    assert running.client.get(address).status_code == 404
    assert sorted((running.data_dir / "uploads").glob("*")) == before


def test_many_upload_at_once(running: Running) -> None:
    media = [Media(700_000 + number, seed=number) for number in range(12)]

    def upload(one: Media) -> bool:
        address = create(running, one.size)
        while (offset := standing(running, address)) < one.size:
            end = min(offset + 150_000, one.size)
            assert add(running, address, offset, one.bytes(offset, end)).status_code == 204
        sha256 = running.client.get(address).json()["file"]["sha256"]
        return sha256 == hashlib.sha256(one.bytes()).hexdigest()

    with ThreadPoolExecutor(6) as pool:
        assert all(pool.map(upload, media))


def test_the_rest_of_the_service_stays_quick_while_a_line_stalls(running: Running) -> None:
    address = create(running, 900_000)
    with line(running, address, 0, 900_000) as stalled, line(running, address, 0, 900_000) as second:
        stalled.sendall(Media(900_000).bytes(0, 1000))
        second.sendall(Media(900_000).bytes(0, 1000))
        assert running.client.get("/v1/kinds").status_code == 200


def test_a_full_disk_keeps_what_is_there(start: Start, small_disk: Path) -> None:
    running = start(small_disk / "data", worker="false", disk_reserve_mb=20)
    assert running.client.post("/v1/uploads", headers=TUS | {"Upload-Length": "100000000"}).status_code == 507
    media = Media(20 * MEGABYTE)
    address = create(running, media.size)
    ballast = small_disk / "ballast"
    assert add(running, address, 0, media.bytes(0, MEGABYTE)).status_code == 204
    ballast.write_bytes(bytes(33 * MEGABYTE))
    pieces = (block for block in media.blocks(MEGABYTE, media.size))
    full = running.client.patch(address, content=pieces, headers=PIECE | {"Upload-Offset": str(MEGABYTE)})
    assert (full.status_code, full.json()["code"]) == (507, "disk_reserve")
    offset = standing(running, address)
    assert offset >= MEGABYTE
    ballast.unlink()
    assert add(running, address, offset, media.bytes(offset)).status_code == 204
    assert running.client.get(address).json()["file"]["sha256"] == hashlib.sha256(media.bytes()).hexdigest()
    running.stop()


def test_the_service_ends_while_a_line_is_open(start: Start) -> None:
    running = start(worker="false")
    address = create(running, MEGABYTE)
    with line(running, address, 0, MEGABYTE) as connection:
        connection.sendall(Media(MEGABYTE).bytes(0, 500_000))
        running.process.terminate()
        running.process.wait(90)
    again = start(running.data_dir, worker="false")
    offset = standing(again, address)
    assert add(again, address, offset, Media(MEGABYTE).bytes(offset)).status_code == 204
    eventually(lambda: again.client.get(address).json()["status"] == "finished", "it is finished")
