"""The log beside a record: what became of the run, try after try, and what libraries warned of."""

import logging
import os
import platform
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


class _File(logging.FileHandler):
    """A file; a full disk costs its lines, not the run, and so does a folder or a pipe of that name."""

    def emit(self, record: logging.LogRecord) -> None:
        # To write to a pipe is to wait for whoever reads from it.
        if os.path.lexists(self.baseFilename) and not os.path.isfile(self.baseFilename):
            return
        # The first line opens the file, which may fail as well.
        with suppress(OSError):
            super().emit(record)

    def handleError(self, record: logging.LogRecord) -> None:
        pass

    def close(self) -> None:
        with suppress(OSError):
            super().close()


@contextmanager
def run_log(path: Path) -> Iterator[logging.Logger]:
    """A logger that adds lines to the file `path`, each entry with date, machine and process.

    Warnings of the block go there too, not to the console. A file that cannot be written is no error.
    """
    file = _File(path, delay=True, encoding="utf-8")
    host = platform.node().replace("%", "%%")
    entry = f"%(asctime)s UTC, {host}, process %(process)d: %(message)s"
    form = logging.Formatter(entry, "%Y-%m-%d %H:%M:%S")
    form.converter = time.gmtime
    file.setFormatter(form)
    log, captured = logging.Logger("run"), logging.getLogger("py.warnings")
    show, upwards = warnings.showwarning, captured.propagate
    log.addHandler(file)
    captured.addHandler(file)
    captured.propagate = False
    logging.captureWarnings(True)
    try:
        yield log
    finally:
        logging.captureWarnings(False)
        # Of a program that had them captured already.
        warnings.showwarning = show
        captured.propagate = upwards
        captured.removeHandler(file)
        file.close()
