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
ONCE_SOURCES  := src/allocator.c src/clock.c src/result.c src/stability/eigen.c
TWICE_SOURCES := $(filter-out $(ONCE_SOURCES),$(wildcard src/*.c src/*/*.c))
SCENE_SOURCES := $(wildcard demo/scenes/*.c)
DEMO_SOURCES  := $(wildcard demo/*.c)
HEADERS       := $(wildcard include/steadfast/*.h)

LIBRARY_OBJECTS := $(ONCE_SOURCES:%.c=$(BUILD)/once/%.o) $(TWICE_SOURCES:%.c=$(BUILD)/f32/%.o) \
                   $(TWICE_SOURCES:%.c=$(BUILD)/f64/%.o)
DEMO_OBJECTS    := $(DEMO_SOURCES:%.c=$(BUILD)/f32/%.o) $(SCENE_SOURCES:%.c=$(BUILD)/f32/%.o)

TEST_NAMES      := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c))
SUPPORT_SOURCES := $(wildcard tests/support/*.c) $(SCENE_SOURCES)
TESTS           := $(TEST_NAMES:%=$(BUILD)/tests/%-f32) $(TEST_NAMES:%=$(BUILD)/tests/%-f64)

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
DEPS_FIRST := $(filter deps,$(MAKECMDGOALS))

.PHONY: all library demo run pictures test deps install uninstall clean help need-cmocka need-sdl

all: library
	@if $(HAVE_SDL); then $(MAKE) --no-print-directory demo; \
	else echo "steadfast: the library is built; for the demo, which needs SDL2, SDL2_ttf and SDL2_image, type: make deps"; fi

help:
	@echo "make                 libsteadfast.a, the shared library, and the demo if SDL2 is there, into $(BUILD)"
	@echo "make deps            install what demo and tests need and is not there"
	@echo "make run             the demo (without a display: a picture of each scene)"
	@echo "make pictures        the README's pictures, anew"
	@echo "make test            all tests"
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
pictures: $(DEMO)
	@mkdir -p demo/pictures
	$(DEMO) --headless --scene cloth --ticks 720 --png demo/pictures/cloth.png
	$(DEMO) --headless --scene drag --integrator explicit_euler --ghost rk4 --png demo/pictures/drag.png

need-sdl: | $(DEPS_FIRST)
	@$(HAVE_SDL) || { echo "steadfast: the demo needs SDL2, SDL2_ttf and SDL2_image: type: make deps" >&2; exit 1; }

$(BUILD)/f32/demo/scenes/%.o: demo/scenes/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -c $< -o $@

$(BUILD)/f64/demo/scenes/%.o: demo/scenes/%.c Makefile | $(DEPS_FIRST)
	@mkdir -p $(@D)
	$(say)$(COMPILE) -DSTF_DOUBLE -Idemo -c $< -o $@

$(BUILD)/f32/demo/%.o: demo/%.c Makefile | need-sdl
	@mkdir -p $(@D)
	$(say)$(COMPILE) -Idemo -DSTF_DEMO_FONTS='"$(CURDIR)/demo/fonts"' $(SDL_FLAGS) -c $< -o $@

$(DEMO): $(DEMO_OBJECTS) $(STATIC)
	$(say)$(LINK) $^ $(SDL_LIBS) -lm -o $@

# ---- tests -------------------------------------------------------------------------------------------------------------------

test: $(TESTS) library
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
	$(say)$(LINK) $^ $(CMOCKA_LIBS) -lm -o $@

$(BUILD)/tests/%-f64: $(BUILD)/f64/tests/%.o $(SUPPORT_SOURCES:%.c=$(BUILD)/f64/%.o) $(STATIC)
	@mkdir -p $(@D)
	$(say)$(LINK) $^ $(CMOCKA_LIBS) -lm -o $@

# ---- dependencies, installation -----------------------------------------------------------------------------------------------

deps:
	@sh .ci/deps $(ALSO)

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
