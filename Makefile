# SPDX-License-Identifier: GPL-3.0-or-later
# Only forwards: to CMake, and to the scripts in .ci and share/examples.

BUILD = build
SANITIZED = build-asan
RACES = build-tsan
CORE = build-core
EXTENSIONS = all
prefix = /usr/local
JOBS = $(shell nproc)
FUZZ_SECONDS = 60
TORTURE_MINUTES = 10
# Newer compilers warn of more than GCC 12 of Debian 12: their warnings do not end a build.
WERROR = $(if $(filter 12 12.%,$(shell $${CXX:-c++} -dumpversion 2>/dev/null)),ON,OFF)

configure = cmake -S . $$(command -v ninja >/dev/null && echo -G Ninja) -Wno-dev -DISPACE_WERROR=$(WERROR) \
	-DISPACE_EXTENSIONS="$(EXTENSIONS)"
build = cmake --build $(1) -j $(JOBS)

.NOTPARALLEL:
.PHONY: all help deps demo experiments check core sanitized races bench fuzz torture format lint install package source-package package-check clean

all: $(BUILD)/configured
	$(call build,$(BUILD))

help:
	@echo "make             build the tools (build/bin), tests and benchmarks"
	@echo "make deps        install the Debian packages of packages.txt"
	@echo "make demo        deps, build, and run the pipeline on a furnished room"
	@echo "make experiments deps, build, and run the thesis' experiments: one report beside its figures"
	@echo "make check       deps, build, formatting, all tests"
	@echo "make core        deps, build of the core without extensions in $(CORE), its tests"
	@echo "make sanitized   deps, build with AddressSanitizer and UBSan, unit and golden tests"
	@echo "make races       deps, build with ThreadSanitizer, tests of threaded code"
	@echo "make bench       deps, build, benchmarks"
	@echo "make fuzz        deps, build with Clang, fuzz each reader and protocol for FUZZ_SECONDS=$(FUZZ_SECONDS)"
	@echo "make torture     deps, build, attack the tools for TORTURE_MINUTES=$(TORTURE_MINUTES) (TORTURE_OPTIONS: see run.py)"
	@echo "make format      reformat the sources with clang-format 14"
	@echo "make lint        rates of words in comments and pages; clang-tidy on changed sources (all with BASE=)"
	@echo "make install     build the tools and install them under prefix=$(prefix), honours DESTDIR"
	@echo "make package     deps, build, Debian packages in $(BUILD)/package, judged by lintian"
	@echo "make source-package"
	@echo "                 the commit as a Debian source package, in $(BUILD)/source-package"
	@echo "make package-check"
	@echo "                 the same, and install and use them on a bare Debian (root rights, debootstrap)"
	@echo "make clean       remove $(BUILD), $(CORE), $(SANITIZED), $(RACES), build-fuzz"

deps:
	@.ci/deps build check lint

demo:
	@.ci/deps build
	@$(MAKE) --no-print-directory $(BUILD)/configured
	$(call build,$(BUILD)) --target tools manual
	@PATH="$$PWD/$(BUILD)/bin:$$PATH" share/examples/demo.sh $(BUILD)/demo

experiments:
	@.ci/deps build experiments
	@$(MAKE) --no-print-directory $(BUILD)/configured
	$(call build,$(BUILD)) --target tools examples
	@share/experiments/run.py --build $(BUILD) -o $(BUILD)/experiments

check:
	@.ci/deps build experiments package check
	@.ci/format --check
	@$(MAKE) --no-print-directory all
	@.ci/validator $(BUILD)/npm
	@.ci/tests $(BUILD) $(JOBS)

core:
	@.ci/deps build check
	@$(MAKE) --no-print-directory BUILD=$(CORE) EXTENSIONS= $(CORE)/configured
	$(call build,$(CORE))
	@.ci/tests $(CORE) $(JOBS) -L core

sanitized:
	@.ci/deps build check
	@$(MAKE) --no-print-directory $(SANITIZED)/configured
	$(call build,$(SANITIZED))
	@.ci/sanitized $(SANITIZED) $(JOBS)

races:
	@.ci/deps build check
	@$(MAKE) --no-print-directory $(RACES)/configured
	$(call build,$(RACES)) --target races
	@.ci/races $(RACES)

bench:
	@.ci/deps build check
	@$(MAKE) --no-print-directory $(BUILD)/configured
	$(call build,$(BUILD)) --target tools benchmarks
	@.ci/validator $(BUILD)/npm
	@tests/bench/run.sh $(BUILD)

fuzz:
	@.ci/deps build check
	@.ci/fuzz $(FUZZ_SECONDS)

torture:
	@.ci/deps build check
	@$(MAKE) --no-print-directory $(BUILD)/configured
	$(call build,$(BUILD)) --target tools
	@tests/torture/run.py --build $(BUILD) --minutes $(TORTURE_MINUTES) $(TORTURE_OPTIONS)

format:
	@.ci/deps check
	@.ci/format

lint:
	@.ci/deps build lint
	@$(MAKE) --no-print-directory $(BUILD)/lint/configured
	@.ci/prose
	@.ci/lint $(BUILD)/lint $(JOBS) $(BASE)

install:
	@$(MAKE) --no-print-directory $(BUILD)/configured
	$(call build,$(BUILD)) --target tools manual schemas completions
	DESTDIR="$(DESTDIR)" cmake --install $(BUILD) --prefix "$(prefix)"

package:
	@.ci/deps build package
	@$(MAKE) --no-print-directory $(BUILD)/configured
	$(call build,$(BUILD)) --target tools manual schemas completions
	@.ci/package $(BUILD)

source-package:
	@.ci/deps package
	@.ci/package --source $(BUILD)/source-package

package-check: package
	@.ci/deps check
	@.ci/package-test $(BUILD) || [ $$? -eq 77 ]

clean:
	rm -rf $(BUILD) $(CORE) $(SANITIZED) $(RACES) build-fuzz

# Holds EXTENSIONS: another choice configures anew.
ifneq ($(EXTENSIONS),$(shell cat $(BUILD)/configured 2>/dev/null || echo "$(EXTENSIONS)"))
.PHONY: $(BUILD)/configured
endif
$(BUILD)/configured:
	$(configure) -B $(BUILD) -DCMAKE_BUILD_TYPE=Release
	@echo "$(EXTENSIONS)" >$@

# The compile database of clang-tidy names each source.
$(BUILD)/lint/configured:
	$(configure) -B $(BUILD)/lint -DISPACE_UNITY=OFF
	@touch $@

$(SANITIZED)/configured:
	$(configure) -B $(SANITIZED) -DISPACE_SANITIZE=ON
	@touch $@

$(RACES)/configured:
	$(configure) -B $(RACES) -DISPACE_SANITIZE=thread
	@touch $@
