# `make demo` and `make test` install what they need (Debian 12), build, and run. `make help` lists the rest.
BUILD ?= build
JOBS ?= $(shell nproc)
CMAKE_FLAGS ?=
DEMO_RUN ?= runs/demo

.PHONY: help demo test build deb bench faults format check-format lint lint-changed asan asan-readers tsan fuzz docs install clean
help:
	@echo "make demo     install, compile what a flight needs, generate a cave, fly a mission through it, write the report"
	@echo "make build    install, compile all of karst"
	@echo "make test     install, build, run every test"
	@echo "make bench    benchmarks: ratios against stock OctoMap, NLopt and the naive way"
	@echo "make faults   FAULT_TRIALS=1000 short flights with one fault each, resumable (docs/fault_campaign.md)"
	@echo "make format   clang-format on every source file;  make lint  checks format and tidiness"
	@echo "make lint-changed  the tidiness of what a branch changes;  make asan-readers  what reads files, under ASan and UBSan"
	@echo "make asan     unit tests under AddressSanitizer and UBSan;  make tsan  under ThreadSanitizer"
	@echo "make fuzz     every reader of files under libFuzzer, FUZZ_SECONDS=30 each"
	@echo "make docs     the documentation as a site with search and the reference of the headers; no dead links"
	@echo "make install  into PREFIX (/usr/local)"
	@echo "make deb      Debian packages karst, karst-sdk, karst-python and karst-doc, in $(BUILD)/packages (docs/install.md)"

build:
	@.ci/install build
	@cmake -S . -B $(BUILD) -G Ninja -DKARST_TESTS=OFF -DKARST_FLIGHT_ONLY=OFF $(CMAKE_FLAGS) >/dev/null
	@cmake --build $(BUILD) -j $(JOBS)

demo:
	@.ci/demo $(BUILD) $(DEMO_RUN) $(JOBS) $(CMAKE_FLAGS)

deb: build
	@.ci/install deb
	@.ci/deb $(BUILD)

WITH_TESTS = -DKARST_TESTS=ON -DKARST_FLIGHT_ONLY=OFF
test:
	@.ci/install test
	@cmake -S . -B $(BUILD) -G Ninja $(WITH_TESTS) $(CMAKE_FLAGS) >/dev/null
	@cmake --build $(BUILD) -j $(JOBS)
	@.ci/ctest $(BUILD)

bench:
	@.ci/install test
	@cmake -S . -B $(BUILD) -G Ninja $(WITH_TESTS) $(CMAKE_FLAGS) >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target benchmarks
	@.ci/bench $(BUILD)

FAULT_TRIALS ?= 1000
FAULT_RUNS ?= runs/faults
faults:
	@.ci/install test
	@cmake -S . -B $(BUILD) -G Ninja $(WITH_TESTS) $(CMAKE_FLAGS) >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target fault_campaign
	@$(BUILD)/bin/fault_campaign --out $(FAULT_RUNS) --trials $(FAULT_TRIALS) --jobs $(JOBS) \
	  --build $$(git rev-parse --short HEAD)

SOURCES = $$(git ls-files '*.h' '*.hpp' '*.c' '*.cpp')
format:
	@clang-format -i $(SOURCES)
check-format:
	@clang-format --dry-run -Werror $(SOURCES)
# Apart from the build: clang-tidy cannot read the precompiled headers of g++, and so sees every include that is missing.
LINT_CMAKE = cmake -S . -B build-lint -G Ninja -DKARST_TESTS=OFF -DKARST_PCH=OFF
lint:
	@.ci/install test
	@$(MAKE) check-format
	@$(LINT_CMAKE) -DKARST_UNITY=ON >/dev/null
	@.ci/tidy build-lint
lint-changed:
	@.ci/install test
	@$(LINT_CMAKE) -DKARST_UNITY=OFF >/dev/null
	@.ci/tidy build-lint changed

# With clang, which compiles these checks in two thirds of the time g++ takes; the fuzzers share the build.
ASAN_CMAKE = CC=clang CXX=clang++ cmake -S . -B build-asan -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DKARST_SANITIZE=fuzzer-no-link,address,undefined
asan:
	@.ci/install test
	@$(ASAN_CMAKE) >/dev/null
	@cmake --build build-asan -j $(JOBS)
	@.ci/ctest build-asan -LE flight
# What reads files of others, and compiles soon.
READERS = common_test replay_test bag_test simulator_cave_test
asan-readers:
	@.ci/install test
	@$(ASAN_CMAKE) >/dev/null
	@cmake --build build-asan -j $(JOBS) --target $(READERS)
	@for test in $(READERS); do build-asan/bin/$$test --gtest_brief=1 || exit 1; done
tsan:
	@.ci/install test
	@cmake -S . -B build-tsan -G Ninja -DKARST_SANITIZE=thread -DCMAKE_BUILD_TYPE=RelWithDebInfo >/dev/null
	@cmake --build build-tsan -j $(JOBS)
	@.ci/ctest build-tsan -LE flight

FUZZ_SECONDS ?= 30
fuzz:
	@.ci/install test
	@$(ASAN_CMAKE) >/dev/null
	@cmake --build build-asan -j $(JOBS) --target fuzzers
	@.ci/fuzz build-asan $(FUZZ_SECONDS)

docs:
	@.ci/install docs
	@docs/site/build.py $(BUILD)/site

PREFIX ?= /usr/local
install: build
	@cmake --install $(BUILD) --prefix $(PREFIX)
clean:
	@rm -rf $(BUILD) build-asan build-tsan build-lint
