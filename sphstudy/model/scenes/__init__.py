"""What is simulated. A scene is one module here and one file in conf/scene.

A scene module has `Parameters` (a validated dataclass), `check(config)` (yields complaints about
resolution and geometry), `build(config)` (the Problem), `METRICS` (names of metric modules) and
`HEADLINE` (metrics shown in tables).
"""
