"""`sphstudy adopt [results=FOLDER]`: stored runs of an earlier version get today's names."""

from sphstudy.errors import ConfigurationError
from sphstudy.store.adoption import adopt
from sphstudy.store.store import Store


def adopt_command(arguments: list[str]) -> int:
    """Moves the records whose numbers are known to be today's, and lists those that stay as they are."""
    folder = "results"
    for argument in arguments:
        key, _, value = argument.partition("=")
        if key != "results" or not value:
            raise ConfigurationError([f"{argument}: adopt takes results=FOLDER only"])
        folder = value
    store = Store(folder)
    if not store.runs.is_dir():
        raise ConfigurationError([f"results={folder}: there are no runs"])
    store.prepare()
    found = adopt(store)
    for name, reason in found.left.items():
        print(f"{name}: left as it is, {reason}")
    print(f"{len(found.adopted)} records adopted, {len(found.left)} left as they are")
    return 0
