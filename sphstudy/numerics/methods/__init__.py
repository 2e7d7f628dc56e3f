"""How a scene is discretised. A method is one module here and one file in conf/method.

A method module has `Parameters` (a validated dataclass), `SOLVERS` and `INTEGRATORS` (those it takes, the
first integrator being its own), `check(config)` (yields complaints), `memory(particles, config)` (bytes),
`lattice_neighbours(config)`, `wave_speed(config, problem)`, `model(problem, config, crack_nodes)` (rates
or a potential, built on the operators of `numerics.sph`), `system(problem, config, dt, integrator)` (the
same as explicit stepping takes it) and, if it is a potential, `highest_frequency(problem, config)`.
"""
