#!/bin/sh
# tests/trade/check.sh BUILD: the command trade as a user calls it: what it refuses, answers and writes. Writes only under BUILD.
set -eu

build=$1
trade=$build/trade
work=$build/trade-check
fail() { echo "trade: $*" >&2; exit 1; }

rm -rf "$work"
mkdir -p "$work"

# ---- refusals: exit code 2, nothing on stdout, one line on stderr ------------------------------------------------------------

refuses() {
    code=0
    "$trade" "$@" >"$work/out" 2>"$work/err" || code=$?
    [ $code = 2 ] || fail "$* ends with $code, not 2"
    [ ! -s "$work/out" ] || fail "$* prints on stdout"
    [ "$(wc -l <"$work/err")" -eq 1 ] && grep -q '^trade: ' "$work/err" || fail "$* does not say in one line what is wrong"
}

refuses --nonsense
refuses drag
refuses --scene
refuses --scene --help
refuses --scene moon
refuses --integrator leapfrog
refuses --precision half
for number in 0 -1 nan inf '' ' 1' 1x; do
    refuses --tolerance "$number"
    refuses --budget "$number"
    refuses --levels "$number"
    refuses --repeats "$number"
done
refuses --levels 21
for shard in 0/2 3/2 1/0 1 /2 1/ 1/2/3 a/b -1/2 99999999999/99999999999; do refuses --shard "$shard"; done
refuses --csv "$work/no/such/folder.csv"
refuses --json "$work"
refuses --pictures "$work/no/such/folder"
refuses --tolerance 1e-3 --csv "$work/x.csv"
refuses --shard 1/2 --markdown

"$trade" --help | grep -q -e --shard || fail "--help does not tell of --shard"
"$trade" --list | grep -q solar_system || fail "--list does not list the scenes"

# ---- answers -------------------------------------------------------------------------------------------------------------------

quickly="--repeats 1"
"$trade" --scene oscillator --tolerance 1e-3 --budget 1e9 $quickly >"$work/answer"
[ "$(wc -l <"$work/answer")" -eq 2 ] || fail "two questions do not have two answers"
grep -q '^oscillator: cheapest for an error of 0.001 of the size, 0.001 m.* at .* s: .* ns/s, largest error .* m$' \
    "$work/answer" || fail "the answer to a tolerance is: $(cat "$work/answer")"
grep -q '^oscillator: most accurate for 1e+09 ns/s .*rk4 in double' "$work/answer" ||
    fail "the answer to a budget is: $(cat "$work/answer")"

# ---- shards: their CSVs one behind the other are the whole one, but for order and costs -----------------------------------

without_costs() { cut -d, -f1-11,15- "$1" | sort; }

"$trade" --scene oscillator --levels 2 $quickly --csv "$work/whole.csv" >"$work/table"
for shard in 1 2 3 4; do
    "$trade" --scene oscillator --levels 2 $quickly --shard $shard/4 --csv "$work/part-$shard.csv" >"$work/out"
    [ ! -s "$work/out" ] || fail "a shard prints a table"
done
cat "$work"/part-*.csv >"$work/parts.csv"
without_costs "$work/whole.csv" >"$work/whole"
without_costs "$work/parts.csv" >"$work/parts"
[ "$(wc -l <"$work/whole")" -eq 29 ] || fail "7 integrators, 2 steps and 2 precisions are not 28 rows and a head"
cmp -s "$work/whole" "$work/parts" || fail "the shards' CSVs do not make the whole one"
"$trade" --scene oscillator --levels 2 $quickly --shard 1/1 >"$work/out"
without_costs "$work/out" | cmp -s - "$work/whole" || fail "--shard 1/1 without --csv is not the whole CSV on stdout"

# ---- the table: every row has an order near the method's, in double, once steps are short ---------------------------------

"$trade" --scene oscillator --precision double $quickly >"$work/table"
for method in explicit_euler:1 semi_implicit_euler:1 midpoint:2 improved_euler:2 rk4:4 position_verlet:2 velocity_verlet:2; do
    awk -v name="${method%:*}" -v order="${method#*:}" '
        { sub(/^\*/, "") }
        $1 == name && $2 == "double" && $10 != "-" { seen = $10 }
        END { exit !(seen > order - 0.1 && seen < order + 0.1) }' "$work/table" || fail "the table has a wrong order for $method"
done
[ "$(grep -c '^cheapest for an error of' "$work/table")" -eq 3 ] || fail "the table does not end with three picks"

# ---- pictures: without gnuplot all but them is there, and it says so -------------------------------------------------------

mkdir "$work/without" "$work/with"
PATH=/nonexistent "$trade" --scene drag --levels 2 $quickly --pictures "$work/without" >"$work/out" 2>"$work/err" ||
    fail "without gnuplot it fails"
grep -q 'gnuplot is not there.*make deps' "$work/err" || fail "without gnuplot it does not say so"
for file in trade_drag.dat trade_drag.gp stability.dat stability.theory stability.gp; do
    [ -s "$work/without/$file" ] || fail "without gnuplot $file is not there"
done

# Theory and measurement agree in every cell of the map that is off the boundary: its points are among the theory's.
awk 'FNR == 1 { file++; integrator = 0 }
    /^# [a-z0-9_]*$/ { integrator++ }
    /^[0-9]/ && file == 1 { growth[integrator, $1, $2] = $3; cells++ }
    /^[0-9]/ && file == 2 && (integrator, $1, $2) in growth {
        found++
        if (($3 > 0.05 && growth[integrator, $1, $2] <= 0) || ($3 < -0.05 && growth[integrator, $1, $2] >= 0)) wrong++
    }
    END { exit !(cells == 7 * 80 * 80 && found == cells && wrong == 0) }' \
    "$work/without/stability.dat" "$work/without/stability.theory" || fail "the stability map is not the theory's"

pictures=
if command -v gnuplot >/dev/null 2>&1; then
    "$trade" --scene drag --levels 2 $quickly --pictures "$work/with" >"$work/out" 2>"$work/err" || fail "no pictures"
    [ ! -s "$work/err" ] || fail "gnuplot complains: $(head -n 3 "$work/err")"
    for name in trade_drag stability; do
        for format in svg png; do [ -s "$work/with/$name.$format" ] || fail "$name.$format is not there"; done
    done
    pictures=", pictures"
fi

echo "trade: refusals, answers, shards, table$pictures"
