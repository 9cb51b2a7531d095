# Every one-token fault of the C files given, a line each: file, line, column, length, kind, what stands there instead (tabs
# between). Comments, strings, characters and directives other than #define have none.

function fault(from, length_, kind, instead) {
    print FILENAME "\t" FNR "\t" from "\t" length_ "\t" kind "\t" instead
}

# The line with comments, strings and characters blanked, in its own length.
function code_of(line,    code, part) {
    code = ""
    while (line != "") {
        if (in_comment) {
            part = match(line, /\*\//) ? RSTART + 1 : length(line)
            in_comment = RSTART == 0
        } else if (match(line, /^\/\*/)) {
            in_comment = 1
            part = 2
        } else if (match(line, /^"([^"\\]|\\.)*"/) || match(line, /^'([^'\\]|\\.)*'/)) {
            part = RLENGTH
        } else {
            code = code substr(line, 1, 1)
            line = substr(line, 2)
            continue
        }
        code = code sprintf("%" part "s", "")
        line = substr(line, part + 1)
    }
    return code
}

# A number N becomes N + 1 and N - 1 if it is a plain count, else twice itself.
function number_faults(at, text) {
    if (text ~ /^[0-9]+$/) {
        fault(at, length(text), "constant", text + 1)
        if (text > 0)
            fault(at, length(text), "constant", text - 1)
    } else if (text + 0 == 0 && text !~ /^0x/) {
        fault(at, length(text), "constant", "(" text " + 1)")
    } else {
        fault(at, length(text), "constant", "(2 * " text ")")
    }
}

function operator_faults(at, text, spaced) {
    if (text in opposite && (spaced || text !~ /^[*\/]$/))
        fault(at, length(text), kind_of[text], opposite[text])
    if (text in boundary)
        fault(at, length(text), "comparison", boundary[text])
}

# A whole statement on a line of its own, no declaration.
function is_statement(code) {
    return previous ~ /([;{}:)]|else|^)$/ && code ~ /^ +[a-z_*(][^{}]*;$/ && gsub(/\(/, "(", code) == gsub(/\)/, ")", code) &&
           (code ~ /^ +(return|break|continue)/ || code !~ /^ +(const |static |struct )*[a-z_0-9]+ +\**[a-z_0-9]+( =|;|,|\[)/)
}

BEGIN {
    split("+ - += -= ++ -- * / *= /=", pairs, " ")
    for (i = 1; i in pairs; i++) {
        opposite[pairs[i]] = pairs[i % 2 ? i + 1 : i - 1]
        kind_of[pairs[i]] = "sign"
    }
    split("< >= > <= == != >= < <= > != ==", pairs, " ")
    for (i = 1; i in pairs; i += 2) {
        opposite[pairs[i]] = pairs[i + 1]
        kind_of[pairs[i]] = "comparison"
    }
    opposite["&&"] = "||"; opposite["||"] = "&&"; opposite["true"] = "false"; opposite["false"] = "true"; opposite["!"] = " "
    kind_of["&&"] = kind_of["||"] = kind_of["true"] = kind_of["false"] = kind_of["!"] = "logic"
    opposite["x"] = "y"; opposite["y"] = "z"; opposite["z"] = "x"
    kind_of["x"] = kind_of["y"] = kind_of["z"] = "index"
    boundary["<"] = "<="; boundary["<="] = "<"; boundary[">"] = ">="; boundary[">="] = ">"
}

FNR == 1 { in_comment = 0; previous = "" }

{
    code = code_of($0)
    sub(/ +$/, "", code)
    if (code == "" || code ~ /^ *#/ && code !~ /^# *define [A-Z_a-z0-9]+(\([^)]*\))? /)
        next
    if (is_statement(code)) {
        match(code, /[^ ]/)
        fault(RSTART, length(code) - RSTART + 1, "dropped", ";")
    }
    at = match(code, /^# *define [A-Z_a-z0-9]+/) ? RLENGTH + 1 : 1
    before = ""
    while (at <= length(code)) {
        rest = substr(code, at)
        if (match(rest, /^ +/)) {
            at += RLENGTH
            continue
        }
        if (!match(rest, /^[A-Za-z_][A-Za-z_0-9]*/) &&
            !match(rest, /^(0x[0-9a-fA-F]+|[0-9]+\.?[0-9]*([eE][-+]?[0-9]+)?)[uUlLfF]*/) &&
            !match(rest, /^(->|<<=|>>=|<<|>>|\+\+|--|[-+*\/%&|^<>=!]=|&&|\|\|)/))
            RLENGTH = 1
        text = substr(rest, 1, RLENGTH)
        spaced = substr(code, at - 1, 1) == " " && substr(rest, RLENGTH + 1, 1) ~ /^ ?$/
        if (text ~ /^[0-9]/)
            number_faults(at, text)
        else if (text ~ /^[-+]$/ && before !~ /^([A-Za-z_0-9].*|\)|\])$/ || text == "-" && before == "return")
            fault(at, 1, "sign", " ")
        else if (text ~ /^[xyz]$/ && before !~ /^(\.|->)$/)
            ;
        else if (text ~ /^STF_ERROR_/)
            fault(at, RLENGTH, "constant", "STF_OK")
        else
            operator_faults(at, text, spaced)
        if (before == "[" && match(rest, /^[a-z_]+\]/))
            fault(at, RLENGTH - 1, "index", text " + 1")
        before = text
        at += length(text)
    }
    previous = code
}
