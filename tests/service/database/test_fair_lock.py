"""A lock that is fair: who comes first is served first, and who gives up is passed over."""

from __future__ import annotations

import threading
import time

from service.database.fair_lock import FairLock


def test_turns_come_in_the_order_of_asking() -> None:
    lock, served = FairLock(), []

    def wait(number: int) -> None:
        with lock.turn(30) as came:
            assert came
            served.append(number)

    threads = [threading.Thread(target=wait, args=(number,)) for number in range(20)]
    with lock.turn(1):
        for waiting, thread in enumerate(threads, 1):
            thread.start()
            while lock.waiting < waiting:
                time.sleep(0.001)
    for thread in threads:
        thread.join()
    assert served == list(range(20))


def test_one_works_at_a_time() -> None:
    lock, at_work, most = FairLock(), [], []

    def work() -> None:
        for _ in range(50):
            with lock.turn(30):
                at_work.append(1)
                most.append(len(at_work))
                time.sleep(0)
                at_work.pop()

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(most) == 400
    assert max(most) == 1


def test_who_gives_up_is_passed_over() -> None:
    lock = FairLock()
    with lock.turn(1) as first, lock.turn(0.01) as second:
        assert (first, second) == (True, False)
    with lock.turn(0.01) as third:
        assert third


def test_an_error_ends_the_turn() -> None:
    lock = FairLock()
    try:
        with lock.turn(1):
            raise ValueError
    except ValueError:
        pass
    with lock.turn(0.01) as came:
        assert came
