# Every task of the project; `make` lists them. All of it runs in .venv, made on first use.

PYTHON ?= python3
PRESET ?=
TESTS ?=
BOARD ?= ulx3s-85f
SEED ?= 1
ARGS ?=

VENV := .venv
BIN := $(VENV)/bin
LOCKED := $(VENV)/.locked
READY := $(VENV)/.ready
SOURCES := softdepth golden hdl sim tests examples
DEMO := out/motorcycle
# Motorcycle's calibration, as scikit-image's documentation gives it
CAMERAS := --focal 994.978 --baseline 0.193001 --doffs 31.086 --principal 311.193 254.877

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help demo test test-fast test-full soak formal mutation coverage bench compare accuracy paper inspections bitstream boards program utilization savings pixel-a-clock lint format types docs lock export reading registers readme clean distclean preflight

help: ## list these tasks
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-11s %s\n", $$1, $$2 }' Makefile

demo: $(READY) ## the Motorcycle pair through the gateware; pictures in out/motorcycle
	@$(BIN)/softdepth run --dataset motorcycle --preset $(or $(PRESET),robust) --also float,paper,sad $(CAMERAS) -o $(DEMO)
	@echo "left, right and depth: $(CURDIR)/$(DEMO)/overview.png"
	@echo "points to turn with the mouse: $(CURDIR)/$(DEMO)/view.html"

test: $(READY) ## the whole test suite (a part of it: make test TESTS=tests/golden)
	@$(BIN)/pytest -n auto --dist worksteal $(TESTS)

test-fast: $(READY) ## the tests that take seconds
	@$(BIN)/pytest -n auto --dist worksteal -m "not slow and not full" $(TESTS)

test-full: $(READY) ## what is too long for every day: whole Middlebury frames with every operator
	@$(BIN)/pytest -n auto --dist worksteal -m full $(TESTS)

# Another number: make soak FRAMES=100.
soak: $(READY) ## 1,000 random frames through the AXI core, registers written in mid-frame
	@SOFTDEPTH_SOAK=$(or $(FRAMES),1000) $(BIN)/pytest -q tests/axi -k random_frames

formal: $(READY) ## every proof, at its full depth: docs/verification.md says of what
	@$(BIN)/python -m tests.formal -n auto --dist worksteal $(ARGS)

mutation: $(READY) ## faults in small cores, and which the quick regression finds: docs/verification.md
	@$(BIN)/python -m tests.mutation

coverage: $(READY) ## lines and bits of small cores that the quick regression reaches: docs/verification.md
	@$(BIN)/python -m tests.cover

bench: $(READY) ## measure speed and write docs/benchmarks.md
	@$(BIN)/softdepth bench

# Middlebury's images: in the folder that SOFTDEPTH_DATA names, or downloaded.
paper: $(READY) ## the paper's tables and pictures: out/paper, docs/paper.md
	@$(BIN)/softdepth paper -o out/paper --document docs/paper.md

# Scenes with known depth: in the folder that SOFTDEPTH_SCENES names.
inspections: $(READY) ## how often softdepth inspect is right: docs/inspect.md
	@$(BIN)/python -m softdepth.studies.inspections

# Folders of scenes in SOFTDEPTH_SCENES and SOFTDEPTH_DATA; ARGS="--leave-out NAME" for what shall not count.
# qPianoL is qPiano's room under another light: left out, so that it does not count twice.
accuracy: $(READY) ## presets and OpenCV on scenes with known depth: docs/accuracy.md
	@$(BIN)/softdepth evaluate $(if $(SOFTDEPTH_SCENES),--scenes "$(SOFTDEPTH_SCENES)") \
		$(if $(SOFTDEPTH_DATA),--scenes "$(SOFTDEPTH_DATA)") \
		$(if $(wildcard $(SOFTDEPTH_SCENES)/qPianoL),--leave-out qPianoL) \
		--degraded --fuzzy --ablation --document docs/accuracy.md $(ARGS)

compare: $(READY) ## hardware against float model on Middlebury: docs/compare.md, docs/operators.md
	@for method in "paper mean" "paper min" "compact mean" "lite mean"; do set -- $$method; \
		for pair in teddy cones venus; do \
			$(BIN)/softdepth compare --dataset middlebury:$$pair --preset $$1 --operator $$2 \
				-o out/compare/$$pair-$$1-$$2 || exit; \
		done; \
	done
	@$(BIN)/python -m softdepth.studies.compare.document out/compare

