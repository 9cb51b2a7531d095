#!/bin/sh
# tests/mutants/run.sh [FILE...]: one-token faults in copies of src (of these files alone), and which of them the tests notice.
# CC, MAKE, MUTANTS (how many of all faults), SEED (which), JOBS (at a time), AGAIN (a list of faults to try instead), and
# tests/README.md for what comes out.
set -u
cd "$(dirname "$0")/../.."
unset MAKEFLAGS MFLAGS MAKELEVEL
export CCACHE_DISABLE=1 LC_ALL=C
CC=${CC:-cc} MAKE=${MAKE:-make} MUTANTS=${MUTANTS:-200} SEED=${SEED:-1} AGAIN=${AGAIN:-}
JOBS=${JOBS:-$(getconf _NPROCESSORS_ONLN)}
hung=137 # killed: its time was up
work=build/mutants build=build/$(basename "${CC%% *}")-release
fail() { echo "steadfast: $*" >&2; exit 1; }
case $MUTANTS in '' | 0* | *[!0-9]*) fail "MUTANTS wants a whole number from 1 on, not '$MUTANTS'" ;; esac
pkg-config --exists cmocka || fail "the tests need cmocka; type: make deps"

# The baseline's loops alone: the other instruction sets are the same source. A function that returns nothing is no mutant.
make_in() { tree=$1; shift; $MAKE -s -C "$tree" CC="$CC" OPTIMISE=-O2 ISAS= WARNINGS=-Werror=return-type "$@" >/dev/null 2>&1; }

# Both precisions of these tests.
binaries() { for test in "$@"; do printf '%s\n' "$build/tests/$test-f64" "$build/tests/$test-f32"; done; }

# The tests of a file's part: those are run first. The others follow as fast as they are.
tests_of_part() {
    case $1 in
    src/clock.c) echo test_clock ;;
    src/world/save.c | src/world/load.c | src/world/format.h | src/world/fields.c | src/world/reader.h | src/checksum.*)
        echo test_save ;;
    src/world/snapshot.c) echo test_rollback ;;
    src/world/guard.c | src/world/checkpoint.c | src/flags.h) echo test_guard ;;
    src/sum.h) echo test_compensated ;;
    src/kernels.c) echo test_settle test_guard ;;
    src/integrators/* | src/flight.h) echo test_integrator test_order test_linear ;;
    src/forces/* | src/spring_order.* | src/sort.*) echo test_force test_blocks ;;
    src/stability/*) echo test_stability ;;
    src/trade/*) echo test_trade ;;
    *) echo test_world test_blocks ;;
    esac
}

# run_test TREE BINARY: true if it passes in five times the time that it takes without a fault (of the processor, whatever else
# runs), in memory that a runaway loop does not eat up.
run_test() {
    limit=$(awk -v test="$2" '$2 == test { print 5 * $1 }' $work/times 2>/dev/null)
    (cd "$1" && ulimit -c 0 && ulimit -v 8000000 && ulimit -t "${limit:-300}" && "$2") >/dev/null 2>&1
}

# try WORKER FILE LINE COLUMN LENGTH KIND INSTEAD: one line of the report, and the diff of a survivor.
try() {
    tree=$work/tree$1 file=$2
    rm -rf "$tree"
    cp -Rp $work/pristine "$tree"
    awk -v at="$3" -v from="$4" -v size="$5" -v instead="$7" '
        NR == at { $0 = substr($0, 1, from - 1) instead substr($0, from + size) }
        { print }' "$work/pristine/$file" >"$tree/$file"
    was=$(sed -n "$3p" "$work/pristine/$file" | cut -c "$4-$(($4 + $5 - 1))")
    fate=$(fate_of "$tree" "$file")
    printf '%-38s %-10s %-44s %s\n' "$file:$3:$4" "$6" "$was -> $7" "$fate" >>$work/report.$1
    tail -n 1 $work/report.$1
    case $fate in survived*)
        { echo "$file:$3:$4 $6"; diff "$work/pristine/$file" "$tree/$file" | sed 1d; echo; } >>$work/survivors.diff.$1
        printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$file" "$3" "$4" "$5" "$6" "$7" >>$work/survivors.$1 ;;
    esac
}

fate_of() {
    make_in "$1" library || { echo "does not compile"; return; }
    if cmp -s "$1/$shared" "$work/pristine/$shared"; then echo "same code"; return; fi
    first=$(binaries $(tests_of_part "$2"))
    for tests in "$first" "$(awk '{ print $2 }' $work/times | grep -vxF "$first")"; do
        make_in "$1" $tests || { echo "does not link"; return; }
        for test in $tests; do
            cmp -s "$1/$test" "$work/pristine/$test" && continue # it has nothing of this file in it
            run_test "$1" "$test" 2>/dev/null && continue # without the shell's word of what crashed
            [ $? = $hung ] && echo "noticed by ${test##*/}, which hangs" || echo "noticed by ${test##*/}"
            return
        done
    done
    echo "survived"
}

