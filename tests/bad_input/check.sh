#!/bin/sh
# tests/bad_input/check.sh BUILD: whether every function of the public headers is in the table of tests/test_bad_input.c.
set -eu

declared=$(sed -n 's/^STF_API .*[ *]\(stf_[a-z0-9_]*\)(.*/\1/p' include/steadfast/*.h | sort -u)
listed=$("$1/tests/test_bad_input-f32" --list | sort -u)
[ -n "$declared" ] && [ "$declared" = "$listed" ] && exit

echo "bad input: the table of tests/test_bad_input.c lacks what has < here, and has no reason for what has >:" >&2
printf '%s\n' "$declared" >"$1/declared.txt"
printf '%s\n' "$listed" | diff "$1/declared.txt" - | grep '^[<>]' >&2
exit 1
