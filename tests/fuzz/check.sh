#!/bin/sh
# tests/fuzz/check.sh [--list]: whether the fuzz target `calls` calls every public function; and in which files.
set -eu

functions=$(sed -n 's/^STF_API .*[ *]\(stf_[a-z0-9_]*\)(.*/\1/p' include/steadfast/*.h | sort -u)
declared=$(grep -c '^STF_API [^e]' include/steadfast/*.h | awk -F: '{ sum += $2 } END { print sum }')
[ "$(echo "$functions" | wc -l)" -eq "$declared" ] || { echo "fuzzing: not every STF_API could be read" >&2; exit 1; }

uncalled=
for function in $functions; do
    files=$(grep -l "\<$function(" tests/fuzz/calls.c tests/fuzz/model.c tests/fuzz/calls/*.c | sed 's/.*\///' | tr '\n' ' ')
    [ $# -eq 0 ] || printf '%-32s %s\n' "$function" "$files"
    [ -n "$files" ] || uncalled="$uncalled $function"
done
[ -z "$uncalled" ] || { echo "fuzzing: no operation in tests/fuzz/calls/ calls:$uncalled" >&2; exit 1; }
