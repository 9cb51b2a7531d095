#!/bin/sh
# tests/coverage.sh BUILD TEST...: runs tests that were built with --coverage, and prints how much of the library they reached,
# and what not. A line or a way out of a condition counts once, however often its source was compiled (precisions,
# instruction sets), and is reached if any of these copies reached it. Fails below the shares that are wanted.
set -eu
LINES_WANTED=98 WAYS_WANTED=95 # percent

build=$1
shift
find "$build" -name '*.gcda' -exec rm {} +
for test in "$@"; do
    echo "  $test"
    "$test" >"$build/coverage.log" 2>&1 || { cat "$build/coverage.log" >&2; exit 1; }
done

# gcov's text: "count:line:source", and below it a line "branch n taken count" for each way out of its conditions.
find "$build" -path "$build/*/src/*" -name '*.gcda' -exec gcov -b -c -t {} + 2>/dev/null |
awk -v lines_wanted="$LINES_WANTED" -v ways_wanted="$WAYS_WANTED" '
function percent(part, all) { return all ? sprintf("%.1f %%", 100 * part / all) : "-" }
function row(name, lines, lines_reached, ways, ways_reached) {
    printf "%-32s %6d %8d %9s %6d %8d %9s\n", name, lines, lines_reached, percent(lines_reached, lines), ways, ways_reached, \
        percent(ways_reached, ways)
}
/^ *-: *0:Source:/ { file = $0; sub(/.*Source:/, "", file); is_ours = file ~ /^(src|include)\//; next }
!is_ours { next }
/^ *[^: ]+: *[1-9][0-9]*:/ {
    split($0, field, ":")
    place = file SUBSEP field[2] + 0
    sub(/^[^:]*:[^:]*: */, "")
    source[place] = $0
    if (field[1] ~ /-/) next
    if (!(place in reached)) { reached[place] = 0; lines[file]++ }
    if (field[2] + 0 > last[file]) last[file] = field[2] + 0
    if (field[1] + 0 > 0 && !reached[place]++) lines_reached[file]++
    next
}
/^branch/ {
    way = place SUBSEP $2
    if (!(way in taken)) { taken[way] = 0; ways[file]++; ways_of[place]++ }
    if ($4 + 0 > 0 && !taken[way]++) { ways_reached[file]++; ways_reached_of[place]++ }
}
END {
    printf "%-32s %6s %8s %9s %6s %8s\n", "", "lines", "reached", "", "ways", "taken"
    while (("ls include/steadfast/*.h src/*.[ch] src/*/*.[ch]" | getline file) > 0) {
        if (!lines[file]) continue
        row(file, lines[file], lines_reached[file], ways[file], ways_reached[file])
        all_lines += lines[file]; all_lines_reached += lines_reached[file]
        all_ways += ways[file]; all_ways_reached += ways_reached[file]
        for (n = 1; n <= last[file]; n++) {
            place = file SUBSEP n
            if ((place in reached) && !reached[place])
                left = left sprintf("%s:%d: not reached: %s\n", file, n, source[place])
            else if (ways_reached_of[place] < ways_of[place])
                left = left sprintf("%s:%d: %d of %d ways: %s\n", file, n, ways_reached_of[place], ways_of[place],
                                    source[place])
        }
    }
    row("all", all_lines, all_lines_reached, all_ways, all_ways_reached)
    printf "\n%s", left
    if (100 * all_lines_reached < lines_wanted * all_lines || 100 * all_ways_reached < ways_wanted * all_ways) {
        print "steadfast: tests have to reach " lines_wanted " % of lines, " ways_wanted " % of ways" > "/dev/stderr"
        exit 1
    }
}'
