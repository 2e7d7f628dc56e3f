"""Stale records and their space; --yes removes them.

    sphstudy prune [--yes] [options]

Lists files in results/runs that serve nobody any more, why, and their size.

    sphstudy prune                             only lists
    sphstudy prune --yes                       removes what it lists
"""

from sphstudy.commands.parser import Request
from sphstudy.console import print_table
from sphstudy.errors import ConfigurationError
from sphstudy.store.stale import RULES, remove, stale
from sphstudy.store.store import Store
from sphstudy.table import Column, Table


def run(request: Request) -> int:
    """Lists what is stale; removes it with --yes."""
    store = Store(request.results)
    if not store.runs.is_dir():
        raise ConfigurationError([f"results={request.results}: there are no runs"])
    found = list(stale(store))
    columns = [Column("file", numeric=False), Column("because", numeric=False), Column("MB")]
    print_table(Table.of_texts(columns, [[o.path.name, o.reason, f"{o.size / 1e6:.2f}"] for o in found]))
    total = f"{len(found)} files, {sum(one.size for one in found) / 1e6:.1f} MB"
    if request.has("yes"):
        for one in found:
            remove(one.path)
        print(f"removed: {total}")
    else:
        print(f"stale: {total}" + (" (--yes removes them)" if found else ""))
        print(RULES)
    return 0
