"""Metrics of a study again, from stored fields.

    sphstudy measure STUDY [key=value ...] [options]

Measures stored runs with today's metrics and keeps these; runs nothing.
Settings (key=value) replace what the study's file says.

    sphstudy measure mode1                     after a metric has changed
"""

from sphstudy.analysis import dataset
from sphstudy.commands.parser import Request
from sphstudy.commands.points_table import print_tables
from sphstudy.configuration import study_file
from sphstudy.configuration.composition import session
from sphstudy.configuration.study_points import all_points
from sphstudy.store.measured import measured
from sphstudy.store.record import STATUS
from sphstudy.store.store import Store


def run(request: Request) -> int:
    """Measures the stored runs of a study that are done, keeps that, and prints it."""
    name, settings = request.words[0], list(request.settings)
    with session(request.config_dir) as hydra:
        points, folder, _ = all_points(hydra, name, settings)
    store, count = Store(folder), 0
    store.prepare()
    configs = [point.config for point in points]
    for config in configs:
        record = store.read(config)
        if record is not None and STATUS[int(record["status"])] == "done":
            store.keep(config, measured(record, config))
            count += 1
    combined = dataset.combine(configs, store, name)
    path = dataset.write(combined, configs, store, study_file.results_name(name, settings))
    print_tables(combined)
    print(f"{count} of {len(points)} points measured again\ndataset: {path}")
    return 0
