# Steadfast. `make deps run` shows the demo, `make deps test` proves the library; `make help` lists the rest.

# ---- settings: set them on the command line ------------------------------------------------------------------------------

PREFIX     = /usr/local
LIBDIR     = $(PREFIX)/lib
INCLUDEDIR = $(PREFIX)/include
DESTDIR    =

OPTIMISE   = -O3
SAN        =# SAN=1: with the address and undefined-behaviour sanitizers
WERROR     =# WERROR=1: a warning fails the build
V          =# V=1: show the commands
ALSO       =# deps: further groups to install, e.g. ALSO=clang

# ---- what is built from what -----------------------------------------------------------------------------------------------

VERSION := $(shell sed -n 's/^.define STF_VERSION_[A-Z]* *//p' include/steadfast/base.h | paste -s -d . -)
MAJOR   := $(firstword $(subst ., ,$(VERSION)))

MODE  := $(if $(SAN),sanitize,release)
BUILD := build/$(notdir $(firstword $(CC)))-$(MODE)

# What holds no reals exists once; all else is compiled for float and for double.
ONCE_SOURCES  := src/allocator.c src/checksum.c src/clock.c src/result.c src/sort.c src/stability/eigen.c
ONCE_SOURCES  += $(addprefix src/trade/,extrapolation.c path.c pick.c reference.c timing.c)
TWICE_SOURCES := $(filter-out $(ONCE_SOURCES),$(wildcard src/*.c src/*/*.c))
SCENE_SOURCES := $(wildcard demo/scenes/*.c)

# The hot files once more for each instruction set that the compiler has; the world picks one at run time (src/variant.h).
HOT_SOURCES  := src/kernels.c $(wildcard src/integrators/*.c src/forces/*.c)
FLAGS_avx2   := -mavx2
FLAGS_avx512 := -mavx512f -mavx512vl -mavx512bw -mavx512dq -mprefer-vector-width=512
has           = $(shell $(CC) $(1) -E -x c /dev/null >/dev/null 2>&1 && echo yes)
ISAS         := $(if $(findstring x86_64,$(shell $(CC) -dumpmachine 2>/dev/null)),$(foreach isa,avx2 avx512,$(if $(call has,$(FLAGS_$(isa))),$(isa))))
HAS_ISAS     := $(if $(filter avx2,$(ISAS)),-DSTF_HAS_AVX2) $(if $(filter avx512,$(ISAS)),-DSTF_HAS_AVX512)
DEMO_SOURCES  := $(wildcard demo/*.c)
TRADE_SOURCES := $(wildcard demo/trade/*.c)
HEADERS       := $(wildcard include/steadfast/*.h)

LIBRARY_OBJECTS := $(ONCE_SOURCES:%.c=$(BUILD)/once/%.o) $(TWICE_SOURCES:%.c=$(BUILD)/f32/%.o) \
                   $(TWICE_SOURCES:%.c=$(BUILD)/f64/%.o) \
                   $(foreach isa,$(ISAS),$(HOT_SOURCES:%.c=$(BUILD)/f32-$(isa)/%.o) $(HOT_SOURCES:%.c=$(BUILD)/f64-$(isa)/%.o))
DEMO_OBJECTS    := $(DEMO_SOURCES:%.c=$(BUILD)/f32/%.o) $(SCENE_SOURCES:%.c=$(BUILD)/f32/%.o)

TRADE_OBJECTS   := $(TRADE_SOURCES:%.c=$(BUILD)/f32/%.o) $(SCENE_SOURCES:%.c=$(BUILD)/f32/%.o) \
                   $(SCENE_SOURCES:%.c=$(BUILD)/f64/%.o) $(BUILD)/f64/demo/trade/rows.o $(BUILD)/f32/demo/command_line.o

TEST_NAMES      := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c))
SUPPORT_SOURCES := $(wildcard tests/support/*.c) $(SCENE_SOURCES)
TESTS           := $(TEST_NAMES:%=$(BUILD)/tests/%-f32) $(TEST_NAMES:%=$(BUILD)/tests/%-f64)

# The same bits everywhere.
SAME_BITS         := $(BUILD)/same_bits
SAME_BITS_OBJECTS := $(addprefix $(BUILD)/f32/tests/determinism/,main.o pool.o) $(foreach precision,f32 f64,\
                     $(addprefix $(BUILD)/$(precision)/tests/determinism/,cell.o crowds.o) $(SCENE_SOURCES:%.c=$(BUILD)/$(precision)/%.o))

# The benchmark. Its references are compiled for each instruction set, as the library's hot files are.
BENCH_ISAS          := baseline $(ISAS)
REFERENCE_SOURCES   := $(wildcard tests/bench/reference/*.c)
BENCH_TWICE_SOURCES := $(addprefix tests/bench/,bodies.c chosen.c springs.c workload.c)
BENCH_ONCE_SOURCES  := $(filter-out $(BENCH_TWICE_SOURCES),$(wildcard tests/bench/*.c))
BENCH_OBJECTS       := $(BENCH_ONCE_SOURCES:%.c=$(BUILD)/f32/%.o) $(BENCH_TWICE_SOURCES:%.c=$(BUILD)/f32/%.o) \
                       $(BENCH_TWICE_SOURCES:%.c=$(BUILD)/f64/%.o)
REFERENCE_OBJECTS   := $(foreach isa,$(BENCH_ISAS),$(foreach precision,f32 f64,\
                       $(REFERENCE_SOURCES:tests/bench/reference/%.c=$(BUILD)/$(precision)/reference-$(isa)/%.o)))

STATIC := $(BUILD)/libsteadfast.a
ifeq ($(shell uname -s),Darwin)
SONAME      := libsteadfast.$(MAJOR).dylib
SHARED_NAME := libsteadfast.$(VERSION).dylib
LINK_NAME   := libsteadfast.dylib
SHARED_FLAGS = -dynamiclib -install_name $(LIBDIR)/$(SONAME)
else
SONAME      := libsteadfast.so.$(MAJOR)
SHARED_NAME := libsteadfast.so.$(VERSION)
LINK_NAME   := libsteadfast.so
SHARED_FLAGS = -shared -Wl,-soname,$(SONAME)
endif
SHARED := $(BUILD)/$(SHARED_NAME)
DEMO   := $(BUILD)/demo
BENCH  := $(BUILD)/bench
TRADE  := $(BUILD)/trade

# ---- how ---------------------------------------------------------------------------------------------------------------------

WARNINGS := -Wall -Wextra -Wshadow -Wconversion -Wsign-conversion -Wfloat-conversion -Wdouble-promotion \
            -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition -Wnested-externs -Wredundant-decls \
            -Wcast-qual -Wcast-align -Wpointer-arith -Wwrite-strings -Wformat=2 -Wundef -Wvla -Wswitch-enum \
            -Wunused-macros -Winit-self -Wmissing-include-dirs $(if $(WERROR),-Werror)

# The same bits everywhere: no contraction. What is allowed changes no result: sqrt need not set errno, and a division that is
# not taken may still be computed, both of which a vector loop wants.
ARITHMETIC := -ffp-contract=off -fno-math-errno -fno-trapping-math

SANITIZE := $(if $(SAN),-fsanitize=address -fsanitize=undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)

COMPILE = $(CC) -std=c99 -pedantic $(if $(SAN),-O1 -g,$(OPTIMISE)) $(WARNINGS) $(ARITHMETIC) -fPIC -fvisibility=hidden $(SANITIZE) \
          -Iinclude -MMD -MP $(CPPFLAGS) $(CFLAGS)
LINK    = $(CC) $(SANITIZE) $(LDFLAGS)

# One short line a file, unless V=1 asks for the commands or make -s for nothing.
quiet := $(findstring s,$(firstword -$(MAKEFLAGS)))
say    = $(if $(V),,@$(if $(quiet),,echo "  $@" && ))

# Asked when they are needed, not before: `make deps run` installs them on the way. Not ours to warn about: -isystem.
package = $(shell pkg-config $(1) 2>/dev/null)
CMOCKA_FLAGS = $(patsubst -I%,-isystem %,$(call package,--cflags cmocka))
CMOCKA_LIBS  = $(call package,--libs cmocka)
SDL_FLAGS    = $(patsubst -I%,-isystem %,$(call package,--cflags sdl2 SDL2_ttf SDL2_image))
SDL_LIBS     = $(call package,--libs sdl2 SDL2_ttf SDL2_image)
HAVE_CMOCKA  = pkg-config --exists cmocka 2>/dev/null
HAVE_SDL     = pkg-config --exists sdl2 SDL2_ttf SDL2_image 2>/dev/null

# Whatever is asked for together with deps waits for it, also under -j.
DEPS_FIRST := $(filter deps deps-peers deps-cross,$(MAKECMDGOALS))

.PHONY: all library demo run trade pictures test bench bench-peers deps deps-peers install uninstall clean help
.PHONY: need-cmocka need-sdl

all: library
	@if $(HAVE_SDL); then $(MAKE) --no-print-directory demo; \
	else echo "steadfast: the library is built; for the demo, which needs SDL2, SDL2_ttf and SDL2_image, type: make deps"; fi

help:
	@echo "make                 libsteadfast.a, the shared library, and the demo if SDL2 is there, into $(BUILD)"
	@echo "make deps            install what demo and tests need and is not there"
	@echo "make run             the demo (without a display: a picture of each scene)"
	@echo "make trade           what each integrator and step costs and how wrong it is, on this machine: tables and diagrams"
	@echo "make pictures        the README's pictures, anew; prints its table of picks"
	@echo "make test            all tests"
	@echo "make extremes        steps, drags, springs, masses, places, speeds and counts at their extremes, as a matrix"
	@echo "make determinism     the same bits with every compiler, instruction set, number of threads and machine here; long"
	@echo "make deps-cross      install the compilers and emulators of other machines for it"
	@echo "make soak            an hour of simulated play with each integrator: no drift of time, no growth of memory; a minute"
	@echo "make coverage        what of the library's lines and branches the tests reach, with gcc, in some six minutes"
	@echo "make analyse         cppcheck, tidy, analyser (gcc's), tsan, valgrind: each is a target; first make deps ALSO=analyse"
	@echo "make mutants         how many of 200 one-token faults the tests notice; MUTANTS=400 SEED=2 FILES='src/clock.c'"
	@echo "make fuzz            both fuzz targets, FUZZ_SECONDS=60 with each fuzzer; make fuzz-coverage: what their inputs reach"
	@echo "make bench           what a step costs, beside the best plain C: table, CSV and picture, two minutes"
	@echo "make bench-peers     what other libraries pay for the same work, in five minutes; ROW=flight/Box2D: that row alone"
	@echo "make deps-peers      install those libraries"
	@echo "make install         to PREFIX, LIBDIR, INCLUDEDIR, under DESTDIR; make uninstall takes it away"
	@echo "make clean           remove build/"
	@echo "settings             CC=clang  SAN=1  WERROR=1  V=1  OPTIMISE=-O2  PREFIX=..."

library: $(STATIC) $(BUILD)/$(LINK_NAME)

$(BUILD)/once/%.o: %.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -c $< -o $@

$(BUILD)/f32/src/%.o: src/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -c $< -o $@

$(BUILD)/f64/src/%.o: src/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -c $< -o $@

$(BUILD)/f32/src/instructions.o $(BUILD)/f64/src/instructions.o: CPPFLAGS += $(HAS_ISAS)

define variant
$$(BUILD)/f32-$(1)/src/%.o: src/%.c Makefile | $$(DEPS_FIRST)
	@mkdir -p $$(@D)
	$$(say)$$(COMPILE) $$(FLAGS_$(1)) -DSTF_VARIANT=$(1) -c $$< -o $$@

$$(BUILD)/f64-$(1)/src/%.o: src/%.c Makefile | $$(DEPS_FIRST)
	@mkdir -p $$(@D)
	$$(say)$$(COMPILE) $$(FLAGS_$(1)) -DSTF_VARIANT=$(1) -DSTF_DOUBLE -c $$< -o $$@

endef
$(foreach isa,$(ISAS),$(eval $(call variant,$(isa))))

$(STATIC): $(LIBRARY_OBJECTS)
	@rm -f $@
	$(say)$(AR) rcs $@ $^

$(SHARED): $(LIBRARY_OBJECTS)
	$(say)$(LINK) $(SHARED_FLAGS) $^ -lm -o $@

$(BUILD)/$(LINK_NAME): $(SHARED)
	@ln -sf $(SHARED_NAME) $(BUILD)/$(SONAME)
	@ln -sf $(SONAME) $@

# ---- demo --------------------------------------------------------------------------------------------------------------------

demo: $(DEMO)

run: $(DEMO)
	@mkdir -p $(BUILD)/pictures
	$(DEMO) --out $(BUILD)/pictures

# The pictures of the README.
pictures: $(DEMO) $(TRADE) $(BENCH)
	@mkdir -p demo/pictures
	$(DEMO) --headless --scene cloth --ticks 720 --png demo/pictures/cloth.png
	$(DEMO) --headless --scene drag --integrator explicit_euler --ghost rk4 --png demo/pictures/drag.png
	@mkdir -p $(BUILD)/sweep
	$(TRADE) --markdown --precision float
	$(TRADE) --scene kepler --csv $(BUILD)/sweep/kepler.csv --pictures $(BUILD)/sweep >$(BUILD)/sweep/kepler.txt
	cp $(BUILD)/sweep/trade_kepler.png demo/pictures/trade.png
	@mkdir -p $(BUILD)/pictures
	$(BENCH) --picture $(BUILD)/pictures/bench >$(BUILD)/pictures/bench.txt
	cp $(BUILD)/pictures/bench.png demo/pictures/bench.png

need-sdl: | $(DEPS_FIRST)
	@$(HAVE_SDL) || { echo "steadfast: the demo needs SDL2, SDL2_ttf and SDL2_image: type: make deps" >&2; exit 1; }

$(BUILD)/f32/demo/scenes/%.o: demo/scenes/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -c $< -o $@

$(BUILD)/f64/demo/scenes/%.o: demo/scenes/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -Idemo -c $< -o $@

# What trade reads its options with as well.
$(BUILD)/f32/demo/command_line.o: demo/command_line.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -c $< -o $@

$(BUILD)/f32/demo/%.o: demo/%.c Makefile | need-sdl
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -DSTF_DEMO_FONTS='"$(CURDIR)/demo/fonts"' $(SDL_FLAGS) -c $< -o $@

$(DEMO): $(DEMO_OBJECTS) $(STATIC)
	$(say)$(LINK) $^ $(SDL_LIBS) -lm -o $@

# ---- trade: what each integrator and step costs and how wrong it is ----------------------------------------------------------

$(BUILD)/f32/demo/trade/%.o: demo/trade/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -c $< -o $@

$(BUILD)/f64/demo/trade/%.o: demo/trade/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -Idemo -c $< -o $@

$(TRADE): $(TRADE_OBJECTS) $(STATIC)
	$(say)$(LINK) $^ -lm -o $@

trade: $(TRADE)
	@mkdir -p $(BUILD)/sweep
	$(TRADE) --csv $(BUILD)/sweep/trade.csv --json $(BUILD)/sweep/trade.json --pictures $(BUILD)/sweep

# ---- tests -------------------------------------------------------------------------------------------------------------------

# The benchmark's references have to be what the library computes; how fast anything is, no test asks.
test: $(TESTS) $(BENCH) $(TRADE) $(BUILD)/extremes $(SAME_BITS) $(SAME_BITS)-shared fuzz-targets library
	@CC="$(CC)" MAKE="$(MAKE_COMMAND)" SAN="$(SAN)" sh tests/run.sh $(BUILD) $(TESTS)

need-cmocka: | $(DEPS_FIRST)
	@$(HAVE_CMOCKA) && command -v "$${CXX:-c++}" >/dev/null || \
	    { echo "steadfast: the tests need cmocka and a C++ compiler: type: make deps" >&2; exit 1; }

$(BUILD)/f32/tests/%.o: tests/%.c Makefile | need-cmocka
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -Itests $(CMOCKA_FLAGS) -c $< -o $@

$(BUILD)/f64/tests/%.o: tests/%.c Makefile | need-cmocka
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -Idemo -Itests $(CMOCKA_FLAGS) -c $< -o $@

$(BUILD)/tests/%-f32: $(BUILD)/f32/tests/%.o $(SUPPORT_SOURCES:%.c=$(BUILD)/f32/%.o) $(STATIC)
	@mkdir -p $(@D)
	$(say)$(LINK) $^ $(CMOCKA_LIBS) -lm -pthread -o $@

$(BUILD)/tests/%-f64: $(BUILD)/f64/tests/%.o $(SUPPORT_SOURCES:%.c=$(BUILD)/f64/%.o) $(STATIC)
	@mkdir -p $(@D)
	$(say)$(LINK) $^ $(CMOCKA_LIBS) -lm -pthread -o $@

# ---- analysis: tools that see what tests do not ------------------------------------------------------------------------------

# The analysers read src and include; valgrind and the thread sanitizer run tests. Dot files say what is off, and why.
LIBRARY_SOURCES := $(sort $(ONCE_SOURCES) $(TWICE_SOURCES))
VALGRIND         = valgrind --quiet --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=all --suppressions=.valgrind
VALGRIND_TESTS   = $(filter-out test_stability,$(TEST_NAMES))
VALGRIND_RUNS    = $(foreach precision,f32 f64,$(VALGRIND_TESTS:%=build/valgrind/tests/%-$(precision)))

.PHONY: analyse cppcheck tidy analyser valgrind tsan

analyse: cppcheck tidy analyser tsan valgrind

need-tool-%:
	@command -v $* >/dev/null || { echo "steadfast: $* is not here: type: make deps ALSO=analyse" >&2; exit 1; }

cppcheck: need-tool-cppcheck
	cppcheck --quiet --error-exitcode=1 --enable=all --inline-suppr --suppressions-list=.cppcheck --std=c99 --language=c \
	    -USTF_VARIANT -Iinclude src

# A file at a time: the analyser of clang 14 takes every va_list but that of its first file for uninitialised.
tidy: need-tool-clang-tidy
	printf '%s\n' $(LIBRARY_SOURCES) | xargs -P "$$(getconf _NPROCESSORS_ONLN)" -I {} \
	    clang-tidy --quiet {} -- -std=c99 -Iinclude $(HAS_ISAS) \
	    2>/dev/null # only counts of what stands in the system's headers; findings and errors go to stdout

# gcc alone has it. What it follows is the same for every instruction set.
analyser: need-tool-gcc
	$(MAKE) library CC=gcc BUILD=build/analyser ISAS= OPTIMISE='-O1 -fanalyzer' WERROR=1

# Valgrind knows no AVX-512. Left out is the slowest test; VALGRIND_TESTS=test_stability runs it.
valgrind: need-tool-valgrind
	$(MAKE) BUILD=build/valgrind ISAS='$(filter avx2,$(ISAS))' OPTIMISE='-O2 -g' $(VALGRIND_RUNS)
	for test in $(VALGRIND_RUNS); do $(VALGRIND) $$test || exit 1; done

tsan: need-cmocka
	$(MAKE) BUILD=build/tsan ISAS= OPTIMISE='-O1 -g -fsanitize=thread' LDFLAGS=-fsanitize=thread \
	    build/tsan/tests/test_threads-f32 build/tsan/tests/test_threads-f64
	build/tsan/tests/test_threads-f32
	build/tsan/tests/test_threads-f64

# ---- mutants: do the tests notice faults? ------------------------------------------------------------------------------------

MUTANTS = 200# how many faults
SEED    = 1# which
AGAIN   =# a list of faults to try instead, such as build/mutants/survivors

.PHONY: mutants
mutants: | need-cmocka
	@CC="$(CC)" MAKE="$(MAKE_COMMAND)" MUTANTS="$(MUTANTS)" SEED="$(SEED)" AGAIN="$(AGAIN)" sh tests/mutants/run.sh $(FILES)

# ---- extremes: every integrator at the ends of its world, as a matrix --------------------------------------------------------

EXTREMES_SOURCES := $(filter-out %/main.c %/matrix.c,$(wildcard tests/extremes/*.c))
EXTREMES_OBJECTS := $(BUILD)/f32/tests/extremes/main.o $(BUILD)/f32/tests/extremes/matrix.o \
                    $(EXTREMES_SOURCES:%.c=$(BUILD)/f32/%.o) $(EXTREMES_SOURCES:%.c=$(BUILD)/f64/%.o) \
                    $(BUILD)/f32/tests/extremes/theory.o
EXTREMES := $(BUILD)/extremes

.PHONY: extremes
extremes: $(EXTREMES)
	$(EXTREMES)

$(BUILD)/f32/tests/extremes/theory.o: tests/support/theory.c Makefile
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Itests -c $< -o $@

$(BUILD)/f32/tests/extremes/%.o: tests/extremes/%.c Makefile
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Itests -c $< -o $@

$(BUILD)/f64/tests/extremes/%.o: tests/extremes/%.c Makefile
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -Itests -c $< -o $@

$(EXTREMES): $(EXTREMES_OBJECTS) $(STATIC)
	$(say)$(LINK) $^ -lm -o $@

# ---- determinism: the same bits everywhere -----------------------------------------------------------------------------------

QUICK   =# determinism: QUICK=--quick: after 500 ticks, not 10,000
GOLDENS := tests/determinism/goldens.txt

.PHONY: determinism determinism-goldens deps-cross

# With every compiler, optimisation, instruction set, number of threads and machine that is to be had here.
determinism: | $(DEPS_FIRST)
	@MAKE="$(MAKE_COMMAND)" sh tests/determinism/run.sh all $(QUICK)

# After a change of what is computed; git diff shows which cells it changed.
determinism-goldens: $(SAME_BITS)
	@{ echo "# make determinism-goldens: scene, integrator, precision, ticks, those after which all was finite, hash of the state"; \
	    $(SAME_BITS) --quick && $(SAME_BITS); } > $(BUILD)/goldens.txt && mv $(BUILD)/goldens.txt $(GOLDENS)

$(BUILD)/f32/tests/determinism/%.o: tests/determinism/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -Itests -c $< -o $@

$(BUILD)/f64/tests/determinism/%.o: tests/determinism/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -Idemo -Itests -c $< -o $@

deps-cross:
	@sh .ci/deps only cross

$(SAME_BITS): $(SAME_BITS_OBJECTS) $(STATIC)
	$(say)$(LINK) $^ -lm -pthread -o $@

$(SAME_BITS)-shared: $(SAME_BITS_OBJECTS) $(BUILD)/$(LINK_NAME)
	$(say)$(LINK) $(SAME_BITS_OBJECTS) -L$(BUILD) -lsteadfast -lm -pthread -o $@

# ---- soak: an hour of play with each integrator ------------------------------------------------------------------------------

.PHONY: soak
SOAK_SECONDS = 3600

soak: $(BUILD)/tests/test_soak-f32 $(BUILD)/tests/test_soak-f64
	$(BUILD)/tests/test_soak-f32 $(SOAK_SECONDS)
	$(BUILD)/tests/test_soak-f64 $(SOAK_SECONDS)

# ---- coverage ----------------------------------------------------------------------------------------------------------------

# Not optimised, and what is written into its callers counts once: then a way in the source is a way in the object file.
# Atomic, as test_threads counts from several threads at once.
.PHONY: coverage coverage-run
coverage: | need-gcov
	@$(MAKE) --no-print-directory CC=gcc BUILD=build/coverage OPTIMISE=-O0 LDFLAGS=--coverage \
	    CFLAGS='--coverage -fprofile-update=atomic -Dalways_inline=unused' coverage-run

coverage-run: $(TESTS)
	@sh tests/coverage.sh $(BUILD) $(TESTS)

.PHONY: need-gcov
need-gcov: | $(DEPS_FIRST)
	@command -v gcc >/dev/null && command -v gcov >/dev/null || \
	    { echo "steadfast: coverage needs gcc and its gcov: type: make deps" >&2; exit 1; }

# ---- fuzzing: tests/README.md says what is fuzzed, tests/fuzz/run.sh builds and runs it --------------------------------------

FUZZ_SECONDS = 60# make fuzz: s of each target, precision and fuzzer
FUZZ_ENGINE  =# -fsanitize=fuzzer: linked with a fuzzer; else with replay.c, which takes inputs from files
FUZZ_SHARED := tests/fuzz/fuzz.c tests/fuzz/subjects.c tests/fuzz/model.c $(if $(FUZZ_ENGINE),,tests/fuzz/replay.c)
FUZZ_calls  := tests/fuzz/calls.c $(wildcard tests/fuzz/calls/*.c)
FUZZ_buffers := tests/fuzz/buffers.c
FUZZ        := $(foreach p,f32 f64,$(BUILD)/fuzz/calls-$(p) $(BUILD)/fuzz/buffers-$(p))

.PHONY: fuzz fuzz-targets fuzz-coverage
fuzz:
	+@MAKE="$(MAKE_COMMAND)" FUZZ_SECONDS=$(FUZZ_SECONDS) sh tests/fuzz/run.sh

fuzz-coverage:
	+@MAKE="$(MAKE_COMMAND)" sh tests/fuzz/coverage.sh

fuzz-targets: $(FUZZ)

$(BUILD)/f32/tests/fuzz/%.o: tests/fuzz/%.c Makefile
	@mkdir -p $(@D)
	$(say)$(COMPILE) -c $< -o $@

$(BUILD)/f64/tests/fuzz/%.o: tests/fuzz/%.c Makefile
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -c $< -o $@

define fuzz_target
$(BUILD)/fuzz/$(1)-$(2): $(patsubst %.c,$(BUILD)/$(2)/%.o,$(FUZZ_$(1)) $(FUZZ_SHARED)) $(STATIC)
	@mkdir -p $$(@D)
	$$(say)$$(LINK) $(FUZZ_ENGINE) $$^ -lm -o $$@

endef
$(foreach target,calls buffers,$(foreach p,f32 f64,$(eval $(call fuzz_target,$(target),$(p)))))

# ---- benchmark ---------------------------------------------------------------------------------------------------------------

bench: $(BENCH)
	@mkdir -p $(BUILD)/pictures
	$(BENCH) --csv $(BUILD)/bench.csv --picture $(BUILD)/pictures/bench

define reference_rules
$(BUILD)/f32/reference-$(1)/%.o: tests/bench/reference/%.c Makefile
	@mkdir -p $$(@D)
	$$(say)$$(COMPILE) $(FLAGS_$(1)) -DREFERENCE_ISA=$(1) -c $$< -o $$@

$(BUILD)/f64/reference-$(1)/%.o: tests/bench/reference/%.c Makefile
	@mkdir -p $$(@D)
	$$(say)$$(COMPILE) $(FLAGS_$(1)) -DREFERENCE_ISA=$(1) -DSTF_DOUBLE -c $$< -o $$@
endef
$(foreach isa,$(BENCH_ISAS),$(eval $(call reference_rules,$(isa))))

$(BUILD)/f32/tests/bench/%.o: tests/bench/%.c Makefile
	@mkdir -p $(@D)
	$(say)$(COMPILE) $(HAS_ISAS) -c $< -o $@

$(BUILD)/f64/tests/bench/%.o: tests/bench/%.c Makefile
	@mkdir -p $(@D)
	$(say)$(COMPILE) $(HAS_ISAS) -DSTF_DOUBLE -c $< -o $@

$(BENCH): $(BENCH_OBJECTS) $(REFERENCE_OBJECTS) $(STATIC)
	$(say)$(LINK) $^ -lm -pthread -o $@

# ---- peers: other libraries, those that are here -----------------------------------------------------------------------------

# The peers' files, and ours beside them, are compiled for this very processor; the libraries come as the system has them.
PEERS       =# bench-peers asks find.sh
ROW         =# bench-peers: only rows with this in section/peer/method
PEER_BUILD := $(BUILD)/peers
PEER_FLAGS  = -O3 -march=native -fno-math-errno -fno-trapping-math -Iinclude -I$(<D) -MMD -MP \
              -DPACKAGE_VERSION='"$(call package,--modversion $*)"' \
              $(foreach p,box2d bullet ode gsl,$(patsubst -I%,-isystem %,$(call package,--cflags $(p)))) $(CPPFLAGS) $(CFLAGS)
PEER_LIBS   = $(foreach p,$(filter box2d bullet ode gsl,$(PEERS)),$(call package,--libs $(p))) \
              $(if $(filter chipmunk,$(PEERS)),-lchipmunk) \
              $(if $(filter sundials,$(PEERS)),$(addprefix -lsundials_,arkode cvode nvecserial sunnonlinsolfixedpoint))
PEER_CXX_WARNINGS = $(filter-out %-prototypes -Wold-style-definition -Wnested-externs,$(WARNINGS))
PEER_OBJECTS = $(addprefix $(PEER_BUILD)/,$(addsuffix .o,peers race workload ours_float ours_double list $(PEERS)))

bench-peers: library | $(DEPS_FIRST)
	@peers="$$(CXX="$(CXX)" sh tests/bench/peers/find.sh)" && \
	    $(MAKE) --no-print-directory PEERS="$$(echo $$peers)" $(PEER_BUILD)/peers
	$(PEER_BUILD)/peers --csv $(BUILD)/peers.csv $(ROW)

$(PEER_BUILD)/list.c: FORCE
	@mkdir -p $(@D)
	@{ echo '#include "table.h"'; \
	    for p in ours_float ours_double $(PEERS); do echo "extern const peer peer_$$p;"; done; \
	    echo 'const peer *const peers[] = {'; \
	    for p in ours_float ours_double $(PEERS); do echo "&peer_$$p,"; done; echo 'NULL};'; \
	} > $@.new; cmp -s $@.new $@ && rm $@.new || mv $@.new $@

$(PEER_BUILD)/list.o: $(PEER_BUILD)/list.c
	$(say)$(CC) -std=c99 $(PEER_FLAGS) -Itests/bench/peers -c $< -o $@

$(addprefix $(PEER_BUILD)/ours_,float.o double.o): $(PEER_BUILD)/ours_%.o: tests/bench/peers/ours.c Makefile
	@mkdir -p $(@D)
	$(say)$(CC) -std=c99 -pedantic $(WARNINGS) $(PEER_FLAGS) $(if $(filter double,$*),-DSTF_DOUBLE) -c $< -o $@

$(PEER_BUILD)/%.o: tests/bench/peers/%.c Makefile
	@mkdir -p $(@D)
	$(say)$(CC) -std=c99 -pedantic $(WARNINGS) $(PEER_FLAGS) -c $< -o $@

$(PEER_BUILD)/%.o: tests/bench/peers/%.cpp Makefile
	@mkdir -p $(@D)
	$(say)$(CXX) -std=c++17 $(PEER_CXX_WARNINGS) $(PEER_FLAGS) -c $< -o $@

$(PEER_BUILD)/peers: $(PEER_OBJECTS) $(BUILD)/f32/tests/bench/measure.o $(STATIC)
	$(say)$(CXX) $(LDFLAGS) $^ $(PEER_LIBS) -lm -o $@

# ---- dependencies, installation -----------------------------------------------------------------------------------------------

deps:
	@sh .ci/deps $(ALSO)

deps-peers:
	@sh .ci/deps only peers

$(BUILD)/steadfast.pc: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' 'includedir=$(INCLUDEDIR)' '' \
	    'Name: Steadfast' 'Description: Particles, integrators and a fixed-timestep clock for game engines' \
	    'Version: $(VERSION)' 'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lsteadfast' 'Libs.private: -lm' > $@

.PHONY: FORCE
FORCE:

install: library $(BUILD)/steadfast.pc
	install -d '$(DESTDIR)$(INCLUDEDIR)/steadfast' '$(DESTDIR)$(LIBDIR)/pkgconfig'
	install -m 644 $(HEADERS) '$(DESTDIR)$(INCLUDEDIR)/steadfast'
	install -m 644 $(STATIC) '$(DESTDIR)$(LIBDIR)'
	install -m 755 $(SHARED) '$(DESTDIR)$(LIBDIR)'
	ln -sf $(SHARED_NAME) '$(DESTDIR)$(LIBDIR)/$(SONAME)'
	ln -sf $(SONAME) '$(DESTDIR)$(LIBDIR)/$(LINK_NAME)'
	install -m 644 $(BUILD)/steadfast.pc '$(DESTDIR)$(LIBDIR)/pkgconfig'

uninstall:
	rm -f $(HEADERS:include/%='$(DESTDIR)$(INCLUDEDIR)/%')
	-rmdir '$(DESTDIR)$(INCLUDEDIR)/steadfast'
	rm -f '$(DESTDIR)$(LIBDIR)/libsteadfast.a' '$(DESTDIR)$(LIBDIR)/$(SHARED_NAME)' '$(DESTDIR)$(LIBDIR)/$(SONAME)' \
	      '$(DESTDIR)$(LIBDIR)/$(LINK_NAME)' '$(DESTDIR)$(LIBDIR)/pkgconfig/steadfast.pc'

clean:
	rm -rf build

.SECONDARY:
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
