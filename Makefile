# Everything runs in a virtual environment that is made on first use. Another Python: make PYTHON=/path/to/python3.13
PYTHON ?= python3
ENVIRONMENT ?= .venv
RUN = $(ENVIRONMENT)/bin/python
MESH ?=
OUTPUT ?= demo
DATA ?=
NAMES ?=
FILES ?=
SHARE ?= 1
DRAW ?=
FOLDER ?=

.PHONY: help environment demo pictures bench check test test-long lint package repository listing test-matrix test-window clean

help:  ## this list
	@sed -n 's/^\([a-z-]*\):.*## /  make \1  /p' $(MAKEFILE_LIST)

environment:
	@$(PYTHON) tools/environment.py $(ENVIRONMENT)

demo: environment  ## segment the example character, or MESH=path, into pictures, a .blend and a report in demo/
	@$(RUN) tools/demo.py $(if $(MESH),--mesh "$(MESH)") --output "$(OUTPUT)"

pictures: environment  ## the pictures of the documentation, or NAMES="levels.gif way.png"; DATA=folder for those of other meshes
	@OPENBLAS_NUM_THREADS=1 $(RUN) -m tools.pictures $(if $(DATA),--data "$(DATA)") $(NAMES)

bench: environment  ## quick benchmarks, or NAMES="topology slider"; DATA=folder for all of them in full; tables in demo/bench/
	@$(RUN) -m pip install -qq --disable-pip-version-check -r benchmarks/requirements.txt || echo "Some peers are missing."
	@$(RUN) tools/bench.py $(if $(DATA),--data "$(DATA)") $(NAMES)

check: environment  ## in under a minute: linters, and the tests that a change touches, or those of FILES="compute/fem/space.py"
	@$(RUN) tools/check.py $(FILES)

test: environment  ## engine tests and Blender tests
	@OPENBLAS_NUM_THREADS=1 $(RUN) -m pytest -q --numprocesses auto -m "not long"

test-long: environment  ## random and repeated tests at length; SHARE=0.2 for a fifth, drawn by the commit or by DRAW=name
	@OPENBLAS_NUM_THREADS=1 $(RUN) -m pytest -q --numprocesses auto -m long --share=$(SHARE) $(if $(DRAW),--draw="$(DRAW)")

lint: environment  ## ruff and mypy
	@$(RUN) -m ruff check .
	@$(RUN) -m ruff format --check .
	@$(RUN) -m mypy

package: environment  ## one installable zip for each platform in dist/
	@$(RUN) tools/package.py

repository: environment  ## a repository of the zips for a server or shared folder, in dist/repository or FOLDER=path
	@$(RUN) tools/repository.py $(if $(FOLDER),"$(FOLDER)")

listing: environment  ## icon, pictures and description for the extension site in dist/listing; NAMES="icon.png bones.png" for some
	@OPENBLAS_NUM_THREADS=1 $(RUN) -m tools.listing $(NAMES)

test-matrix: package  ## tests and zip on every supported Blender and newest numpy, or VERSIONS="4.2.23 5.2.3-newest"
	@$(RUN) tools/test_matrix.py $(VERSIONS)

test-window: environment  ## the zip in the real Blender application, on a screen of its own; pictures in demo/window
	@$(RUN) tools/test_window.py

clean:  ## everything the other targets made
	rm -rf $(ENVIRONMENT) .environments .*_cache dist demo wheels
