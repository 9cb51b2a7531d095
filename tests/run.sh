#!/bin/sh
# tests/run.sh BUILD TEST...: runs every test, and the checks of the installed library and of the command trade, and counts.
build=$1
shift
passed=0 failed=0

run() {
    if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $*" | cut -c 1-120; fi
}

for test in "$@"; do run "$test"; done
run sh tests/bad_input/check.sh "$build"
run sh tests/consumer/check.sh "$build"
for isa in baseline avx2 avx512; do run env STEADFAST_ISA=$isa "$build/bench" --check; done
run sh tests/determinism/run.sh test "$build"
run sh tests/trade/check.sh "$build"
run "$build/extremes" --check
run sh tests/fuzz/check.sh
for target in calls buffers; do
    for precision in f32 f64; do run "$build/fuzz/$target-$precision" tests/fuzz/seeds/$target/*; done
done

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
