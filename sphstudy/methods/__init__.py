"""How a scene is discretised. A method is one module here and one file in conf/method.

A method module has `Parameters` (a validated dataclass), `check(config)` (yields complaints) and
`model(problem, config)` (what the solver needs, built on the operators of `sphstudy.sph`).
"""
