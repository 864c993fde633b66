"""The runner: progress, cancellation, what is kept, and that a correction redoes what follows and no more."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from pydantic import BaseModel

import engine
from engine.errors import Canceled, InputError, Notice
from engine.run import Progress, Run
from engine.run_report import write_report
from engine.stage_keys import content_hash
from engine.store import StageStore


@dataclass(frozen=True)
class Points:
    xy: NDArray[np.float64]


class Options(BaseModel):
    strength: float = 1.0


class Pipeline:
    """Three stages in a row, as a system has them; counts how often each really works."""

    def __init__(self) -> None:
        self.worked: list[str] = []

    def detect(self, path: Path, seed: int) -> Points:
        self.worked.append("detect")
        return Points(np.frombuffer(path.read_bytes(), np.uint8).astype(float) + seed)

    def fit(self, points: Points, options: Options) -> Points:
        self.worked.append("fit")
        return Points(points.xy * options.strength)

    def refine(self, points: Points, corrected: NDArray[np.float64] | None) -> Points:
        self.worked.append("refine")
        return points if corrected is None else Points(corrected)

    def __call__(self, run: Run, path: Path, seed: int = 0, strength: float = 1.0, corrected=None) -> NDArray:
        self.worked.clear()
        found = run.stage("detect", self.detect, path, seed)
        fitted = run.stage("fit", self.fit, found, Options(strength=strength))
        return run.stage("refine", self.refine, fitted, corrected).xy


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "input.bin"
    file.write_bytes(bytes([1, 2, 3]))
    return file


@pytest.fixture
def store(tmp_path: Path) -> StageStore:
    return StageStore(tmp_path / "store")


def test_it_is_told_when_stages_begin_and_end(path: Path, store: StageStore) -> None:
    told: list[tuple[str, str]] = []
    run = Run(store=store, on_stage=lambda name, turn: told.append((name, turn)))
    Pipeline()(run, path)
    with pytest.raises(ZeroDivisionError), run.timed("write"):
        _ = 1 / 0
    stages = [(name, turn) for name in ("detect", "fit", "refine") for turn in ("began", "ended")]
    assert told == [*stages, ("write", "began"), ("write", "broke")]


def test_a_second_run_works_nothing(path: Path, store: StageStore) -> None:
    pipeline = Pipeline()
    first = pipeline(Run(store=store), path, strength=2.0)
    assert pipeline.worked == ["detect", "fit", "refine"]
    again = Run(store=store)
    np.testing.assert_array_equal(pipeline(again, path, strength=2.0), first)
    assert pipeline.worked == []
    assert again.reused == ["detect", "fit", "refine"]


@pytest.mark.parametrize(
    ("change", "redone"),
    [
        ({"seed": 1}, ["detect", "fit", "refine"]),
        ({"strength": 0.5}, ["fit", "refine"]),
        ({"corrected": np.ones(3)}, ["refine"]),
        ({}, []),
    ],
    ids=["first", "middle", "last", "none"],
)
def test_a_changed_input_redoes_what_follows_and_no_more(path: Path, store: StageStore, change, redone) -> None:
    pipeline = Pipeline()
    pipeline(Run(store=store), path)
    result = pipeline(Run(store=store), path, **change)
    assert pipeline.worked == redone
    np.testing.assert_array_equal(result, pipeline(Run(), path, **change))  # and gives what a fresh run gives


def test_a_file_counts_by_its_content(path: Path, store: StageStore, tmp_path: Path) -> None:
    pipeline = Pipeline()
    pipeline(Run(store=store), path)
    copy = tmp_path / "another name.bin"
    copy.write_bytes(path.read_bytes())
    pipeline(Run(store=store), copy)
    assert pipeline.worked == []
    copy.write_bytes(bytes([9, 9, 9]))
    assert pipeline(Run(store=store), copy).tolist() == [9, 9, 9]
    assert pipeline.worked == ["detect", "fit", "refine"]


def test_another_version_of_the_engine_starts_afresh(
    path: Path, store: StageStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    pipeline = Pipeline()
    pipeline(Run(store=store), path)
    monkeypatch.setattr(engine, "__version__", "999")
    pipeline(Run(store=store), path)
    assert pipeline.worked == ["detect", "fit", "refine"]


def test_without_a_store_nothing_is_kept(path: Path) -> None:
    pipeline = Pipeline()
    pipeline(Run(), path)
    pipeline(Run(), path)
    assert pipeline.worked == ["detect", "fit", "refine"]


def test_a_killed_run_is_taken_up_where_it_stopped(path: Path, store: StageStore) -> None:
    class Killed(BaseException):
        pass

    class Interrupted(Pipeline):
        def refine(self, points: Points, corrected) -> Points:
            raise Killed

    with pytest.raises(Killed):
        Interrupted()(Run(store=store), path)
    pipeline = Pipeline()
    pipeline(Run(store=store), path)
    assert pipeline.worked == ["refine"]


def test_a_process_killed_while_it_stores_leaves_no_half_output(tmp_path: Path) -> None:
    """SIGKILL at whatever moment: what is in the store can be read and is whole."""
    script = (
        "import numpy as np, sys\nfrom pathlib import Path\nfrom engine.store import StageStore\n"
        "store = StageStore(Path(sys.argv[1]))\nprint('up', flush=True)\n"
        "for i in range(10**6):\n    store.save(f'key{i}', np.full((200, 1000), i))\n    print(i, flush=True)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", script, str(tmp_path)], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    for line in process.stdout:
        if line.strip() == "7":
            break
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    store = StageStore(tmp_path)
    keys = sorted(p.name for p in tmp_path.iterdir() if not p.name.startswith("."))
    assert len(keys) >= 8
    for key in keys:
        kept = store.load(key, NDArray[np.int64])
        assert kept is not None and (kept[1] == int(key[3:])).all() and kept[1].shape == (200, 1000)


def test_shared_stages_go_to_the_shared_store(path: Path, tmp_path: Path) -> None:
    pipeline = Pipeline()
    shared = StageStore(tmp_path / "shared")
    for job in ("one", "two"):
        run = Run(store=StageStore(tmp_path / job), shared=shared)
        found = run.stage("detect", pipeline.detect, path, 0, shared=True)
        run.stage("fit", pipeline.fit, found, Options())
    assert pipeline.worked == ["detect", "fit", "fit"]
    assert len(list((tmp_path / "two").iterdir())) == 1


def test_what_was_found_in_a_file_outlives_it(path: Path, store: StageStore) -> None:
    pipeline = Pipeline()
    first = pipeline(Run(store), path, strength=2.0)
    gone = {Path("gone"): content_hash(path)}
    path.unlink()
    again = pipeline(Run(store, erased=gone), Path("gone"), strength=3.0)
    assert pipeline.worked == ["fit", "refine"] and np.array_equal(again, first * 1.5)
    with pytest.raises(InputError) as refused:
        pipeline(Run(store, erased=gone), Path("gone"), seed=1)
    assert refused.value.code == "source_erased" and pipeline.worked == []


def test_stages_that_are_not_stored_work_every_time(path: Path, store: StageStore) -> None:
    pipeline = Pipeline()
    for _ in range(2):
        Run(store=store).stage("detect", pipeline.detect, path, 0, stored=False)
    assert pipeline.worked == ["detect", "detect"]
    assert not store.folder.exists()


def test_callables_do_not_count_towards_the_key_and_other_things_are_refused() -> None:
    run = Run()
    assert run.key("s", 1, print) == run.key("s", 1, len) == run.key("s", 1)
    with pytest.raises(TypeError):
        run.key("s", object())


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ((1,), (2,)),
        ((1,), ("1",)),
        ((None,), (0,)),
        ((np.zeros(3),), (np.zeros(3, np.float32),)),
        ((np.zeros((2, 3)),), (np.zeros((3, 2)),)),
        (((1, 2),), ((2, 1),)),
        (({"a": 1},), ({"a": 2},)),
        (({"a": 1},), ({"b": 1},)),
        ((Options(strength=1),), (Options(strength=2),)),
        ((Points(np.zeros(2)),), (Points(np.ones(2)),)),
        ((1, 2), ((1, 2),)),
    ],
)
def test_different_arguments_have_different_keys(a: tuple, b: tuple) -> None:
    run = Run()
    assert run.key("stage", *a) != run.key("stage", *b)
    assert run.key("stage", *a) == Run().key("stage", *a)
    assert run.key("stage", *a) != run.key("other", *a)


def test_a_mapping_has_the_key_of_its_items_in_whatever_order() -> None:
    assert Run().key("s", {"a": np.ones(2), "b": 1}) == Run().key("s", {"b": 1, "a": np.ones(2)})


def test_a_strided_array_has_the_key_of_its_values() -> None:
    grid = np.arange(24).reshape(4, 6)
    assert Run().key("s", grid.T) == Run().key("s", np.ascontiguousarray(grid.T))


def test_warnings_of_a_reused_stage_are_given_again(path: Path, store: StageStore) -> None:
    def look(path: Path, warn) -> Points:
        warn("dim", "The picture is dim.")
        warn("dim", "The picture is dim.")
        return Points(np.zeros(1))

    for _ in range(2):
        run = Run(store=store)
        run.stage("look", look, path, run.warn)
        assert run.notices == [Notice("dim", "The picture is dim.")]


def test_progress_goes_from_nought_to_one_in_the_planned_shares(path: Path) -> None:
    seen: list[Progress] = []
    run = Run(on_progress=seen.append)
    run.plan({"first": 1.0, "second": 3.0})
    with run.timed("first"):
        run.tick(1.0)
    with run.timed("second"):
        run.tick(0.5, "half of it")
    assert (seen[0].stage, seen[0].fraction) == ("first", 0.0)
    assert ("second", 0.25) in [(p.stage, p.fraction) for p in seen]
    fractions = [p.fraction for p in seen]
    assert fractions == sorted(fractions)
    assert all(0 <= f <= 1 for f in fractions)
    assert set(run.seconds) == {"first", "second"}


def test_a_run_that_plans_anew_goes_on_from_where_it_is() -> None:
    seen: list[Progress] = []
    run = Run(on_progress=seen.append)
    run.plan({"find": 1.0, "make": 1.0})
    with run.timed("find"), run.timed("make"):
        run.plan({"find": 1.0, "make": 1.0}, {"make": 7})
    for _ in range(6):
        with run.timed("make"):
            pass
    assert [p.fraction for p in seen] == [0.0, 0.0, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875]


def test_many_ticks_make_few_reports() -> None:
    seen: list[Progress] = []
    run = Run(on_progress=seen.append)
    run.plan({"only": 1.0})
    with run.timed("only"):
        for i in range(10_000):
            run.tick(i / 10_000)
    assert 1 <= len(seen) < 1000


def test_a_run_that_is_told_to_stop_stops_between_stages_and_inside_them(path: Path) -> None:
    told = False
    run = Run(canceled=lambda: told)
    with run.timed("first"):
        run.tick(0.5)
        told = True
        with pytest.raises(Canceled):
            run.tick(0.6)
    with pytest.raises(Canceled):
        run.stage("second", Pipeline().detect, path, 0)


def test_a_canceled_stage_keeps_nothing(path: Path, store: StageStore) -> None:
    told = False
    run = Run(store=store, canceled=lambda: told)

    def work(path: Path, tick) -> Points:
        nonlocal told
        told = True
        tick(0.5)
        return Points(np.zeros(1))

    with pytest.raises(Canceled):
        run.stage("work", work, path, run.tick)
    assert not store.folder.exists() or list(store.folder.iterdir()) == []


def test_artifacts_are_announced(tmp_path: Path) -> None:
    seen: list[Path] = []
    Run(on_artifact=seen.append).publish(tmp_path / "preview.jpg")
    assert seen == [tmp_path / "preview.jpg"]


def test_the_report_has_the_contract_s_fields(path: Path, tmp_path: Path) -> None:
    run = Run()
    run.stage("detect", Pipeline().detect, path, 0)
    run.warn("dim", "The picture is dim.")
    write_report(tmp_path / "report.json", "portrait", run, {"size": [2, 3]}, {"figure": 0.5})
    report = json.loads((tmp_path / "report.json").read_text())
    assert list(report) == ["kind", "engine_version", "stages", "inputs", "quality", "warnings"]
    assert report["engine_version"] == engine.__version__
    assert report["stages"]["detect"] >= 0
    assert report["warnings"] == [{"code": "dim", "message": "The picture is dim."}]
    assert report["inputs"] == {"size": [2, 3]} and report["quality"] == {"figure": 0.5}


def test_content_hash_is_sha256(path: Path) -> None:
    assert content_hash(path) == "039058c6f2c0cb492c533b0a4d14ef77cc0f78abccced5287d84a1a2011cfb81"


def _heavy(points: Points, by: float) -> Points:
    if by < 0:
        raise ValueError("less than nothing")
    return Points(points.xy * by)


def test_a_stage_beside_others_is_kept_like_any_other_and_takes_no_notices_of_theirs(store: StageStore) -> None:
    for reused in ([], ["heavy", "light"]):
        with Run(store=store) as run:
            run.plan({"light": 1, "heavy": 1})
            heavy = run.beside("heavy", _heavy, Points(np.ones(3)), 4.0)
            light = run.stage("light", _warning, run.warn)
            np.testing.assert_array_equal(heavy().xy, [4, 4, 4])
        np.testing.assert_array_equal(light.xy, [0])
        assert sorted(run.reused) == reused
        assert [notice.code for notice in run.notices] == ["dark"], "the notice belongs to the other stage"


def _warning(warn) -> Points:
    warn("dark", "It is dark.")
    return Points(np.zeros(1))


def test_a_wait_for_what_works_beside_can_be_canceled() -> None:
    go_on, canceled = threading.Event(), threading.Event()

    def slow(points: Points) -> Points:
        go_on.wait(30)
        return points

    with Run(canceled=canceled.is_set) as run:
        wait = run.beside("slow", slow, Points(np.ones(1)))
        threading.Timer(0.1, canceled.set).start()
        with pytest.raises(Canceled):
            wait()
        assert not go_on.is_set()
        go_on.set()


def test_what_goes_wrong_beside_is_raised_where_it_is_waited_for() -> None:
    with Run() as run:
        wait = run.beside("heavy", _heavy, Points(np.ones(3)), -1.0)
        with pytest.raises(ValueError, match="less than nothing"):
            wait()


def test_what_works_beside_warns_where_it_is_waited_for_and_again_when_it_is_reused(store: StageStore) -> None:
    for reused in ([], ["dim"]):
        with Run(store=store) as run:
            wait = run.beside("dim", _warning, run.warn)
            wait.output.result()
            assert run.notices == [] and run.reused == reused
            wait()
        assert [notice.code for notice in run.notices] == ["dark"]


def test_what_works_beside_reports_while_it_is_waited_for() -> None:
    seen: list[Progress] = []
    told = threading.Event()

    def slow(points: Points, tick) -> Points:
        tick(0.5)
        told.wait(30)
        return points

    def hear(progress: Progress) -> None:
        seen.append(progress)
        if progress.fraction > 0.5:
            told.set()

    with Run(on_progress=hear) as run:
        run.plan({"light": 1, "slow": 3})
        wait = run.beside("slow", slow, Points(np.ones(1)), run.tick)
        run.stage("light", _heavy, Points(np.ones(1)), 1.0)
        assert {one.stage for one in seen} == {"light"}, "nothing is heard of it before"
        wait()
        last = seen[-1]
    assert (last.stage, last.fraction) == ("slow", pytest.approx(0.25 + 0.75 * 0.5))


def test_what_works_beside_ends_where_another_stage_breaks_off() -> None:
    began, broken = threading.Event(), threading.Event()

    def endless(points: Points, tick) -> Points:
        began.set()
        for _ in range(3000):
            tick(0.5)
            broken.wait(0.01)
        return points

    with Run() as run:
        wait = run.beside("endless", endless, Points(np.ones(1)), run.tick)
        began.wait(30)
        with pytest.raises(ValueError, match="less than nothing"):
            run.stage("heavy", _heavy, Points(np.ones(1)), -1.0)
        with pytest.raises(Canceled):
            wait.output.result(timeout=20)


def test_a_run_is_over_when_nothing_works_beside_any_more() -> None:
    go_on, ended = threading.Event(), threading.Event()

    def slow(points: Points) -> Points:
        go_on.wait(30)
        ended.set()
        return points

    with Run() as run:
        last = run.beside("later", _heavy, run.beside("slow", slow, Points(np.ones(1))), 1.0)
        threading.Timer(0.1, go_on.set).start()
    assert ended.is_set() and last.output.done()


def test_what_works_beside_ends_where_the_run_is_left_by_an_error() -> None:
    began = threading.Event()

    def endless(points: Points, tick) -> Points:
        began.set()
        for _ in range(3000):
            tick(0.5)
            time.sleep(0.01)
        return points

    with pytest.raises(ValueError, match="between two stages"), Run() as run:
        wait = run.beside("endless", endless, Points(np.ones(1)), run.tick)
        began.wait(30)
        raise ValueError("between two stages")
    with pytest.raises(Canceled):
        wait.output.result(timeout=0)


def test_nothing_runs_beside_a_run_that_nobody_would_end() -> None:
    """After an error it would go on: whoever forgets the `with` is told at once, not on the day of the error."""
    with pytest.raises(RuntimeError, match="with Run"):
        Run().beside("heavy", _heavy, Points(np.ones(1)), 1.0)
    with Run() as run:
        pass
    with pytest.raises(RuntimeError, match="with Run"):
        run.beside("heavy", _heavy, Points(np.ones(1)), 1.0)


def test_cores_are_idle_where_no_stage_works_beside() -> None:
    cores = os.cpu_count() or 1
    begun, go = threading.Event(), threading.Event()
    seen: list[int] = []

    def slow(points: Points) -> Points:
        begun.set()
        go.wait(10)
        seen.append(run.idle_cores())
        return points

    with Run() as run:
        assert run.idle_cores() == cores
        later = run.beside("heavy", _heavy, run.beside("slow", slow, Points(np.ones(1))), 1.0)
        begun.wait(10)
        assert run.idle_cores() == max(cores - 1, 1)  # what waits for another stage does not work
        go.set()
        later()
        assert seen == [cores]  # its own is not another's
        assert run.idle_cores() == cores
