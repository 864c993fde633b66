"""`make demo`: starts the service with a fresh data folder, sends a portrait and a performance through its HTTP API,
leaves the video under demo/ and keeps serving the page that shows it."""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import httpx
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

ROOT = Path(__file__).parent.parent
DEMO_FOLDER = ROOT / "demo"
START_SECONDS = 120
STOP_SECONDS = 20
PREPARE_ENGINE = "prepare_engine"
"""The stage of a job that waits for the engine to be compiled."""

console = Console(highlight=False, soft_wrap=True)


class DemoError(Exception):
    """The demo cannot go on; the text says why."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--image", type=Path, help="a portrait of your own")
    parser.add_argument("--driver", default="happy", help="a video of your own, or the name of a built-in performance")
    parser.add_argument("--once", action="store_true", help="end when the video is there, instead of serving on")
    parser.add_argument("--folder", type=Path, default=DEMO_FOLDER, help="where the video and the service's data go")
    arguments = parser.parse_args()
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: sys.exit(0))  # so that the service is stopped along with the demo
    try:
        run(arguments.image or sample_portrait(), arguments.driver, arguments.once, arguments.folder)
    except DemoError as error:
        console.print(f"[red]demo: {error}[/red]")
        sys.exit(1)
    except KeyboardInterrupt:
        console.print()


def run(image: Path, driver: str, once: bool, folder: Path) -> None:
    if not image.is_file():
        raise DemoError(f"there is no file {image}")
    with service(folder) as (process, address), httpx.Client(base_url=address, timeout=60, trust_env=False) as client:
        job = order(client, image, driver)
        page = f"{address}/#/jobs/{job['id']}"
        console.print(f"Follow it at {page}")
        job = follow(client, job)
        if job["status"] != "succeeded":
            raise DemoError((job["error"] or {}).get("detail") or f"the job was {job['status']}")
        video = fetch(client, job, folder / f"{image.stem}-{Path(driver).stem}.mp4")
        console.print(f"\nVideo  {video.relative_to(Path.cwd()) if video.is_relative_to(Path.cwd()) else video}")
        for warning in answer(client.get(job["artifacts"]["report.json"]["url"])).json()["warnings"]:
            console.print(f"Note   {warning['message']}")
        if not once:
            console.print(f"Page   {page}\n\nServing until Ctrl-C.")
            process.wait()
            raise DemoError(f"the service ended; see {folder / 'serve.log'}")


def sample_portrait() -> Path:
    """Grace Hopper, a public-domain photograph that comes with matplotlib."""
    spec = find_spec("matplotlib")
    if spec is None or spec.origin is None:
        raise DemoError("the sample portrait comes with matplotlib, which is not installed: give IMAGE=...")
    return Path(spec.origin).parent / "mpl-data" / "sample_data" / "grace_hopper.jpg"


@contextmanager
def service(folder: Path) -> Iterator[tuple[subprocess.Popen[bytes], str]]:
    """A running service with nothing in it, on a free port of the loopback interface, and its address."""
    data = folder / "galatea-demo-data"
    shutil.rmtree(data, ignore_errors=True)
    data.mkdir(parents=True)
    address = f"http://127.0.0.1:{(port := free_port())}"
    log = folder / "serve.log"
    with log.open("wb") as output:
        process = subprocess.Popen(  # noqa: S603 (our own program)
            [str(Path(sys.executable).with_name("galatea")), "serve", "--host", "127.0.0.1", "--port", str(port)],
            env={**os.environ, "GALATEA_DATA_DIR": str(data)},
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # Ctrl-C reaches the demo alone, which then stops the service in order
        )
    try:
        with console.status("Starting the service"):
            wait_until_ready(process, address, log)
        yield process, address
    finally:
        process.terminate()
        try:
            process.wait(STOP_SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def wait_until_ready(process: subprocess.Popen[bytes], address: str, log: Path) -> None:
    deadline = time.monotonic() + START_SECONDS
    while time.monotonic() < deadline:
        if process.poll() is not None:
            tail = "\n".join(log.read_text(errors="replace").splitlines()[-15:])
            raise DemoError(f"the service ended at once; the end of {log.name}:\n{tail}")
        try:
            if httpx.get(f"{address}/readyz", timeout=5, trust_env=False).is_success:
                return
        except httpx.TransportError:
            pass
        time.sleep(0.2)
    raise DemoError(f"the service was not ready after {START_SECONDS} s; see {log}")


def order(client: httpx.Client, image: Path, driver: str) -> dict[str, Any]:
    """Send the files, then the job."""
    inputs = {"image": upload(client, image), "driver": upload(client, Path(driver)) if is_file(driver) else driver}
    names = {"portrait": image.stem.replace("_", " ").title(), "performance": Path(driver).stem.capitalize()}
    body = {"kind": "portrait", "inputs": inputs, "metadata": names}
    job: dict[str, Any] = answer(client.post("/v1/jobs", json=body)).json()
    return job


def is_file(driver: str) -> bool:
    """Whether a driver is a file; what looks like a path and is none is a mistake, not a name."""
    if Path(driver).is_file():
        return True
    if "/" in driver or Path(driver).suffix:
        raise DemoError(f"there is no file {driver}")
    return False


def upload(client: httpx.Client, path: Path) -> str:
    with path.open("rb") as file:
        return str(answer(client.post("/v1/files", files={"file": (path.name, file)}, timeout=None)).json()["id"])


def answer(response: httpx.Response) -> httpx.Response:
    """The response, if it is a success."""
    if response.is_error:
        response.read()
        try:
            raise DemoError(response.json()["detail"])
        except (ValueError, KeyError):
            raise DemoError(f"the service answered {response.status_code}") from None
    return response


def follow(client: httpx.Client, job: dict[str, Any]) -> dict[str, Any]:
    """Show the job's progress until it is finished; the job as it then is."""
    columns = TextColumn("{task.description:<28}"), BarColumn(), TaskProgressColumn(), TextColumn("{task.fields[eta]}")
    with Progress(*columns, console=console) as bar:
        task = bar.add_task("Waiting", total=1.0, eta="")
        for kind, data in events(client, job["id"]):
            if kind == "progress":
                if data["stage"] == PREPARE_ENGINE:
                    console.print(data["message"])
                eta = data.get("eta_seconds")
                stage = (data["stage"] or "Waiting").replace("_", " ")
                bar.update(
                    task,
                    completed=data["fraction"],
                    description=stage[:1].upper() + stage[1:],
                    eta=f"about {eta:.0f} s left" if eta else "",
                )
        ended: dict[str, Any] = answer(client.get(f"/v1/jobs/{job['id']}")).json()
        if ended["status"] == "succeeded":
            bar.update(task, completed=1.0, description="Done", eta="")
    return ended


