#!/bin/sh
# tests/consumer/check.sh BUILD: installs the library that is in BUILD and looks at it as an engine does: what is there, what it
# exports, and whether programs build, link and run against it. Takes CC, MAKE, SAN and CXX from the environment; writes only
# under BUILD/consumer.
set -eu

CC=${CC:-cc} MAKE=${MAKE:-make} SAN=${SAN:-}
here=tests/consumer
build=$1
case $build in
/*) work=$build/consumer ;;
*) work=$PWD/$build/consumer ;;
esac
prefix=$work/prefix
strict="-Wall -Wextra -pedantic -Werror"
precisions="float double"

fail() { echo "consumer: $*" >&2; exit 1; }

# try WHAT COMMAND...: silent, unless the command fails.
try() {
    what=$1
    shift
    "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "$what"; }
}

# none WHAT FILE: the file, which lists what is WHAT, is empty.
none() { [ ! -s "$2" ] || fail "$1: $(tr '\n' ' ' <"$2")"; }

case $(uname -s) in
Darwin)
    library_path=DYLD_LIBRARY_PATH
    exported_by() { nm -gU "$1" | sed -n 's/.* _//p'; }
    defined_in() { exported_by "$1"; }
    undefined_in() { nm -u "$1" | sed 's/^ *_//'; }
    name_of() { basename "$(otool -D "$1" | tail -n 1)"; }
    libraries_of() { otool -L "$1"; }
    ;;
*)
    library_path=LD_LIBRARY_PATH
    # The linker's own names, which old ones export.
    exported_by() { nm -D --defined-only "$1" | sed 's/.* //; s/@.*//' | grep -vxE '_init|_fini|_edata|_end|__bss_start'; }
    defined_in() { nm -g --defined-only "$1" | sed -n 's/^[0-9a-f]* [A-Za-z] //p'; }
    undefined_in() { nm -u "$1" | sed 's/.* //'; }
    name_of() { objdump -p "$1" | sed -n 's/^ *SONAME *//p'; }
    libraries_of() { objdump -p "$1" | grep NEEDED; }
    ;;
esac

# A sanitized library wants programs with the same compiler's sanitizers, and so C++ from that compiler. Clang is one driver for
# both languages; gcc compiles C++ too, and lacks only the name of the C++ runtime when it links.
sanitize='' cxx=${CXX:-c++} link_cxx=${CXX:-c++} cxx_runtime=''
if [ -n "$SAN" ]; then
    sanitize="-fsanitize=address,undefined -fno-sanitize-recover=all"
    if $CC --driver-mode=g++ -x c++ -fsyntax-only /dev/null >/dev/null 2>&1; then
        cxx="$CC --driver-mode=g++" link_cxx="$CC --driver-mode=g++"
    else
        cxx="$CC -x c++" link_cxx=$CC cxx_runtime=-lstdc++
    fi
fi

# Unquoted where they are used: these are lists of words.
compile_c="$CC -std=c99 $strict $sanitize ${CPPFLAGS-} ${CFLAGS-}"
compile_cxx="$cxx -std=c++11 $strict $sanitize ${CPPFLAGS-} ${CXXFLAGS-}"
link_c="$CC $sanitize ${LDFLAGS-}"
link_cxx="$link_cxx $sanitize ${LDFLAGS-}"

# Without the settings that the outer make was given: they are in BUILD already, and its directories are not those to be proved.
make_it() { MAKEFLAGS='' $MAKE --no-print-directory BUILD="$build" CC="$CC" SAN="$SAN" "$@"; }
flag_of() { [ "$1" = float ] || echo -DSTF_DOUBLE; }

# What holds no reals and so has one name for both precisions.
is_once() {
    case $1 in
    stf_clock_* | stf_result_text | stf_version | stf_force_arranged) ;; # functions; and stf_clock_def
    stf_trade | stf_trade_def | stf_trade_begin) false ;;
    stf_trade_*) ;; # references, rows, and what asks them
    stf_real | stf_result | stf_allocator | stf_parallel | stf_clock | stf_force_kind | stf_force_id | stf_energy) ;;
    stf_guard | stf_guard_mode | stf_fault | stf_fault_kind | stf_mismatch | stf_stability | stf_stability_def) ;;
    *) false ;;
    esac
}

rm -rf "$work"
mkdir -p "$work"

