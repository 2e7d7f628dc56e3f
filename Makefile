# Two commands do all the set-up: `make study` and `make test`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready

.PHONY: study test test-slow check lock clean

study: $(READY)  ## environment, then the main job: the mode I grid of the thesis
	$(BIN)/python -m sphstudy -m h=1.3,1.5,1.7,1.9 n=40,50,60

test: $(READY) check  ## lint, types, default tests
	NUMBA_DISABLE_JIT=1 $(BIN)/python -m pytest tests/numerics/sph -m 'not slow and not compiled' --quiet
	$(BIN)/python -m pytest --numprocesses 2 --dist loadfile

test-slow: $(READY)  ## the tests that take minutes
	$(BIN)/python -m pytest -m slow --numprocesses 2 --dist worksteal

check: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

$(READY): pyproject.toml requirements.lock
	$(PYTHON) -c 'import sys; sys.exit(None if (3, 11) <= sys.version_info[:2] <= (3, 13) else "Python 3.11 to 3.13 needed, this is " + sys.version)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint requirements.lock --editable '.[dev]'
	touch $(READY)

lock:  ## versions of a fresh environment become the locked ones
	rm -rf $(VENV)
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	$(BIN)/python -m pip freeze --exclude-editable --exclude sphstudy > requirements.lock

clean:
	rm -rf $(VENV) build dist
