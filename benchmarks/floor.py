"""The least that any system of this kind does with a clip: decode, follow the face, encode. A process of its own, which loads
nothing else and is spared what `galatea` is spared. Nobody writes it so at first: see `benchmarks.plain_script`.

    python -m benchmarks.floor CLIP OUT.mp4
"""

from __future__ import annotations

import atexit
import gc
import sys
from pathlib import Path

gc.set_threshold(20_000, 20, 20)
atexit.register(gc.freeze)

from engine.export.videos.encoders import VideoTarget  # noqa: E402
from engine.export.videos.video import VideoWriter  # noqa: E402 - rubbish is looked for less often while these are loaded
from engine.media.video import probe_video, read_video  # noqa: E402
from engine.perception.face.faces import FaceTracker  # noqa: E402


def floor(clip: Path, out: Path) -> None:
    """Read a clip frame by frame, look for its face, and write it again."""
    info = probe_video(clip)
    with FaceTracker() as tracker, VideoWriter(VideoTarget(out, (info.width, info.height), info.fps)) as writer:
        for frame in read_video(clip):
            tracker(frame.rgb)
            writer.write(frame.rgb)


if __name__ == "__main__":
    floor(Path(sys.argv[1]), Path(sys.argv[2]))
