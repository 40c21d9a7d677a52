# SPDX-License-Identifier: GPL-3.0-or-later
# awk -v shell=bash|zsh|fish -v only=TOOL -f completions.awk HELP…: completions of a shell from the output
# of --help: of the command `ispace`, or of one tool where `only` names it. HELP are files that
# begin with `Usage: TOOL`, that of ispace first.

function trim(text) {
    gsub(/^ +| +$/, "", text)
    return text
}

# "  -o, --output FILE   where …" begins an option, deeper lines continue its text; under any heading.
/^Usage: / && !($2 in seen) { tool = $2; seen[tool] = 1; if (tool != "ispace") tools[++n_tools] = tool; part = "" }
/^[A-Z][A-Za-z, ]*:$/ { part = $0; next }
/^[A-Z]/ { part = "" }
part == "Tools:" && /^  [a-z]/ { name = $1; $1 = ""; summary[name] = trim($0) }
part != "" && /^  -/ {
    at = ++count[tool]
    # Its text begins in column 27, in the next line where there is no room for it.
    has_text = length($0) > 26 && substr($0, 25, 2) == "  "
    signature = trim(has_text ? substr($0, 1, 26) : $0)
    text[tool, at] = has_text ? trim(substr($0, 27)) : ""
    n = split(signature, words, ", ")
    cut = index(words[n], " ")
    value[tool, at] = cut ? substr(words[n], cut + 1) : ""
    if (cut) words[n] = substr(words[n], 1, cut - 1)
    names[tool, at] = ""
    for (i = 1; i <= n; i++) names[tool, at] = names[tool, at] (i > 1 ? " " : "") words[i]
    next
}
part != "" && part != "Examples:" && /^          / { text[tool, count[tool]] = trim(text[tool, count[tool]] " " trim($0)) }

# The kind of an option's value: "words a b", "files", "folders", "models", "" for nothing, "any" for no value.
function kind(tool, at,    v, list) {
    v = value[tool, at]
    if (v == "") return "any"
    if (v ~ /^[a-z0-9][a-z0-9.-]*([|][a-z0-9][a-z0-9.-]*)+$/) {
        gsub(/[|]/, " ", v)
        return "words " v
    }
    if (v ~ /^MODEL/) return "models"
    if (v ~ /(^|[^A-Z])DIR$/) return "folders"
    if (v ~ /(^|[^A-Z])(FILE|DIR|LAYOUT|ENV|PATH)/) return "files"
    return ""
}

# The first sentence part of a help text, fit for a list.
function brief(tool, at,    t) {
    t = text[tool, at]
    sub(/ \((default|repeatable)[^)]*\)/, "", t)
    return t
}

