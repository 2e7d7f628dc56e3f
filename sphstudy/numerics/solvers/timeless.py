"""What solvers that know no time have in common."""

from collections.abc import Iterator


def check(config) -> Iterator[str]:
    """Complaints about times at which fields were to be kept."""
    for key, asked in (("times", list(config.record.times)), ("frames", config.record.frames)):
        if asked:
            yield f"record.{key}={asked}: solve={config.solve.name} knows no time"
