"""The processes that do the work: warm, confined, ended with their worker."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import psutil
import pytest

from service.settings import Settings
from worker.job_process.children import Child, ChildLost, WarmChildren

ROOT = Path(__file__).parents[3]


@pytest.fixture
def settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Settings:
    monkeypatch.syspath_prepend(str(ROOT / "tests" / "live_service"))
    monkeypatch.syspath_prepend(str(ROOT))
    monkeypatch.setenv("GALATEA_REDIS_URL", "redis://user:password@example.org")
    return Settings(data_dir=tmp_path, kinds=["tiny_kind:KIND"], job_niceness=7)


def ready(child: Child) -> None:
    for _ in range(600):
        if any(event["event"] == "ready" for event in child.receive(0.1)):
            return
    raise AssertionError("it is never ready")


def test_it_is_confined_and_knows_no_secrets(settings: Settings) -> None:
    child = Child(settings)
    try:
        ready(child)
        process = psutil.Process(child.pid)
        assert not any(name.startswith("GALATEA_") for name in process.environ())
        assert process.rlimit(psutil.RLIMIT_DATA)[0] == settings.job_memory_mb * 1e6
        assert process.rlimit(psutil.RLIMIT_FSIZE)[0] == settings.job_file_mb * 1e6
        assert process.rlimit(psutil.RLIMIT_CORE) == (0, 0)
        assert Path(f"/proc/{child.pid}/oom_score_adj").read_text().strip() == "1000"
        assert process.nice() == settings.job_niceness
        session = Path(f"/proc/{child.pid}/autogroup")  # where the kernel has groups, they count, and not its processes
        assert not session.exists() or session.read_text().split()[-1] == str(settings.job_niceness)
        assert 5 < child.memory_mb() < 500
    finally:
        child.kill()
    assert not psutil.pid_exists(child.pid)
    child.kill()  # again is no error


def test_its_end_is_noticed_and_explained(settings: Settings) -> None:
    child = Child(settings)
    ready(child)
    os.kill(child.pid, signal.SIGSEGV)
    with pytest.raises(ChildLost, match="signal 11"):
        child.receive(5)
    child.kill()


def test_one_is_used_again_unless_something_is_wrong_with_it(settings: Settings) -> None:
    children = WarmChildren(settings, 1, [])
    try:
        first = children.take()
        children.give_back(first, reuse=True)
        second = children.take()
        assert second.pid == first.pid
        children.give_back(second, reuse=False)
        assert not psutil.pid_exists(first.pid)
        assert children.take().pid != first.pid
    finally:
        children.close()
