"""The process of one live portrait. It loads the engine, forks, and confines itself before it opens a stranger's file.

`python -m worker.live.child PARENT_PID SOCKET_FD ORDER`: ORDER is JSON, see `worker.live.processes`.
"""

from __future__ import annotations

import json
import os
import socket
import sys
import traceback
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from engine.errors import InputError
from engine.media.limits import Limits as MediaLimits
from engine.perception.models import MODEL_SETTINGS
from engine.portrait import KIND
from engine.portrait.live.live_portrait import LivePortrait, prepare_live
from engine.portrait.live.options import LiveOptions
from engine.run import Run
from service.live.process import EVENT_TAG
from worker.compilation.rehearsal import compiled_folders, load_compiled
from worker.job_process.child import compile_without_keeping
from worker.live.stream import LiveStream
from worker.live.wire import Wire
from worker.programs.parent_death import die_with_parent
from worker.sandbox.confinement import Limits, confine, keep_to_cores, limit, program_paths


def perform(order: Mapping[str, Any], wire: Wire) -> None:
    """Make the target ready, and follow the camera."""
    options = LiveOptions.model_validate(order["options"])
    try:
        with Run(limits=MediaLimits(**order["limits"])) as run:
            target = prepare_live(Path(order["image"]), options, run)
    except InputError as error:
        failed = {"event": "failed", "code": error.code, "detail": error.detail}
        wire.send(EVENT_TAG, json.dumps(failed).encode())
        return
    with LivePortrait(target, options) as portrait:
        wire.send(EVENT_TAG, json.dumps({"event": "calibrating", "fraction": 0.0, "obstacle": None}).encode())
        LiveStream(wire, portrait, order["frame_pixels"], order["mark_synthetic"]).run()


def _work(
    order: Mapping[str, Any], limits: Limits, program: Sequence[Path], parent: int, line: socket.socket
) -> NoReturn:
    """The life of the process that is walled in."""
    code = 1
    try:
        keep_to_cores(order["cores"])
        confine(parent, limits, [*program, Path(order["image"])], [])
        perform(order, Wire(line))
        code = 0
    except Exception:
        traceback.print_exc()
    finally:
        sys.stderr.flush()
        os._exit(code)


def main() -> None:
    parent, descriptor, order = int(sys.argv[1]), int(sys.argv[2]), json.loads(sys.argv[3])
    limits = Limits(**order["process_limits"])
    die_with_parent(parent)
    limit(limits)
    assert KIND.prepare is not None
    KIND.prepare()
    load_compiled([KIND.name])
    compile_without_keeping()
    models = [Path(os.environ[setting]) for setting in MODEL_SETTINGS if setting in os.environ]
    program = [*program_paths(), *compiled_folders(), *models]
    line = socket.socket(fileno=descriptor)
    here = os.getpid()
    worker = os.fork()
    if worker == 0:
        _work(order, limits, program, here, line)
    line.close()
    os._exit(os.waitstatus_to_exitcode(os.waitpid(worker, 0)[1]) != 0)


if __name__ == "__main__":
    main()