# ---- installed, by default and with all directories changed ------------------------------------------------------------------

real=$work/real stage=$work/stage # real is where a package made from stage would be unpacked
staged="PREFIX=$real LIBDIR=$real/lib64 INCLUDEDIR=$real/headers DESTDIR=$stage"

try "make install fails" make_it install PREFIX="$prefix"
try "make install with DESTDIR, LIBDIR and INCLUDEDIR fails" make_it install $staged
try "make install over an installed copy fails" make_it install PREFIX="$prefix"

[ ! -e "$real" ] || fail "make install writes outside DESTDIR"
[ ! -e "$stage$real/lib" ] && [ ! -e "$stage$real/include" ] || fail "make install ignores LIBDIR or INCLUDEDIR"
try "the installed headers are not those of include/steadfast" diff -r include/steadfast "$prefix/include/steadfast"
try "the headers installed with DESTDIR are not those of include/steadfast" \
    diff -r include/steadfast "$stage$real/headers/steadfast"
[ -f "$prefix/lib/pkgconfig/steadfast.pc" ] && [ -f "$stage$real/lib64/pkgconfig/steadfast.pc" ] ||
    fail "steadfast.pc is not in LIBDIR/pkgconfig"

PKG_CONFIG_PATH=$stage$real/lib64/pkgconfig
export PKG_CONFIG_PATH
! grep -F "$stage" "$PKG_CONFIG_PATH/steadfast.pc" >/dev/null || fail "DESTDIR is in steadfast.pc"
[ "$(pkg-config --variable=libdir steadfast)" = "$real/lib64" ] || fail "steadfast.pc has another libdir than LIBDIR"
[ "$(pkg-config --variable=includedir steadfast)" = "$real/headers" ] ||
    fail "steadfast.pc has another includedir than INCLUDEDIR"
staged_flags=$(PKG_CONFIG_SYSROOT_DIR=$stage pkg-config --cflags steadfast)

PKG_CONFIG_PATH=$prefix/lib/pkgconfig
[ "$(pkg-config --variable=libdir steadfast)" = "$prefix/lib" ] || fail "steadfast.pc has another libdir than PREFIX/lib"
[ "$(pkg-config --variable=includedir steadfast)" = "$prefix/include" ] ||
    fail "steadfast.pc has another includedir than PREFIX/include"
flags=$(pkg-config --cflags steadfast)
version=$(pkg-config --modversion steadfast)

case $(uname -s) in
Darwin) shared=$prefix/lib/libsteadfast.dylib soname=libsteadfast.${version%%.*}.dylib ;;
*) shared=$prefix/lib/libsteadfast.so soname=libsteadfast.so.${version%%.*} ;;
esac
static=$prefix/lib/libsteadfast.a
[ -f "$shared" ] && [ -f "$prefix/lib/$soname" ] || fail "libsteadfast.so or $soname is missing, or leads nowhere"
[ "$(name_of "$shared")" = "$soname" ] || fail "the soname is '$(name_of "$shared")', not $soname"

# ---- every header alone, twice, in both languages and precisions -------------------------------------------------------------

headers=0
for path in "$prefix"/include/steadfast/*.h; do
    header=steadfast/${path##*/}
    headers=$((headers + 1))
    printf '#include <%s>\n#include <%s>\nextern int nothing_else;\n' "$header" "$header" >"$work/header.c"
    cp "$work/header.c" "$work/header.cpp"
    for precision in $precisions; do
        flag=$(flag_of "$precision")
        try "$header alone is no C99 in $precision" $compile_c $flags $flag -fsyntax-only "$work/header.c"
        try "$header alone is no C++11 in $precision" $compile_cxx $flags $flag -fsyntax-only "$work/header.cpp"
    done
done

# ---- names: what the headers declare, no more and no less, and each in both precisions ---------------------------------------