savings: $(READY) ## what savings of area and kinds of cost come to in a lane: docs/area.md
	@$(BIN)/python -m softdepth.studies.savings
	@$(BIN)/python -m softdepth.studies.fuzzy_lanes

pixel-a-clock: $(READY) ## what robust would take at one clock per pixel: docs/area.md
	@$(BIN)/python -m softdepth.studies.pixel_a_clock

lint: $(READY) ## style, likely bugs and formatting
	@$(BIN)/ruff check $(SOURCES)
	@$(BIN)/ruff format --check $(SOURCES)

format: $(READY) ## format the sources in place
	@$(BIN)/ruff check --fix $(SOURCES)
	@$(BIN)/ruff format $(SOURCES)

# The folders map to import names through setuptools, which pyright does not see: it gets a view of
# the package as it is installed.
VIEW := build/types/softdepth
types: $(READY) ## static types
	@rm -rf $(VIEW) && mkdir -p $(VIEW)
	@ln -s $(CURDIR)/softdepth/* $(CURDIR)/golden $(CURDIR)/hdl $(CURDIR)/sim $(VIEW)
	@$(BIN)/pyright --pythonpath $(BIN)/python

docs: $(READY) ## the documentation as a site: build/site/index.html
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --config-file scripts/mkdocs.yml

lock: $(LOCKED) ## pin every dependency anew (newer ones: make lock ARGS=--upgrade)
	@$(BIN)/uv pip compile pyproject.toml --group dev --group build --universal --python-version 3.11 \
		--generate-hashes --no-emit-index-url --no-annotate --quiet \
		--custom-compile-command "make lock" --output-file requirements.lock $(ARGS)

export: $(READY) ## the core as Verilog in out/ (another preset: make export PRESET=lite)
	@mkdir -p out
	@$(BIN)/softdepth export --preset $(or $(PRESET),paper) -o out/softdepth_$(or $(PRESET),paper).v

# A core of your own: make bitstream BOARD=... ARGS="--preset lite --lanes 8".
bitstream: $(READY) ## a board's bitstream in out/BOARD (another: make bitstream BOARD=icebreaker)
	@$(BIN)/softdepth build --board $(BOARD) --seed $(SEED) $(ARGS) -o out/$(BOARD)

boards: $(READY) ## the bitstreams of all boards, and the table in docs/flow.md
	@for board in `$(BIN)/python -c "from softdepth.spec.boards import BOARDS; print(*BOARDS)"`; do \
		$(BIN)/softdepth build --board $$board --seed $(SEED) -o out/$$board || exit; \
	done
	@$(BIN)/python -m softdepth.studies.boards_page out

program: $(READY) ## load the bitstream into the board that is plugged in, built before if need be
	@$(BIN)/softdepth build --board $(BOARD) --seed $(SEED) $(ARGS) -o out/$(BOARD) --program

# Hours at first; a netlist that was measured before is not again. A part of it: ARGS=--quick.
utilization: $(READY) ## measure area and speed: docs/utilization.md
	@$(BIN)/softdepth utilization $(ARGS)

reading: $(READY) ## exported cores read by yosys: the table in docs/flow.md
	@$(BIN)/python -m softdepth.studies.reading

registers: $(READY) ## the registers of the core with AXI streams: docs/axi.md
	@$(BIN)/python -m softdepth.studies.registers_page

readme: demo ## renew the figures and the picture in README.md from the demo's results
	@$(BIN)/python -m softdepth.studies.readme $(DEMO)

clean: ## remove builds and results
	rm -rf build dist out .pytest_cache .ruff_cache *.egg-info
	find $(SOURCES) -name __pycache__ -prune -exec rm -rf {} +

distclean: clean ## remove the environment as well
	rm -rf $(VENV)

preflight:
	@scripts/preflight.sh $(PYTHON)

$(LOCKED): requirements.lock | preflight
	@echo "making $(VENV) from requirements.lock"
	@scripts/venv.sh $(VENV) $(PYTHON)
	@touch $@

$(READY): $(LOCKED) pyproject.toml | preflight
	@$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@
