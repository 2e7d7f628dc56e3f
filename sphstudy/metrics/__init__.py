"""Numbers with units, computed from recorded fields and exact answers, never during a run.

A metric module has `measure(run, config)`: from a record (xarray.Dataset) to named Metrics. A scene lists
the modules that apply to it.
"""
