"""Who is late goes on with the newest; nothing queues."""

from __future__ import annotations

import threading

from worker.live.newest import Newest


def test_what_was_not_taken_is_dropped() -> None:
    place: Newest[int] = Newest()
    for number in range(100):
        place.put(number)
    assert place.take() == 99


def test_who_waits_gets_what_comes() -> None:
    place: Newest[int] = Newest()
    taken: list[int | None] = []
    waiting = threading.Thread(target=lambda: taken.append(place.take()))
    waiting.start()
    place.put(5)
    waiting.join()
    assert taken == [5]


def test_what_was_taken_is_not_had_again() -> None:
    place: Newest[int] = Newest()
    place.put(5)
    assert place.take() == 5
    taken: list[int | None] = []
    waiting = threading.Thread(target=lambda: taken.append(place.take()))
    waiting.start()
    waiting.join(0.2)
    place.put(6)
    waiting.join()
    assert taken == [6]


def test_once_it_is_closed_there_is_nothing_and_nobody_waits() -> None:
    place: Newest[int] = Newest()
    place.put(5)
    place.close()
    assert place.take() is None