def events(client: httpx.Client, job_id: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """A job's server-sent events, as (type, data), taken up after the last one seen where the line breaks."""
    last = ""
    while True:
        headers = {"Last-Event-ID": last} if last else {}
        try:
            with client.stream("GET", f"/v1/jobs/{job_id}/events", headers=headers, timeout=60) as stream:
                answer(stream)
                if stream.status_code == httpx.codes.NO_CONTENT:
                    return
                for fields in messages(stream.iter_lines()):
                    last = fields.get("id", last)
                    if "data" in fields:
                        yield fields.get("event", "message"), json.loads(fields["data"])
        except httpx.TransportError:
            time.sleep(1)


def messages(lines: Iterator[str]) -> Iterator[dict[str, str]]:
    """The messages of an event stream as their fields."""
    fields: dict[str, str] = {}
    for line in lines:
        if not line:
            if fields:
                yield fields
            fields = {}
        elif not line.startswith(":"):  # a comment keeps the line open
            name, _, value = line.partition(":")
            value = value.removeprefix(" ")
            fields[name] = f"{fields[name]}\n{value}" if name == "data" and "data" in fields else value


def fetch(client: httpx.Client, job: dict[str, Any], target: Path) -> Path:
    """Download the job's video."""
    with client.stream("GET", job["artifacts"]["animation.mp4"]["url"]) as stream, target.open("wb") as file:
        for piece in answer(stream).iter_bytes():
            file.write(piece)
    return target


if __name__ == "__main__":
    main()
