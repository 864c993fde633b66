"""How quick a live portrait is: a clip's frames are sent as a camera would send them, by a WebSocket, to a service that runs.

    python -m benchmarks.live --image PORTRAIT --clip CLIP [--fps 25] [--seconds 12] [--url http://127.0.0.1:8000]

Prints frames a second that came back once the portrait was live, and the delay from a frame's sending to its picture's
arrival, median and 95th percentile. Clip and sender run on the same machine, decoded and encoded before.
"""

from __future__ import annotations

import argparse
import json
import threading
import time
from pathlib import Path

import cv2
import httpx
import numpy as np
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from engine.media.video import read_video

CAMERA_SIDE_PIXELS = 640
"""Pixels of a frame's longest side, as the page sends them."""


def camera_frames(clip: Path, fps: float, seconds: float) -> list[bytes]:
    """The clip's frames as a camera's, forth and back so that it goes on without a cut."""
    frames = []
    for frame in read_video(clip, fps=fps, longest_side=CAMERA_SIDE_PIXELS):
        done, jpeg = cv2.imencode(".jpg", cv2.cvtColor(frame.rgb, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, 80])
        assert done
        frames.append(jpeg.tobytes())
        if len(frames) >= seconds * fps:
            break
    there_and_back = frames + frames[-2:0:-1]
    return [there_and_back[k % len(there_and_back)] for k in range(round(seconds * fps))]


def drive(url: str, image: Path, clip: Path, fps: float, seconds: float, keep: Path | None = None) -> dict[str, float]:
    """Drive the portrait by the clip; what was measured. The pictures that came back go to the folder `keep`."""
    frames = camera_frames(clip, fps, seconds)
    with httpx.Client(base_url=url, timeout=60) as client:
        file = client.post("/v1/files", files={"file": (image.name, image.read_bytes())}).raise_for_status().json()
        live = client.post("/v1/live", json={"image": file["id"]}).raise_for_status().json()
    sent: dict[int, float] = {}
    got: list[tuple[float, int]] = []
    ready = threading.Event()
    live_at = [0.0]
    with connect(url.replace("http", "ws", 1) + live["stream"], compression=None, max_size=None, proxy=None) as line:

        def take() -> None:
            try:
                while True:
                    message = line.recv()
                    if isinstance(message, str):
                        event = json.loads(message)
                        print(f"{time.monotonic() - began:6.1f} s {message}")
                        if event["event"] != "preparing":
                            ready.set()
                        if event["event"] == "ready" and not live_at[0]:
                            live_at[0] = time.monotonic()
                        continue
                    number = int.from_bytes(message[:4], "big")
                    got.append((time.monotonic(), number))
                    if keep is not None:
                        (keep / f"{number:05d}.jpg").write_bytes(message[4:])
            except ConnectionClosed:
                ready.set()

        began = time.monotonic()
        taking = threading.Thread(target=take, daemon=True)
        taking.start()
        ready.wait()
        start = time.monotonic()
        for number, frame in enumerate(frames):
            time.sleep(max(0.0, start + number / fps - time.monotonic()))
            sent[number] = time.monotonic()
            line.send(number.to_bytes(4, "big") + frame)
        time.sleep(0.5)
        end = time.monotonic()
    after = [(at, number) for at, number in got if live_at[0] and at > live_at[0] + 0.5]
    delays = np.array([at - sent[number] for at, number in after])
    lasted = min(end - 0.5, max(sent.values())) - live_at[0] - 0.5
    return {
        "frames a second": len(after) / lasted,
        "median delay, ms": float(np.median(delays)) * 1000,
        "95% delay, ms": float(np.percentile(delays, 95)) * 1000,
        "seconds to live": live_at[0] - start,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--image", type=Path, required=True)
    parser.add_argument("--clip", type=Path, required=True)
    parser.add_argument("--fps", type=float, default=25.0)
    parser.add_argument("--seconds", type=float, default=12.0)
    parser.add_argument("--url", default="http://127.0.0.1:8000")
    parser.add_argument("--keep", type=Path, help="a folder for the pictures that come back")
    given = parser.parse_args()
    for name, value in drive(given.url, given.image, given.clip, given.fps, given.seconds, given.keep).items():
        print(f"{name:20} {value:8.1f}")


if __name__ == "__main__":
    main()
