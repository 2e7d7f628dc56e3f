"""The terminal, or what stands in its place where output goes to a file or a pipe."""

from rich.console import Console


def console() -> Console:
    """The terminal, or something wide enough for any table. Text in brackets is text, not markup."""
    there = Console(markup=False)
    return there if there.is_terminal else Console(width=400, markup=False)
