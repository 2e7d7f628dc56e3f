"""How the program behaves as a process: Ctrl-C, pipes without a reader, full disks, exit statuses."""

import contextlib
import errno
import importlib
import os
import sys

from sphstudy.running.interrupt import interruptible, on_interrupt

_INTERRUPTED = "sphstudy: interrupted; finished runs are kept"
_DISK = (errno.EACCES, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.ENOSPC, errno.EROFS, errno.ESTALE)
"""Errors with which a disk refuses what is written to it."""


def main(arguments: list[str], version: str) -> int:
    """Runs the program.

    Parameters
    ----------
    arguments : list of str
        The arguments of the program.
    version : str
        The answer to --version.

    Returns
    -------
    int
        The exit status: 0 done, 1 something failed, 2 wrong input, 130 interrupted, 141 nobody reads
        the output.
    """
    try:
        status = _answered(arguments, version)
        # Now, or an error would show only when the interpreter ends.
        print(end="", flush=True)
        return status
    except KeyboardInterrupt:
        _complain(_INTERRUPTED)
        return 130
    except BrokenPipeError:
        return 141
    except SystemExit as error:
        # rich turns a BrokenPipeError into this.
        if not isinstance(error.__context__, BrokenPipeError):
            raise
        return 141
    except OSError as error:
        if error.errno not in _DISK:
            raise
        _complain(f"sphstudy: {error}; finished runs are kept")
        return 1
    finally:
        _drop_unread_output()


def _answered(arguments: list[str], version: str) -> int:
    with on_interrupt(_leave_at_once):
        from sphstudy.commands.parser import help_text, parse
        from sphstudy.console import write_what_the_terminal_has
        from sphstudy.errors import ConfigurationError
    write_what_the_terminal_has()
    text = f"{version}\n" if "--version" in arguments else help_text(arguments)
    if text is not None:
        print(text, end="")
        return 0
    try:
        with on_interrupt(_leave_at_once):
            request = parse(arguments)
            command = importlib.import_module(f"sphstudy.commands.{request.module}")
        with on_interrupt(_leave_if_compiling), interruptible():
            return command.run(request)
    except ConfigurationError as error:
        for complaint in error.complaints:
            print(f"sphstudy: {complaint}", file=sys.stderr)
        return 2


def _complain(line: str) -> None:
    with contextlib.suppress(OSError):
        print(line, file=sys.stderr)


def _leave_at_once() -> None:
    """Ends the process. For Ctrl-C while modules are imported or functions compiled: libraries turn a
    KeyboardInterrupt into other errors there, or print it themselves.
    """
    # Not by way of sys.stderr, which the process may be writing to. A display may have hidden the cursor.
    shown = "\n\x1b[?25h" if os.isatty(2) and os.environ.get("TERM", "dumb") != "dumb" else ""
    with contextlib.suppress(OSError):
        os.write(2, f"{shown}{_INTERRUPTED}\n".encode())
    os._exit(130)


def _leave_if_compiling() -> None:
    """LLVM, interrupted, may drop the KeyboardInterrupt and print it, or crash as the process ends."""
    lock = sys.modules.get("numba.core.compiler_lock")
    if lock is not None and lock.global_compiler_lock.is_locked():
        _leave_at_once()


def _drop_unread_output() -> None:
    """Output that its reader or its disk refused: Python would try again at its end, and complain."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
