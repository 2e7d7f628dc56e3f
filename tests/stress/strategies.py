"""Overrides, study files and damages of records, made up by hypothesis from parts that might do harm."""

import json

import yaml
from hypothesis import strategies as st

CHEAP = {"scene": "plate", "method": "tl", "n": 5, "h": 1.3, "scene.periods": 0.01}
"""A run of a hundredth of a second."""

POISON = "SPHSTUDY_POISON"
"""An environment variable whose value must turn up nowhere."""

KEYS = (
    "scene", "method", "solve", "h", "n", "seed", "record", "results", "checkpoint", "threads", "retry",
    "time_limit", "memory_limit", "known", "scene.name", "scene.kind", "scene.E", "scene.nu", "scene.L",
    "scene.H0", "scene.periods", "scene.columns", "scene.slenderness", "scene.plane", "method.name",
    "method.kind", "method.kernel", "method.law", "method.hourglass", "solve.name", "solve.courant",
    "method.damping", "solve.integrator", "record.samples", "record.times", "record.frames", "protocol",
    "hydra/launcher", "hydra.launcher.n_jobs", "hydra.run.dir", "hydra.launcher._target_", "hydra",
    "scene._target_", "_target_", "record._target_", "method.viscosity_linear", "hydra/sweeper",
)  # fmt: skip

VALUES = (
    "", "null", "true", "1", "0", "-1", "3", "5", "7", "1.3", "1.5,1.7", "3,5", "nan", "inf", "-inf",
    "1e308", "1e400", "9" * 30, "9" * 5000, "1_0", "0x10", "[1]", "[]", "{}", "{a:1}", "[[[[]]]]",
    "[" * 300 + "]" * 300, "{a:" * 200 + "1" + "}" * 200, "{_target_:os.system,command:id}",
    "{_target_: posix.system, _args_: [id]}", f"${{oc.env:{POISON}}}", "${results}", "${h}", "${",
    "$(touch run_by_a_shell)", "`id`", "; touch run_by_a_shell", "| cat", "a\nb", "\n", "\0", "\t", "'",
    '"', "\\", "../../x", "..", "/", ".", "~", "a/b", "<script>alert(1)</script>", "ä", "日本", "🙂",
    "\u202e", "\ud800", "x" * 300, "range(1,4)", "range(1,1e9)", "range(1,2,0)", "range(3,1)",
    "choice(1,2)", "choice()", "interval(1,2)", "glob(*)", "sort(1,2)", "shuffle(1,2)", "int(1.5)",
    "float(x)", "str(1)", "bool(maybe)", "json_str({a:1})", "extend_list(1)", "tag(a,1)", "plate", "tl",
    "thesis", "mode1", "plate,bending", "explicit", "modes", "problem", "os", "__init__", "stepping",
    "none", "failed", "local", "basic", "slurm", "!!python/object/apply:os.system [id]", "&a", "*a",
    "@", "%", "1.", ".5", "1e-320", "5.0", "4.999999999999999999",
)  # fmt: skip


_text = st.text(st.characters(), max_size=12)
_number = st.one_of(st.integers(), st.floats()).map(str)
_key = st.one_of(st.sampled_from(KEYS), st.sampled_from(KEYS), _text)
_value = st.one_of(st.sampled_from(VALUES), st.sampled_from(VALUES), _number, _text)
_sign = st.sampled_from(("=", "=", "=", "=", "", "+=", "==", "=[", "@x="))
_quantity = st.sampled_from(
    ("h", "n", "seed", "scene.E", "scene.nu", "scene.H0", "scene.rho", "checkpoint", "time_limit",
     "memory_limit", "record.samples", "record.frames", "solve.courant", "method.hourglass", "threads")
)  # fmt: skip
_size = st.one_of(
    st.integers(-1, 12).map(str),
    st.floats(0.0, 3.0, allow_subnormal=False).map(lambda x: f"{x:.4g}"),
    st.sampled_from(("3,5", "range(3,9,2)", "1.3,1.5", "1e3", "[0.1,0.2]", "null", "1_0")),
)
_argument = st.one_of(
    st.builds("{}={}".format, _quantity, _size),
    st.builds(lambda key, sign, value: key + sign + value, _key, _sign, _value),
    st.builds(lambda prefix, key, value: f"{prefix}{key}={value}", st.sampled_from("+~-"), _key, _value),
)
OVERRIDES = st.tuples(
    st.lists(st.sampled_from([f"{key}={value}" for key, value in CHEAP.items()]), unique=True),
    st.lists(_argument, min_size=1, max_size=3),
    st.booleans(),
)