# "function NAME" or "object NAME" for each declaration with STF_API: its last word before a parenthesis, a bracket or the end.
cat "$prefix"/include/steadfast/*.h | awk '
    { text = text "\n" $0 }
    END {
        while ((start = index(text, "/*")) > 0) {
            rest = substr(text, start + 2)
            text = substr(text, 1, start - 1) " " substr(rest, index(rest, "*/") + 2)
        }
        gsub(/\/\/[^\n]*/, "", text)
        gsub(/\n[ \t]*#[^\n]*/, "", text)
        count = split(text, declarations, ";")
        for (i = 1; i <= count; i++) {
            if ((at = index(declarations[i], "STF_API")) == 0) continue
            words = substr(declarations[i], at + length("STF_API"))
            kind = sub(/\(.*/, "", words) ? "function" : "object"
            sub(/\[.*/, "", words)
            sub(/[ \t\n]+$/, "", words)
            sub(/.*[^A-Za-z0-9_]/, "", words)
            print kind, words
        }
    }' | sort >"$work/declared"
grep -q '^function stf_' "$work/declared" && grep -q '^object stf_' "$work/declared" ||
    fail "the declarations in the headers are not understood"

while read -r kind name; do
    echo "$name"
    is_once "$name" || echo "${name}_f64"
done <"$work/declared" | sort >"$work/expected"
exported_by "$shared" | sort >"$work/all_exported"
grep '^stf_' "$work/all_exported" >"$work/exported"
if [ -z "$SAN" ]; then # sanitizers export names of their own
    grep -v '^stf_' "$work/all_exported" >"$work/foreign" || true
    none "exported without the prefix stf_" "$work/foreign"
    defined_in "$static" | grep -v '^stf_' >"$work/foreign" || true
    none "global in libsteadfast.a without the prefix stf_" "$work/foreign"
fi
comm -23 "$work/expected" "$work/exported" >"$work/missing"
none "declared in the headers (or the second name of what is) but not exported" "$work/missing"
comm -13 "$work/expected" "$work/exported" >"$work/undeclared"
none "exported but not declared in the headers, or of one name only" "$work/undeclared"

# What the headers mention and the library defines is public, also where STF_API was forgotten.
echo '#include <steadfast/steadfast.h>' >"$work/all.c"
for precision in $precisions; do
    $CC -std=c99 $flags $(flag_of "$precision") -E -P "$work/all.c" | tr -c 'A-Za-z0-9_' '\n' | grep '^stf_' |
        sort -u >"$work/in_$precision"
done
defined_in "$static" | sort >"$work/defined"
sort -u "$work/in_float" "$work/in_double" | comm -12 - "$work/defined" | comm -23 - "$work/exported" >"$work/hidden"
none "in the headers without STF_API" "$work/hidden"

# Types count too: one that holds reals and has one name for both precisions lets a mismatch link.
while read -r name; do
    case $name in *_f64) ;; *) is_once "$name" || echo "$name" ;; esac
done <"$work/in_double" >"$work/single"
none "without a second name in precision.h, and not in is_once of $here/check.sh" "$work/single"

# A program that refers to all that is declared.
{
    echo '#include <stddef.h>'
    echo '#include <steadfast/steadfast.h>'
    echo 'static void (*const functions[])(void) = {'
    sed -n 's/^function \(.*\)/    (void (*)(void))\1,/p' "$work/declared"
    echo '};'
    echo 'static const void *const objects[] = {'
    sed -n 's/^object \(.*\)/    (const void *)\&\1,/p' "$work/declared"
    echo '};'
    echo 'int main(void)'
    echo '{'
    echo '    int missing = 0;'
    echo '    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) missing += functions[i] == NULL;'
    echo '    for (size_t i = 0; i < sizeof objects / sizeof *objects; i++) missing += objects[i] == NULL;'
    echo '    return missing;'
    echo '}'
} >"$work/names.c"
for precision in $precisions; do
    try "what the headers declare does not compile in $precision" \
        $compile_c $flags $(flag_of "$precision") -c "$work/names.c" -o "$work/names-$precision.o"
    undefined_in "$work/names-$precision.o" | grep '^stf_' | sort >"$work/names-$precision"
    [ "$(wc -l <"$work/names-$precision")" -eq "$(wc -l <"$work/declared")" ] ||
        fail "two names of the headers are one symbol in $precision"
done
grep '_f64$' "$work/names-float" >"$work/wrong" || true
none "asked for by a float file" "$work/wrong"
grep -v '_f64$' "$work/names-double" | while read -r name; do is_once "$name" || echo "$name"; done >"$work/wrong"
none "asked for by a double file" "$work/wrong"

# ---- programs ----------------------------------------------------------------------------------------------------------------

shared_libs=$(pkg-config --libs steadfast)
static_libs=$(pkg-config --static --libs steadfast | sed "s,-lsteadfast,$static,") # else the linker takes the shared one
programs=0

