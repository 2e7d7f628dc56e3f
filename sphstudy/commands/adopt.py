"""Stored runs of an earlier version serve again.

    sphstudy adopt [options]

Gives today's names to records of an earlier version whose numbers are known to
be today's, and lists those that stay as they are.
"""

from sphstudy.commands.parser import Request
from sphstudy.errors import ConfigurationError
from sphstudy.store.adoption import adopt
from sphstudy.store.store import Store


def run(request: Request) -> int:
    """Moves records, and lists those that are left."""
    store = Store(request.results)
    if not store.runs.is_dir():
        raise ConfigurationError([f"results={request.results}: there are no runs"])
    store.prepare()
    found = adopt(store)
    for name, reason in found.left.items():
        print(f"{name}: left as it is, {reason}")
    print(f"{len(found.adopted)} records adopted, {len(found.left)} left as they are")
    return 0
