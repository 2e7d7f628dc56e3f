"""The plan of a sweep on the console: which points would run, why, and what they would cost."""

import json
from datetime import datetime, timedelta

from sphstudy.configuration.composition import Point
from sphstudy.configuration.run_settings import flattened
from sphstudy.console import print_table
from sphstudy.running.plan import Planned, prediction
from sphstudy.store import identity
from sphstudy.store.adoption import adoptable, translated
from sphstudy.store.store import Store, read_summary
from sphstudy.table import Column, Table


def print_plan(planned: list[Planned], store: Store, workers: int) -> None:
    """Prints a table of the points, and when all would be done.

    Parameters
    ----------
    planned : list of Planned
        What `running.plan.plan` made of the points.
    store : Store
        Where their records would be.
    workers : int
        How many runs would go on at once.
    """
    headings = ("point", "would run", "because", "CPU (s)", "memory (MB)")
    older = _older_records(planned, store)
    rows = []
    for p in sorted(planned, key=lambda p: -p.seconds):
        numbers = f"{p.seconds:.1f}", f"{p.memory / 1e6:.0f}"
        reason = older.get(id(p), p.reason)
        rows.append([p.point.config.label, "yes" if p.runs else "no", reason, *numbers])
    print_table(Table.of_texts([Column(text, numeric="(" in text) for text in headings], rows))
    pending = [p for p in planned if p.runs]
    print(prediction(pending))
    if pending:
        # Not before the longest of them ends: a run is not shared between workers.
        seconds = max(sum(p.seconds for p in pending) / workers, *(p.seconds for p in pending), 0.0)
        end = datetime.now().astimezone() + timedelta(seconds=seconds)
        most = max(p.memory for p in pending) * min(workers, len(pending)) / 1e6
        print(f"begun now, {workers} at once: done about {end:%a %H:%M}, up to {most:.0f} MB of memory")


def _older_records(planned: list[Planned], store: Store) -> dict[int, str]:
    """For points without a record, why one of the same label does not serve: by id of the point."""
    wanted = {p.point.config.label: p for p in planned if p.status == "missing"}
    found: dict[int, str] = {}
    for path in store.files():
        label = path.stem.rpartition("-")[0]
        if label not in wanted or (summary := read_summary(path)) is None:
            continue
        p = wanted[label]
        reason = _difference(summary.attributes, p.point)
        # The least different of several records tells most.
        if id(p) not in found or len(reason) < len(found[id(p)]):
            found[id(p)] = reason
    return found


def _difference(attributes: dict, point: Point) -> str:
    """What sets a stored record apart from a point of the same label."""
    configuration = json.loads(attributes["configuration"])
    earlier = adoptable(attributes)
    stored = flattened(translated(configuration) if earlier else configuration)
    now = point.config.flat()
    changed = [key for key in now if stored.get(key) != now[key]]
    if not changed and earlier:
        return "stored by an earlier version, with the same numbers: `sphstudy adopt` keeps it"
    if not changed and attributes["numerics_version"] != identity.numerics_version(point.config):
        return "changed numerics: the code of scene, method or solver"
    told = ", ".join(f"{key}={stored.get(key)} is stored" for key in changed[:3])
    more = f" and {len(changed) - 3} more" if len(changed) > 3 else ""
    return f"new: {told}{more}"
