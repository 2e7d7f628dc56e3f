"""What is simulated. A scene is a file in conf/scene; its `kind` is the name of a module here.

A module has

`Parameters`
    a class of parameters, the section `scene` of the file; its properties and methods say what follows
    from them for whoever measures or draws the scene;
`check(config)`
    yields complaints about resolution and geometry, one line each, naming key, value and what is allowed;
`particles(config)`
    number of particles, without building them;
`build(config)`
    the Problem.

`config` is the RunConfig of a run. The file says beside that which metrics measure the scene, what tables
show of it, which settings it asks for with each method and solver, and what a sound run of it keeps.
"""
