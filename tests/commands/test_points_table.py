"""Tables on the console: every point, or of very many only those that want attention."""

import pytest

from sphstudy.analysis.dataset import combine
from sphstudy.commands import points_table
from sphstudy.configuration.composition import session
from sphstudy.running.one_run import give_up
from sphstudy.store import identity
from sphstudy.store.record import with_metrics
from sphstudy.store.store import Store


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    store = Store(tmp_path_factory.mktemp("results"))
    with session() as hydra:
        points, _ = hydra.points(["scene=plate", "h=1.3,1.5", "n=5,7"], sweep=True)
    configs = [point.config for point in points]
    store.prepare()
    give_up(configs[0], store, "done", "")
    without_metrics = with_metrics(store.read(configs[0]), {}, identity.metrics_version(configs[0]))
    store.keep(configs[0], without_metrics)
    give_up(configs[1], store, "failed", "why")
    return combine(configs, store)


def test_every_point_of_a_few_has_its_line(dataset, capsys):
    points_table.print_tables(dataset)
    said = capsys.readouterr().out
    assert [said.count(word) for word in (" done", " failed", " missing")] == [1, 1, 2]
    assert "not listed" not in said


@pytest.mark.parametrize(("longest", "missing", "more"), [(3, 2, 1), (2, 1, 2)])
def test_of_many_those_that_are_not_done_are_listed(dataset, capsys, monkeypatch, longest, missing, more):
    monkeypatch.setattr(points_table, "LONGEST", longest)
    points_table.print_tables(dataset)
    said = capsys.readouterr().out
    assert [said.count(word) for word in (" done", " failed", " missing")] == [0, 1, missing]
    assert f"{more} more points are not listed" in said
