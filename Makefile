# Everything needs only Python 3.11 or newer and make; the rest goes into .venv.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

.PHONY: run test bench faults soak fuzz exam exam-peers lint clean

run: $(VENV)/installed
	$(BIN)/gripperd run

# Many tests wait for processes; those of one file share what it started. Threads for
# their small matrices would take the cores from each other.
test: export OPENBLAS_NUM_THREADS = 1
test: $(VENV)/developing
	$(BIN)/pytest --numprocesses 3 --dist loadfile

# All of them, unless ONLY names some, such as physics, bus, diagnosis or footprint.
bench: $(VENV)/developing
	$(BIN)/python -m tests.benchmarks $(ONLY)

# Every fault, injected for real, and how long it takes to tell.
faults: $(VENV)/developing
	$(BIN)/python -m tests.faults $(ONLY)

# N grasps with mishaps, from the first SEED on, in the time of the simulated rig.
soak: $(VENV)/developing
	$(BIN)/python -m tests.soak

# N inputs in all, a million unless told otherwise.
fuzz: $(VENV)/developing
	$(BIN)/python -m tests.fuzz $(N)

# CASES, FAMILY (A, B, both), JOBS, SEED and RESULTS (JSON lines) are variables.
EXAM = $(if $(CASES),--cases $(CASES)) $(if $(FAMILY),--family $(FAMILY)) \
	$(if $(JOBS),--jobs $(JOBS)) $(if $(SEED),--seed $(SEED)) \
	$(if $(RESULTS),--results $(RESULTS))

exam: $(VENV)/developing
	$(BIN)/python -m tests.exam $(EXAM)

exam-peers: $(VENV)/examining
	$(BIN)/python -m tests.exam.peers $(EXAM)

lint: $(VENV)/developing
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

clean:
	rm -rf $(VENV) build dist reproduction

$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(PIP) install --upgrade pip
	$(PIP) install --editable '.[reproduce]'
	touch $@

# Dependency groups need the newer pip that the first stamp has installed.
$(VENV)/developing: $(VENV)/installed
	$(PIP) install --group dev
	touch $@

$(VENV)/examining: $(VENV)/developing
	$(PIP) install --group exam
	touch $@