# link_and_run NAME LINKER OBJECT...: shared and static; the output of the last run is in $work/output.
link_and_run() {
    name=$1 linker=$2
    shift 2
    for linkage in shared static; do
        program=$work/$name-$linkage
        if [ $linkage = shared ]; then libs=$shared_libs; else libs=$static_libs; fi
        try "$name does not link ($linkage)" $linker "$@" $libs $own_libs -o "$program"
        if libraries_of "$program" | grep -F "$soname" >/dev/null; then found=shared; else found=static; fi
        [ $found = $linkage ] || fail "$name was to link the $linkage library and links the $found one"
        if [ $linkage = shared ]; then
            (eval "$library_path=\$prefix/lib; export $library_path"; "$program") >"$work/output" ||
                fail "$name fails ($linkage)"
        else
            "$program" >"$work/output" || fail "$name fails ($linkage)"
        fi
        programs=$((programs + 1))
        if [ -n "$prints" ] && [ "$(cat "$work/output")" != "$prints" ]; then
            fail "$name prints '$(cat "$work/output")', and pkg-config says $prints"
        fi
    done
}

for precision in $precisions; do
    flag=$(flag_of "$precision")
    own_libs='' prints=''
    link_and_run "names-$precision" "$link_c" "$work/names-$precision.o"

    prints=$version
    try "consumer.c does not compile in $precision" $compile_c $flags $flag -c $here/consumer.c -o "$work/c-$precision.o"
    link_and_run "consumer-c-$precision" "$link_c" "$work/c-$precision.o"
    try "consumer.c does not compile in $precision against DESTDIR" \
        $compile_c $staged_flags $flag -c $here/consumer.c -o "$work/staged.o"

    own_libs=$cxx_runtime
    try "consumer.cpp does not compile in $precision" \
        $compile_cxx $flags $flag -c $here/consumer.cpp -o "$work/cpp-$precision.o"
    link_and_run "consumer-cpp-$precision" "$link_cxx" "$work/cpp-$precision.o"
done

own_libs=-lm prints=''
for precision in $precisions; do
    try "mixed_$precision.c does not compile" $compile_c $flags -c $here/mixed_$precision.c -o "$work/mixed_$precision.o"
done
link_and_run mixed "$link_c" "$work/mixed_float.o" "$work/mixed_double.o"

# ---- a mismatch of precisions does not link ----------------------------------------------------------------------------------

printf '%s\n' '#include <steadfast/steadfast.h>' 'size_t crowd(const stf_world *world);' \
    'size_t crowd(const stf_world *world) { return stf_world_count(world); }' >"$work/crowd.cpp"
printf '%s\n' '#include <steadfast/steadfast.h>' 'size_t crowd(const stf_world *world);' \
    'int main() { return static_cast<int>(crowd(nullptr)); }' >"$work/caller.cpp"
for precision in $precisions; do
    for file in crowd caller; do
        try "$file.cpp does not compile in $precision" \
            $compile_cxx $flags $(flag_of "$precision") -c "$work/$file.cpp" -o "$work/$file-$precision.o"
    done
done
own_libs=$cxx_runtime
for caller in $precisions; do
    for callee in $precisions; do
        if [ $caller = $callee ]; then
            link_and_run "crowd-$caller" "$link_cxx" "$work/caller-$caller.o" "$work/crowd-$callee.o"
        elif $link_cxx "$work/caller-$caller.o" "$work/crowd-$callee.o" $shared_libs $own_libs -o "$work/mismatch" \
            >"$work/mismatch.log" 2>&1; then
            fail "a $caller file links with a function that takes a world of $callee"
        else
            try "a mismatch fails to link, but not for want of its function" grep crowd "$work/mismatch.log"
        fi
    done
done

# ---- and gone ----------------------------------------------------------------------------------------------------------------

try "make uninstall fails" make_it uninstall PREFIX="$prefix"
try "make uninstall with DESTDIR, LIBDIR and INCLUDEDIR fails" make_it uninstall $staged
find "$prefix" "$stage" ! -type d >"$work/left"
none "left by make uninstall" "$work/left"
[ ! -d "$prefix/include/steadfast" ] || fail "make uninstall leaves include/steadfast"

names=$(wc -l <"$work/exported" | tr -d ' ')
echo "consumer: $headers headers, $names exported names, $programs programs: installed, used, gone"