[ -z "$AGAIN" ] || again=$(cat "$AGAIN") || fail "there is no list $AGAIN"
rm -rf $work
mkdir -p $work/pristine/demo
cp -R Makefile include src tests $work/pristine
cp -R demo/scenes $work/pristine/demo
all=$(binaries $(cd tests && ls test_*.c | sed 's/\.c$//'))
echo "building and running the tests without a fault"
make_in $work/pristine -j"$JOBS" library $all || fail "the copy in $work/pristine does not build"
shared=$(cd $work/pristine && ls $build/lib*.so.*.*.* $build/lib*.*.*.*.dylib 2>/dev/null)
: >$work/times
for test in $all; do
    start=$(date +%s)
    run_test $work/pristine "$test" || fail "$test fails without any fault"
    echo "$(($(date +%s) - start + 1)) $test" >>$work/unsorted
done
sort -n $work/unsorted >$work/times

# The list of all faults, shuffled (Fisher and Yates; Park and Miller's random numbers, whole in any awk) and cut.
if [ -n "$AGAIN" ]; then echo "$again"; else
    awk -f tests/mutants/faults.awk $([ $# -gt 0 ] && echo "$@" || find src -name '*.[ch]' | sort) |
    awk -v seed="$SEED" -v count="$MUTANTS" '
        function random(below) { state = state * 16807 % 2147483647; return int(state / 2147483647 * below) }
        { fault[NR] = $0 }
        END {
            state = (seed * 7919 + 1) % 2147483646 + 1
            for (i = 0; i < 10; i++) random(1)
            for (i = 1; i <= NR && i <= count; i++) {
                chosen = i + random(NR - i + 1)
                print fault[chosen]
                fault[chosen] = fault[i]
            }
        }'
fi >$work/faults

pids=
trap 'kill $pids 2>/dev/null; exit 1' INT TERM
for worker in $(seq "$JOBS"); do
    awk -v n="$worker" -v jobs="$JOBS" 'NR % jobs == n % jobs' $work/faults >$work/faults.$worker
    while IFS='	' read -r file line column size kind instead; do
        try "$worker" "$file" "$line" "$column" "$size" "$kind" "$instead"
    done <$work/faults.$worker &
    pids="$pids $!"
done
wait
sort $work/report.[0-9]* >$work/report
cat $work/survivors.[0-9]* >$work/survivors 2>/dev/null
cat $work/survivors.diff.[0-9]* 2>/dev/null | tee $work/survivors.diff
awk '
    { split($1, place, ":"); file = place[1]; tried++ }
    / (does not compile|does not link|same code)$/ { left_out++; next }
    !(file in counted) { order[++files] = file }
    { counted[file]++; counted_all++ }
    / noticed by / { noticed[file]++; noticed_all++ }
    function row(name, n, of) { printf "%-32s %8d %8d %7.1f %%\n", name, of, n, of ? 100 * n / of : 100 }
    END {
        printf "%-32s %8s %8s\n", "file", "faults", "noticed"
        for (i = 1; i <= files; i++) row(order[i], noticed[order[i]], counted[order[i]])
        row("all", noticed_all, counted_all)
        printf "%d of %d tried are not counted: they do not compile, or give the same code\n", left_out, tried
    }' $work/report
echo "report: $work/report; survivors: $work/survivors.diff, and to try them again: make mutants AGAIN=$work/survivors"
