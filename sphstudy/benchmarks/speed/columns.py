"""Variables of the dataset of `sphstudy speed`: name, units, long_name, attribute of a measurement."""

Column = tuple[str, str, str, str]

RATES: tuple[Column, ...] = (
    ("rate_group", "1", "part of the study that the case belongs to", "case.group"),
    ("rate_method", "1", "method", "method"),
    ("rate_scene", "1", "scene", "scene"),
    ("rate_arrangement", "1", "lattice, perturbed, or shuffled: random order too", "case.arrangement"),
    ("rate_term", "1", "term of the method that is varied", "case.term"),
    ("rate_variant", "1", "all terms, one off, one never there, or none", "case.variant"),
    ("rate_settings", "1", "settings of the configuration", "overrides"),
    ("rate_wrong", "1", "why the system could not be timed", "wrong"),
    ("rate_h", "1", "relative smoothing radius", "h"),
    ("rate_n", "1", "resolution", "n"),
    ("particles", "1", "particles", "particles"),
    ("pairs", "1", "unordered pairs of neighbours held", "pairs"),
    ("interacting_pairs", "1", "unordered pairs within the support at the start", "interacting"),
    ("evaluations", "1", "evaluations of the right-hand side in a step", "evaluations"),
    ("turn_steps", "1", "steps of one turn", "steps"),
    ("step_time", "s", "CPU time of a step, median of the rounds", "step_seconds"),
    ("step_time_spread", "1", "distance between the quartiles over the median", "spread"),
    ("pair_time", "ns", "CPU time per unordered pair held and evaluation", "pair_time"),
    ("directed_pair_time", "ns", "the same per directed pair", "directed_pair_time"),
    ("interacting_pair_time", "ns", "the same per pair in the support", "interacting_pair_time"),
    ("particle_steps", "s-1", "particles times steps per CPU second", "particle_steps"),
)

SCALINGS: tuple[Column, ...] = (
    ("scaling_workers", "1", "threads or processes", "workers"),
    ("speedup", "1", "wall time with one worker over that with two, median", "speedup"),
    ("control_speedup", "1", "that ratio for arithmetic without memory", "control_speedup"),
)

STARTS: tuple[Column, ...] = (
    ("start_method", "1", "method", "method"),
    ("start_n", "1", "rows of the plate", "n"),
    ("start_cold", "1", "whether nothing was compiled before", "cold"),
    ("start_particles", "1", "particles", "particles"),
    ("load_time", "s", "CPU time until Python and the program are loaded", "load_seconds"),
    ("first_step_time", "s", "CPU time of the process until the first step is made", "step_seconds"),
    ("start_compile_time", "s", "CPU time spent compiling until then", "compile_seconds"),
    ("peak_memory", "Mbyte", "peak memory of the process", "peak_megabytes"),
)

RUNS: tuple[Column, ...] = (
    ("run_settings", "1", "settings of the run", "settings"),
    ("run_outcome", "1", "outcome of the last round", "outcome"),
    ("run_time", "s", "CPU time of a run without compilation, median of the rounds", "median"),
)

BOUNDS: tuple[Column, ...] = (
    ("bound_meaning", "1", "what is bounded", "bound.meaning"),
    ("bound_at_least", "1", "whether it should be no smaller", "bound.at_least"),
    ("bound_units", "1", "units of bound and measurement", "bound.units"),
    ("bound_value", "1", "bound, in bound_units", "bound.value"),
    ("bound_measured", "1", "measurement, in bound_units", "measured"),
    ("bound_ratio", "1", "measurement over bound", "ratio"),
    ("bound_remark", "1", "what else has to be known to judge it", "remark"),
)

PARTS: tuple[Column, ...] = (
    ("part_cpu_time", "s", "CPU time of measuring the part", "cpu_seconds"),
    ("part_compile_time", "s", "of this, compiling in the measuring process", "compile_seconds"),
    ("part_wall_time", "s", "wall time of measuring the part", "wall_seconds"),
)
