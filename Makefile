# Shortcuts for common tasks, which `make` lists. CMakePresets.json and scripts/ do the work.
# `make JOBS=2 ...` limits the number of compilers at once, `make PYTHON=...` chooses an interpreter.
# `make examples PRESET=portable` uses the build for any x86-64-v2 machine.
PREFIX ?= /usr/local
PRESET ?= release

.DEFAULT_GOAL := help
.PHONY: help setup build demo test combinations validate examples bench docs format format-check lint \
        asan tsan portable install clean view

help:  ## list the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  \1|\2/p' Makefile | column -t -s '|'

setup:  ## install the Debian packages for all targets, as root or with sudo (each target installs its own as well)
	@scripts/setup.sh

build:  ## build the program and the Python package: build/release/bin/sinew, build/release/python
	@scripts/setup.sh build
	@scripts/build.sh release sinew sinew_python

demo:  ## steer a soft trunk along a circle by inverse control; print a table and draw a picture
	@scripts/setup.sh demo
	@scripts/build.sh release sinew_python
	@scripts/demo.sh

view: build  ## watch and steer the trunk in the browser
	@build/release/bin/sinew view examples/trunk/circle.yaml

test:  ## build and run all C++ and Python tests
	@scripts/test.sh release

combinations:  ## try 7000 random scenes that combine features, each in its own process
	@scripts/setup.sh test
	@scripts/build.sh release -DSINEW_TESTS=ON combinations
	@build/release/bin/combinations --pairs
	@build/release/bin/combinations --count 5000
	@build/release/bin/combinations --symmetric --count 1000
	@build/release/bin/combinations --changed --count 1000

validate:  ## compare results with references; writes docs/scorecard.md
	@scripts/setup.sh validate
	@scripts/build.sh release sinew sinew_python
	@build/release/bin/sinew validate

examples:  ## run all scenes and scripts of examples/ and check their figures; PRESET=portable: with that build
	@scripts/setup.sh sweep validate
	@scripts/build.sh $(PRESET) sinew sinew_python
	@$(or $(PYTHON),/usr/bin/python3) validation/examples.py --build build/$(PRESET) $(if $(JOBS),--jobs $(JOBS))

bench:  ## measure the time of a step by stage, and compare solvers
	@scripts/bench.sh

docs: build  ## build the site in build/docs/html: guides, and references of scenes, Python and C++
	@scripts/docs.sh

format:  ## format all C++ sources in place
	@scripts/format.sh

format-check:  ## fail if a C++ source is not formatted
	@scripts/format.sh --check

lint: format-check  ## check the format, run clang-tidy on all C++ sources and Doxygen on their headers
	@scripts/lint.sh

asan:  ## build and run the C++ tests with the address and undefined-behaviour sanitizers
	@scripts/test.sh asan

tsan:  ## build and run the C++ tests with the thread sanitizer
	@scripts/test.sh tsan

portable:  ## build for x86-64-v2 and run all tests
	@scripts/test.sh portable

install: build  ## install to PREFIX (/usr/local)
	@cmake --install build/release --prefix $(PREFIX)

clean:  ## remove the build folder
	@rm -rf build dist
