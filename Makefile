# Shortcuts for common tasks, which `make` lists. CMakePresets.json and scripts/ do the work.
# `make JOBS=2 ...` limits the number of compilers at once, `make PYTHON=...` chooses an interpreter.
PREFIX ?= /usr/local

.DEFAULT_GOAL := help
.PHONY: help setup build demo test combinations validate bench docs format format-check lint \
        asan tsan portable install clean view

help:  ## list these targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  \1|\2/p' Makefile | column -t -s '|'

setup:  ## install the Debian packages of all targets (root or sudo); each installs its own otherwise
	@scripts/setup.sh

build:  ## optimised build: build/release/bin/sinew and build/release/python
	@scripts/setup.sh build
	@scripts/build.sh release sinew sinew_python

demo:  ## a soft trunk follows a circle by inverse control: a table and a picture
	@scripts/setup.sh demo
	@scripts/build.sh release sinew sinew_python
	@scripts/demo.sh

view: build  ## the trunk follows its circle in the browser
	@build/release/bin/sinew view examples/trunk/circle.yaml

test:  ## build, and run all C++ and Python tests
	@scripts/test.sh release

combinations:  ## 5000 random scenes of features beside each other, each in a process of its own
	@scripts/setup.sh test
	@scripts/build.sh release -DSINEW_TESTS=ON combinations
	@build/release/bin/combinations --pairs
	@build/release/bin/combinations --count 5000

validate:  ## numbers against their references: docs/scorecard.md
	@scripts/setup.sh validate
	@scripts/build.sh release sinew sinew_python
	@build/release/bin/sinew validate

bench:  ## the time of a step, stage by stage, beside other solvers
	@scripts/bench.sh

docs: build  ## the site in build/docs/html: guides, references of scenes, Python and C++
	@scripts/docs.sh

format:  ## format all C++ sources in place
	@scripts/format.sh

format-check:  ## fail when a C++ source is not formatted
	@scripts/format.sh --check

lint: format-check  ## format check and clang-tidy on all C++ sources
	@scripts/lint.sh

asan:  ## build and run the C++ tests with the address and undefined-behaviour sanitizers
	@scripts/test.sh asan

tsan:  ## build and run the C++ tests with the thread sanitizer
	@scripts/test.sh tsan

portable:  ## build and run all tests without this machine's own instruction set
	@scripts/test.sh portable

install: build  ## install to PREFIX (/usr/local)
	@cmake --install build/release --prefix $(PREFIX)

clean:  ## remove everything built
	@rm -rf build dist
