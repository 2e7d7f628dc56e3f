#!/bin/bash
# The cluster launcher against a real SLURM, on one Debian machine, as root:
#
#   tests/running/slurm/trial.sh                     eight small points of the mode I grid, some nine minutes
#   tests/running/slurm/trial.sh thesis              the twelve points of the thesis
#   tests/running/slurm/trial.sh small timeout       some of the cases only (they are listed in trial.py)
#
# Installs slurm-wlm and munge if need be, starts a cluster of two nodes of one core each in a temporary
# folder, runs trial.py against it, and takes all of it down again. The transcript goes to stdout.
# Exit status 0: everything held. PYTHON names the interpreter (default: .venv/bin/python).
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
python=${PYTHON:-$root/.venv/bin/python}
MAX_ARRAY=10001
. "$here/slurm.sh"

[ "$(id -u)" = 0 ] || { echo "trial.sh: has to be root, to install and to start SLURM" >&2; exit 2; }
work=$(mktemp -d /tmp/sphstudy-trial-XXXXXX)
export PYTHONPATH="$root${PYTHONPATH:+:$PYTHONPATH}"
# Nodes and this machine keep their compiled code here, not where that of others lies: each compiles.
export TMPDIR="$work/tmp" XDG_CACHE_HOME="$work/cache"
mkdir "$TMPDIR"

take_down() {
    stop_cluster || true
    rm -rf "$work"
    echo "taken down: $(pgrep --full "$work" | wc -l) processes are left"
}
trap take_down EXIT

install_slurm
"$python" -c 'import submitit' 2>/dev/null || {
    "$python" -m pip install --quiet --disable-pip-version-check --target "$work/site" 'submitit>=1.5,<1.6'
    export PYTHONPATH="$PYTHONPATH:$work/site"
}
start_cluster "$work/cluster"
"$python" "$here/trial.py" "$work" "${@:-small}"
