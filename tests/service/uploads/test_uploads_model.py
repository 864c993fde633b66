"""Resumable uploads against a model of them: whatever is sent, however it is cut off, an upload stands where the sum
of what was acknowledged says, and what it becomes is what was sent."""

from __future__ import annotations

import base64
import hashlib
import time

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)
from raw_upload import TUS, Media, add, create, line
from running import Running

SIZE = 60_000
MEDIA = Media(SIZE, seed=5).bytes()
LENGTHS = st.integers(0, 25_000)


def checksum(data: bytes) -> str:
    return "sha256 " + base64.b64encode(hashlib.sha256(data).digest()).decode()


def test_an_upload_is_the_sum_of_its_pieces(running: Running) -> None:
    class Upload(RuleBasedStateMachine):
        """How much of a line that was cut arrived is chance, so no rule's turn may depend on where the upload stands."""

        @initialize(deferred=st.booleans())
        def begin(self, deferred: bool) -> None:
            self.length = None if deferred else SIZE
            self.address = create(running, self.length)
            self.offset = 0

        @rule(size=LENGTHS, summed=st.booleans())
        def a_piece(self, size: int, summed: bool) -> None:
            piece = MEDIA[self.offset : self.offset + size]
            headers = {"Upload_Checksum": checksum(piece)} if summed else {}
            response = add(running, self.address, self.offset, piece, **headers)
            self.offset += len(piece)
            assert (response.status_code, response.headers["upload-offset"]) == (204, str(self.offset))

        @rule(size=st.integers(1, 25_000))
        def a_damaged_piece(self, size: int) -> None:
            if self.offset == SIZE:
                return
            piece = MEDIA[self.offset : self.offset + size]
            damaged = bytes([piece[0] ^ 1]) + piece[1:]
            response = add(running, self.address, self.offset, damaged, Upload_Checksum=checksum(piece))
            assert response.status_code == 460

        @rule(elsewhere=st.integers(0, 2 * SIZE), size=LENGTHS)
        def a_piece_from_elsewhere(self, elsewhere: int, size: int) -> None:
            if elsewhere != self.offset:
                response = add(running, self.address, elsewhere, MEDIA[:size])
                assert (response.status_code, response.headers["upload-offset"]) == (409, str(self.offset))

        @rule(size=LENGTHS, summed=st.booleans())
        def a_piece_that_is_cut_off(self, size: int, summed: bool) -> None:
            if self.offset == SIZE:
                return
            announced = SIZE - self.offset
            sent = MEDIA[self.offset : self.offset + min(size, announced - 1)]
            headers = {"Upload_Checksum": checksum(sent)} if summed else {}
            with line(running, self.address, self.offset, announced, **headers) as connection:
                connection.sendall(sent)
                time.sleep(0.02)
            head = running.client.head(self.address, headers=TUS)
            offset = int(head.headers["upload-offset"])
            assert self.offset <= offset <= self.offset + (0 if summed else len(sent))
            self.offset = offset

        @precondition(lambda self: self.length is None)
        @rule(size=LENGTHS)
        def the_length_is_told(self, size: int) -> None:
            self.length = SIZE
            piece = MEDIA[self.offset : self.offset + size]
            assert add(running, self.address, self.offset, piece, Upload_Length=str(SIZE)).status_code == 204
            self.offset += len(piece)

        @precondition(lambda self: self.length is not None)
        @rule(size=st.integers(SIZE + 1, SIZE + 1000))
        def too_much(self, size: int) -> None:
            assert add(running, self.address, self.offset, bytes(size - self.offset)).status_code == 413

        @rule()
        def it_is_ended_and_another_begun(self) -> None:
            assert running.client.delete(self.address, headers=TUS).status_code == 204
            assert running.client.head(self.address, headers=TUS).status_code == 404
            self.begin(self.length is None)

        @invariant()
        def it_stands_where_the_model_does(self) -> None:
            head = running.client.head(self.address, headers=TUS)
            shown = running.client.get(self.address)
            assert int(head.headers["upload-offset"]) == shown.json()["offset"] == self.offset
            assert head.headers.get("upload-length") == (None if self.length is None else str(SIZE))
            finished = self.offset == self.length
            assert shown.json()["status"] == ("finished" if finished else "receiving")
            if finished:
                assert shown.json()["file"]["sha256"] == hashlib.sha256(MEDIA).hexdigest()

    once = settings(
        max_examples=12,
        stateful_step_count=12,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        derandomize=True,
    )
    run_state_machine_as_test(Upload, settings=once)
