#!/bin/sh
# tests/fuzz/run.sh: fuzzes each target in both precisions with each fuzzer that is here, FUZZ_SECONDS seconds each, from the
# seeds; says what came out. Called by `make fuzz`. Keeps what it found under build/fuzz/, and the next run goes on from there.
set -u

MAKE=${MAKE:-make}
seconds=${FUZZ_SECONDS:-60}
work=build/fuzz
failed=0

# Allocations of a program are many and small: short stacks and a small quarantine make it several times as fast.
export ASAN_OPTIONS=quarantine_size_mb=8:malloc_context_size=3
export UBSAN_OPTIONS=print_stacktrace=1

fail() { echo "steadfast: $*" >&2; exit 1; }
has() { command -v "$1" >/dev/null 2>&1; }

# build FUZZER COMPILER FLAGS: the library and the targets, under build/fuzz/FUZZER
build() {
    $MAKE -s --no-print-directory fuzz-targets BUILD="$work/$1" CC="$2" SAN=1 CFLAGS="-O2 $3" FUZZ_ENGINE=-fsanitize=fuzzer ||
        fail "the fuzz targets do not build with $2: see above; for its runtime libraries type: make deps ALSO=fuzz"
}

row() { printf '%-10s %-10s %-10s %12s %12s %10s %8s\n' "$@"; }

# report FUZZER TARGET PRECISION EXECUTIONS SECONDS EDGES CRASHES FILE
report() {
    row "$2" "$3" "$1" "$4" "$(($4 / $5))" "$6" "$7"
    [ "$7" = 0 ] && return
    failed=1
    echo "steadfast: $2 fails on $8; to see what it calls: make fuzz-targets SAN=1 &&" \
         "build/*-sanitize/fuzz/$2-$3 -v $8" >&2
}

# A crash of libFuzzer ends its run.
libfuzzer() {
    out=$work/corpus/$1-$2 log=$work/libfuzzer-$1-$2.log
    mkdir -p "$out" "$work/crashes"
    "$work/libfuzzer/fuzz/$1-$2" -max_total_time="$seconds" -max_len="$3" -entropic=0 -timeout=20 -print_final_stats=1 \
        -artifact_prefix="$work/crashes/$1-$2-" "$out" "tests/fuzz/seeds/$1" >"$log" 2>&1
    status=$?
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
    file=$(sed -n 's/.*Test unit written to //p' "$log")
    [ -n "$executions" ] || { tail -n 20 "$log" >&2; fail "libFuzzer did not run $1-$2: see $log"; }
    report libFuzzer "$1" "$2" "$executions" "$seconds" "${edges:-0}" "$([ $status -eq 0 ] && echo 0 || echo 1)" "$file"
}

replay_all() { find "$2" -type f ! -path '*/.state/*' -exec "$work/afl/fuzz/$1" {} + >/dev/null 2>&1; }

first_that_fails() {
    for file in "$2"/*; do
        "$work/afl/fuzz/$1" "$file" >/dev/null 2>&1 || { echo "$file"; return; }
    done
}

# A number of AFL++'s; 0 before the first run.
stat_of() { sed -n "s/^$2 *: *//p" "$1/fuzzer_stats" 2>/dev/null | grep . || echo 0; }

# AFL++ leaves out what fails before it has begun, and counts no crash: so all it starts from is replayed first.
afl() {
    out=$work/afl-out/$1-$2
    mkdir -p "$work/afl-out"
    if [ -d "$out/default" ]; then from=- inputs=$out/default/queue; else from=tests/fuzz/seeds/$1 inputs=$from; fi
    if ! replay_all "$1-$2" "$inputs"; then
        report AFL++ "$1" "$2" 0 "$seconds" 0 1 "$(first_that_fails "$1-$2" "$inputs")"
        return
    fi
    before=$(stat_of "$out/default" execs_done) # it counts on
    AFL_SKIP_CPUFREQ=1 AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 AFL_NO_UI=1 AFL_NO_AFFINITY=1 AFL_FAST_CAL=1 \
        ASAN_OPTIONS=$ASAN_OPTIONS:abort_on_error=1:symbolize=0:detect_leaks=0 UBSAN_OPTIONS= \
        afl-fuzz -V "$seconds" -t 2000+ -G "$3" -i "$from" -o "$out" -- "$work/afl/fuzz/$1-$2" >"$work/afl-$1-$2.log" 2>&1 ||
        { tail -n 20 "$work/afl-$1-$2.log" >&2; fail "AFL++ did not run $1-$2: see above"; }
    crashes=$(find "$out/default/crashes" -name 'id*' | wc -l)
    report AFL++ "$1" "$2" "$(($(stat_of "$out/default" execs_done) - before))" "$seconds" \
        "$(stat_of "$out/default" edges_found)" "$crashes" "$(find "$out/default/crashes" -name 'id*' | head -n 1)"
}

has clang || has afl-fuzz || fail "no fuzzer here; type: make deps ALSO=fuzz"
fuzzers=
if has clang; then
    build libfuzzer clang '-fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp'
    fuzzers=libfuzzer
fi
if has afl-fuzz && has afl-clang-fast; then
    AFL_QUIET=1 build afl afl-clang-fast ''
    fuzzers="$fuzzers afl"
fi

row target precision fuzzer executions 'a second' edges crashes
for fuzzer in $fuzzers; do
    for precision in f32 f64; do
        $fuzzer calls $precision 256
        $fuzzer buffers $precision 1024
    done
done
exit $failed