_scalar = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8),
    st.sampled_from([f"${{oc.env:{POISON}}}", "plate", "tl", "tiny", "generated", "[1, 2]", "a.b", "L1"]),
)  # fmt: skip
_known = st.sampled_from(
    ("title", "blocks", "include", "shows", "figures", "claims", "choices", "unstable", "vary",
     "_target_", "skip_invalid", "forbid_diverged", "where", "reason", *KEYS)
)  # fmt: skip
_tree = st.recursive(
    _scalar,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.one_of(_known, _scalar), inner, max_size=4)
    ),
    max_leaves=10,
)
_grid = st.fixed_dictionaries(
    {key: st.just(value) for key, value in CHEAP.items()},
    optional=dict.fromkeys(
        ("seed", "vary", "scene.E", "results", "_target_", "scene.name", "retry"), _tree
    ),
)
_study = st.one_of(
    _tree,
    st.fixed_dictionaries(
        {"title": st.one_of(st.just("t"), _scalar), "blocks": st.dictionaries(st.just("grid"), _grid)},
        optional={"include": _tree, "figures": _tree, "claims": _tree, "unstable": _tree, "x": _tree},
    ),
)
_RAW = st.sampled_from(
    (
        "!!python/object/apply:os.system ['touch run_by_a_shell']",
        "title: !!python/object/apply:os.system ['touch run_by_a_shell']",
        "title: !!python/name:os.system",
        "a: &a [*a]", "&a {title: *a}", "title: &a t\nblocks: &b {grid: *b}",
        "title: t\nblocks: *nowhere",
        "a: &a [1,1,1,1,1,1,1]\nb: &b [*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b]\ntitle: [*c,*c,*c,*c]",
        f"title: t\nblocks: {{g: {{scene: '${{oc.env:{POISON}}}', n: 5}}}}",
        "title: t\nblocks: {g: {scene: plate, n: 5, _target_: os.system}}",
        "title: t\nblocks: {g: {scene: plate, n: 5, vary: {n: ['${n}']}}}",
        "title: t\ninclude: [generated]", "title: t\nblocks: {g: {scene: plate, n: [5, [7]]}}",
        "", "\0", "---\n---\n", "- - -", "{" * 600, "[" * 600, "title: t\ntitle: u", "title: t",
        "title: 2001-01-01", "title: t\nblocks: {g: {n: 2001-01-01}}", "? [a]\n: b", "<<: [1]",
        "title: t\nblocks: {g: {<<: {n: 5}, scene: plate, n: 5}}", "title: <script>alert(1)</script>",
    )
)  # fmt: skip
STUDIES = st.one_of(
    _study.map(lambda tree: yaml.safe_dump(tree, allow_unicode=True).encode("utf-8", "surrogatepass")),
    _study.map(lambda tree: json.dumps(tree, default=str).encode("utf-8", "surrogatepass")),
    _RAW.map(str.encode),
    st.binary(max_size=40),
    st.text(max_size=60).map(lambda text: text.encode("utf-8", "surrogatepass")),
)


DAMAGES = ("directory", "loop", "dangling")
"""What may lie where a record should, and is no file."""


def damages(size: int, foreign: list[str]) -> st.SearchStrategy:
    """What becomes of a record of so many bytes: cut, changed in some bytes, something else, no file."""
    place = st.integers(0, size - 1)
    changes = st.dictionaries(place, st.integers(1, 255), min_size=1, max_size=5)
    return st.one_of(
        st.tuples(st.just("cut"), place),
        st.tuples(st.just("changed"), changes),
        st.tuples(st.just("changed"), changes),
        st.tuples(st.just("foreign"), st.sampled_from(foreign)),
        st.tuples(st.just("bytes"), st.binary(max_size=200)),
        st.tuples(st.just("more"), st.binary(min_size=1, max_size=100)),
        st.tuples(st.sampled_from(DAMAGES), st.none()),
    )
