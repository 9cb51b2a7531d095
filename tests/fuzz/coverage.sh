#!/bin/sh
# tests/fuzz/coverage.sh [FOLDER]: how much of src the seeds and all inputs that `make fuzz` has kept reach, and those in
# FOLDER/TARGET-PRECISION/. Called by `make fuzz-coverage`.
set -eu

work=build/fuzz/coverage
fail() { echo "steadfast: $*" >&2; exit 1; }

for tool in clang llvm-profdata llvm-cov; do
    command -v $tool >/dev/null 2>&1 || fail "no $tool here; type: make deps ALSO=fuzz"
done
${MAKE:-make} -s --no-print-directory fuzz-targets BUILD=$work CC=clang OPTIMISE=-O1 LDFLAGS=-fprofile-instr-generate \
    CFLAGS='-fprofile-instr-generate -fcoverage-mapping'

rm -f $work/*.profraw
for target in calls buffers; do
    for precision in f32 f64; do
        name=$target-$precision
        find "tests/fuzz/seeds/$target" "build/fuzz/corpus/$name" "build/fuzz/afl-out/$name/default/queue" ${1:+"$1/$name"} \
            -type f ! -path '*/.state/*' 2>/dev/null |
            LLVM_PROFILE_FILE=$work/$name-%p.profraw xargs $work/fuzz/$name
    done
done
llvm-profdata merge -o $work/all.profdata $work/*.profraw
llvm-cov report $work/fuzz/calls-f32 -object $work/fuzz/calls-f64 -object $work/fuzz/buffers-f32 \
    -object $work/fuzz/buffers-f64 -instr-profile=$work/all.profdata -show-region-summary=0 -show-branch-summary \
    -ignore-filename-regex='tests/|include/'
