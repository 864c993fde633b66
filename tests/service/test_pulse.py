"""Signs of life of workers: who looks at any moment hears what was so."""

from __future__ import annotations

import threading
from pathlib import Path

from service.pulse import Pulse, least_silent_seconds, silent_seconds


def test_a_worker_that_beats_is_silent_at_no_moment(tmp_path: Path) -> None:
    pulse = Pulse(tmp_path, "here:1")
    assert least_silent_seconds(tmp_path) == float("inf"), "nobody was heard yet"
    pulse.beat()
    over = threading.Event()

    def go_on() -> None:
        while not over.is_set():
            pulse.beat()

    beating = threading.Thread(target=go_on)
    beating.start()
    heard = [least_silent_seconds(tmp_path) for _ in range(5000)]
    over.set()
    beating.join()
    assert float("inf") not in heard
    pulse.end()
    assert silent_seconds(tmp_path, "here:1") == float("inf")


def test_a_worker_whose_file_was_erased_is_heard_again(tmp_path: Path) -> None:
    pulse = Pulse(tmp_path, "here:1")
    pulse.beat()
    pulse.end()
    pulse.beat()
    assert silent_seconds(tmp_path, "here:1") < 60
