"""What anybody would write to follow a face through a clip and code it again, by MediaPipe's and PyAV's own manuals: the
measure of what whole processes may take. `benchmarks.floor` does the same by the project's own, leaner parts.

    python -m benchmarks.plain_script CLIP OUT.mp4
"""

from __future__ import annotations

import sys
from pathlib import Path

import av
import mediapipe


def plain_script(clip: Path, out: Path) -> None:
    """Decode, track, encode: everything as it comes."""
    tracker = mediapipe.solutions.face_mesh.FaceMesh(refine_landmarks=True)
    with av.open(str(clip)) as source, av.open(str(out), "w") as result:
        video = source.streams.video[0]
        stream = result.add_stream("libx264", rate=video.average_rate, options={"crf": "18"})
        stream.width, stream.height, stream.pix_fmt = video.width, video.height, "yuv420p"
        for frame in source.decode(video):
            rgb = frame.to_ndarray(format="rgb24")
            tracker.process(rgb)
            result.mux(stream.encode(av.VideoFrame.from_ndarray(rgb, format="rgb24")))
        result.mux(stream.encode(None))


if __name__ == "__main__":
    plain_script(Path(sys.argv[1]), Path(sys.argv[2]))
