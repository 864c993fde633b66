"""Keeping what native libraries print to standard error away from the person at the shell."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from engine.errors import Canceled, InputError


@contextmanager
def silence_libraries() -> Iterator[TextIO]:
    """Within, file descriptor 2 leads to a temporary file; the value is the real standard error.

    What was printed is shown after all if the work ends by a fault of the program.
    """
    sys.stderr.flush()
    real = os.dup(2)
    with os.fdopen(real, "w") as shown, tempfile.TemporaryFile() as hidden:
        os.dup2(hidden.fileno(), 2)
        try:
            yield shown
        except (InputError, Canceled, KeyboardInterrupt):
            raise
        except BaseException:
            hidden.seek(0)
            shown.write(hidden.read().decode(errors="replace"))
            raise
        finally:
            sys.stderr.flush()
            shown.flush()
            os.dup2(real, 2)
