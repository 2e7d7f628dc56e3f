"""Numbers with units, measured from recorded fields and exact answers, never during a run.

A scene lists the modules that apply to it. Each has one function,

    measure(run, config) -> dict[str, Metric]

whose `run` is a record (xarray.Dataset, see store/record.py) and whose `config` is the configuration that
it was computed with. It returns metrics by name; an empty dictionary where the record lacks what they are
measured from, as modes, which record no motion. A metric that cannot be measured is NaN with a remark.
"""
