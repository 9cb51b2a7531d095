#!/bin/sh
# tests/determinism/run.sh all [--quick]: steps all cells (see main.c) with every compiler, optimisation, instruction set, number
# of threads and machine that is to be had here, and compares with the golden hashes.
# tests/determinism/run.sh test BUILD: on one build that is there, for fewer ticks.
set -u
goldens=$PWD/tests/determinism/goldens.txt
jobs=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
machines="aarch64 riscv64 s390x"
format='%-10s %-9s %-31s %12s %7s\n'
NOT_HERE=3 # what same_bits returns where the machine lacks the instruction set

say() { printf "$format" "$1" "$2" "$3" "$4" "$5"; }

# lacks DIRECTORY WHAT: notes what can't be proved here; say_lacks says it all.
lacks() { echo "$2" >> "$1/lacks"; }
say_lacks() { [ ! -s "$1/lacks" ] || echo "not proved, as it is not here: $(paste -s -d , "$1/lacks")"; }

# A row: the directory that holds the builds, the build in it, the instruction set ("-": what the library picks) and options of
# same_bits; below it the cells that differ. The option "shared", before all others: with the shared library.
row() {
    directory=$1 build=$2 isa=$3 program=same_bits runner=
    shift 3
    how="$*"
    if [ "${1-}" = shared ]; then
        program=same_bits-shared
        export LD_LIBRARY_PATH="./$build" DYLD_LIBRARY_PATH="./$build"
        shift
    fi
    case " $machines " in *" $build "*) runner=qemu-$build-static ;; esac
    unset STEADFAST_ISA
    [ "$isa" = - ] || export STEADFAST_ISA="$isa"

    started=$(date +%s)
    said=$(cd "$directory" && $runner "./$build/$program" --goldens "$goldens" "$@" 2>&1)
    status=$?
    case $status in
    0) equal=$said said= ;;
    1) equal=$(echo "$said" | tail -n 1) said=$(echo "$said" | sed '$d') ;;
    $NOT_HERE) equal="not here" said=; lacks "$directory" "$build $isa" ;;
    *) equal=failed ;;
    esac
    printf '%s\n' "$(say "$build" "$isa" "$how" "$equal" "$(($(date +%s) - started)) s")" ${said:+"$said"}
    [ $status -eq 0 ] || [ $status -eq $NOT_HERE ]
}

# Runs the rows that come as lines, as many at once as there are cores. To xargs a blank at an end means that the line goes on.
rows() { sed 's/ *$//' | xargs -P "$jobs" -L 1 sh "$0" row; }

test_build() {
    directory=$(dirname "$1") build=$(basename "$1") failed=
    : > "$directory/lacks"
    say build ISA how "equal cells" time
    {
        for isa in baseline avx2 avx512; do echo "$directory $build $isa --quick"; done
        for how in "--threads 2" "--threads 7" --shuffle; do echo "$directory $build - --quick $how"; done
        echo "$directory $build - shared --quick"
    } | rows || failed=1
    say_lacks "$directory"
    [ -z "$failed" ]
}

here=build/determinism

# build NAME MAKE_ARGUMENT...
build() {
    name=$1
    shift
    ${MAKE:-make} -s -j"$jobs" SAN= BUILD="$here/$name" "$@" || { echo "steadfast: $name: can't be built" >&2; exit 1; }
}

can_link() { echo 'int main(void) { return 0; }' | $1 -static -x c - -o /dev/null >/dev/null 2>&1; }

# The compilers and machines that are here, in $compilers and $guests; says what is not.
look() {
    compilers= guests=
    mkdir -p $here
    : > $here/lacks
    for cc in gcc clang; do
        if command -v $cc >/dev/null; then compilers="$compilers $cc"
        else say $cc - "missing; type: sh .ci/deps only clang" - -; lacks $here $cc; fi
    done
    for m in $machines; do
        if can_link $m-linux-gnu-gcc && command -v qemu-$m-static >/dev/null; then guests="$guests $m"
        else say $m - "missing; type: make deps-cross" - -; lacks $here $m; fi
    done
}

build_all() {
    for cc in $compilers; do
        for level in 0 2 3; do build $cc-O$level CC=$cc OPTIMISE=-O$level $here/$cc-O$level/same_bits; done
        build $cc-O3 CC=$cc OPTIMISE=-O3 $here/$cc-O3/same_bits-shared
    done
    # On s390x gcc says that float has excess precision, for the sake of an old promise, unless it is told otherwise.
    for m in $guests; do
        build $m CC=$m-linux-gnu-gcc AR=$m-linux-gnu-ar LDFLAGS=-static OPTIMISE=-O3 \
            CFLAGS="$([ $m = s390x ] && echo -fexcess-precision=fast)" $here/$m/same_bits
    done
    rm -rf $here/saves-*
    for name in $guests native; do mkdir -p $here/saves-$name; done
}

# Long ones first. Saves are written and read in runs of fewer ticks; so is all on s390x, whose emulation takes three times as
# long as the others', and which is here for its order of bytes.
list_writes() {
    for m in $guests; do [ $m = s390x ] || echo "$here $m - ${1-}"; done
    for cc in $compilers; do
        for level in 0 2 3; do for isa in baseline avx2 avx512; do echo "$here $cc-O$level $isa ${1-}"; done; done
        for how in "--threads 2" "--threads 7" --shuffle; do echo "$here $cc-O3 - ${1-} $how"; done
        echo "$here $cc-O3 - shared ${1-}"
    done
    for m in $guests; do echo "$here $m - --quick --write saves-$m"; done
    echo "$here $native - --quick --write saves-native"
}

list_reads() {
    for m in $guests; do
        echo "$here $m - --quick --read saves-native"
        echo "$here $native - --quick --read saves-$m"
    done
}

# Every byte that another machine saved.
compare_saves() {
    for m in $guests; do
        equal=$(for save in $here/saves-native/*; do cmp -s "$save" "$here/saves-$m/${save##*/}" && echo; done | wc -l)
        cells=$(ls $here/saves-native | wc -l)
        say $m - "its saves, byte by byte" "$equal of $cells" -
        [ "$equal" -eq "$cells" ] || return 1
    done
}

all() {
    say build ISA how "equal cells" time
    look
    native="${compilers##* }-O3" failed=
    build_all
    list_writes "$@" | rows || failed=1
    list_reads | rows || failed=1
    compare_saves || failed=1
    say_lacks $here
    [ -z "$failed" ]
}

case ${1-} in
row) shift; row "$@" ;;
test) test_build "$2" ;;
all) shift; all "$@" ;;
*) echo "usage: tests/determinism/run.sh all [--quick] | test BUILD" >&2; exit 2 ;;
esac