function quoted(t) {
    gsub(/'/, "'\\''", t)
    return "'" t "'"
}

END {
    if (n_tools == 0) { print "completions.awk: no help of a tool" > "/dev/stderr"; exit 1 }
    if (shell == "bash") bash()
    else if (shell == "zsh") zsh()
    else fish()
}

# The part of a completion that needs no table.
function paste_rest(file,    line) {
    while ((getline line < file) > 0) if (line !~ /^# (SPDX|shellcheck)/) print line
}

function bash(    t, i, k, all, patterns) {
    print "# bash completion of ispace, made of what its tools print for --help."
    if (only != "") {
        print ". \"${BASH_SOURCE[0]%/*}/ispace\" && complete -F _ispace " only
        return
    }
    print "_ispace_options() {\n    case $1 in"
    for (t = 1; t <= n_tools; t++) {
        all = ""
        for (i = 1; i <= count[tools[t]]; i++) all = all " " names[tools[t], i]
        print "    " tools[t] ") echo " quoted(substr(all, 2)) " ;;"
    }
    print "    esac\n}"
    print "_ispace_value() {\n    case $1:$2 in"
    for (t = 1; t <= n_tools; t++)
        for (i = 1; i <= count[tools[t]]; i++) {
            k = kind(tools[t], i)
            if (k == "any") continue
            patterns = tools[t] ":" names[tools[t], i]
            gsub(/ /, "|" tools[t] ":", patterns)
            print "    " patterns ") echo " quoted(k == "" ? "nothing" : k) " ;;"
        }
    print "    esac\n}"
    all = ""
    for (t = 1; t <= n_tools; t++) all = all " " tools[t]
    print "_ispace_tools=" quoted(substr(all, 2))
    paste_rest(rest)
    print "complete -F _ispace ispace"
}

function zsh_action(k) {
    if (k ~ /^words/) return "(" substr(k, 7) ")"
    if (k == "files") return "_files"
    if (k == "folders") return "_files -/"
    if (k == "models") return "_ispace_models"
    return " "
}

# With a backslash before each of the characters of `specials`.
function escaped(t, specials,    i, c, result) {
    for (i = 1; i <= length(t); i++) {
        c = substr(t, i, 1)
        result = result (index(specials, c) ? "\\" : "") c
    }
    return result
}

function zsh_text(t) {
    return escaped(t, "[]:\\")
}

function zsh(    t, i, j, k, n, words, spec, all) {
    if (only != "") {
        print "#compdef " only "\n_ispace \"$@\""
        return
    }
    print "#compdef ispace\n# zsh completion of ispace, made of what its tools print for --help."
    print "_ispace_tools=("
    for (t = 1; t <= n_tools; t++) print "    " quoted(tools[t] ":" zsh_text(summary[tools[t]]))
    print ")"
    for (t = 1; t <= n_tools; t++) {
        print "_ispace_" tools[t] "() {\n    _arguments \\"
        for (i = 1; i <= count[tools[t]]; i++) {
            k = kind(tools[t], i)
            n = split(names[tools[t], i], words, " ")
            for (j = 1; j <= n; j++) {
                spec = text[tools[t], i] ~ /\(repeatable\)/ ? "*" : "(" names[tools[t], i] ")"
                spec = spec words[j] (k != "any" && words[j] ~ /^--/ ? "=" : "") "[" zsh_text(brief(tools[t], i)) "]"
                if (k != "any") spec = spec ":" zsh_text(value[tools[t], i]) ":" zsh_action(k)
                print "        " quoted(spec) " \\"
            }
        }
        print "        '*:file:_files'\n}"
    }
    paste_rest(rest)
}

function fish_quoted(t) {
    return "'" escaped(t, "\\'") "'"
}

# Options of a tool; `start` is the command and when they hold.
function fish_options(tool, start,    i, j, k, n, words, line) {
    for (i = 1; i <= count[tool]; i++) {
        k = kind(tool, i)
        n = split(names[tool, i], words, " ")
        line = start
        for (j = 1; j <= n; j++)
            if (words[j] ~ /^--/) line = line " -l " substr(words[j], 3)
            else line = line (length(words[j]) == 2 ? " -s " : " -o ") substr(words[j], 2)
        if (k ~ /^words/) line = line " -x -a " fish_quoted(substr(k, 7))
        else if (k == "models") line = line " -x -a '(ispace scan --list-models 2>/dev/null | string match -r \"^[a-z0-9][^ ]*\")'"
        else if (k == "folders") line = line " -x -a '(__fish_complete_directories)'"
        else if (k == "files") line = line " -r -F"
        else if (k == "") line = line " -x"
        print line " -d " fish_quoted(brief(tool, i))
    }
}

function fish(    t) {
    print "# fish completion of ispace, made of what its tools print for --help."
    if (only != "") {
        fish_options(only, "complete -c " only)
        return
    }
    print "complete -c ispace -n __fish_use_subcommand -f"
    for (t = 1; t <= n_tools; t++)
        print "complete -c ispace -n __fish_use_subcommand -a " tools[t] " -d " fish_quoted(summary[tools[t]])
    print "complete -c ispace -n __fish_use_subcommand -a help -d 'open a manual page'"
    print "complete -c ispace -f -n '__fish_seen_subcommand_from help' -a 'env 3dm yaml protocol wire'"
    for (t = 1; t <= n_tools; t++) {
        print "complete -c ispace -f -n '__fish_seen_subcommand_from help' -a " tools[t]
        fish_options(tools[t], "complete -c ispace -n '__fish_seen_subcommand_from " tools[t] "'")
    }
}
