"""A run as a worker gets it: plain values, which another process or machine can read."""

from dataclasses import dataclass
from typing import Any

from sphstudy.configuration.composition import Point
from sphstudy.configuration.execution import Execution
from sphstudy.configuration.run_settings import RunConfig, validate
from sphstudy.store.lock import is_alive
from sphstudy.store.store import Store


@dataclass(frozen=True)
class Job:
    """One run that is to be done.

    values : its configuration as a dictionary.
    results : the folder of its record.
    execution : how it is carried out.
    known : stamp of the record that it replaces (see Store.stamp), 0 if there was none. Another stamp
        means that somebody else has computed the run meanwhile.
    """

    values: dict[str, Any]
    results: str
    execution: Execution
    known: int = 0

    @classmethod
    def of(cls, point: Point, store: Store) -> "Job":
        """The job of a point, as its record is now."""
        folder, known = str(store.folder), store.stamp(point.config)
        return cls(point.config.as_dict(), folder, point.execution, known)

    @property
    def config(self) -> RunConfig:
        """The configuration, validated."""
        return validate(self.values)

    @property
    def store(self) -> Store:
        """Where the record goes."""
        return Store(self.results)

    def is_recorded(self) -> bool:
        """Whether there is a record that was written since."""
        return self.store.stamp(self.config) != self.known

    def is_claimed(self) -> bool:
        """Whether a living process computes the run."""
        return is_alive(self.store.claim_path(self.config))
