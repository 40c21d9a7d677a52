#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# type_names.sh [ROOT]: no type of the core, and none of an extension, has the name of another there: they stand in one
# namespace, and two of one name in two files are one to the linker, whichever it meets first. Before it checks
# ROOT it shows on a made-up tree that it can fail.
set -euo pipefail
root=${1:-$(cd "$(dirname "$0")/../.." && pwd)}

# Prints one line per name that two files of lib/ define. $1: a tree with lib/. Skips types in unnamed namespaces and in
# other types; in a named namespace inside of ispace they count with its name. Modules are separate programs.
doubled() {
    (cd "$1" && find lib \( -name '*.h' -o -name '*.cc' \) ! -path 'lib/engine/io/module/*' |
        LC_ALL=C sort | xargs awk '
    FNR == 1 { depth = 0; unnamed = 0; space = "" }
    /^namespace( [A-Za-z_0-9:]+)? *[{]/ {
        name = $2 == "{" ? "" : $2
        spaces[++depth] = name
        if (name == "") unnamed++
        next
    }
    /^}  \/\/ namespace/ {
        if (depth > 0 && spaces[depth] == "") unnamed--
        if (depth > 0) depth--
        next
    }
    unnamed == 0 && /^(struct|class|union|enum|using) / {
        line = $0
        sub(/^enum (class|struct) /, "enum ", line)
        sub(/alignas[(][^)]*[)] */, "", line)
        sub(/\[\[[^]]*\]\] */, "", line)
        split(line, word, /[ :;={<(]+/)
        kind = word[1]; name = word[2]
        if (name == "namespace" || name !~ /^[A-Z]/) next
        if (kind == "using" && line !~ /=/) next
        # A forward declaration ends at once; a specialisation belongs to its template.
        if (kind != "using" && line ~ /^[a-z]+ [A-Za-z_0-9]+( *: *[a-z_:0-9]+)? *;/) next
        if (line ~ /^[a-z]+ [A-Za-z_0-9]+</) next
        if (line ~ /^[a-z]+ [A-Za-z_0-9]+::/) next
        full = ""
        for (i = 1; i <= depth; i++) full = full spaces[i] "::"
        full = full name
        if (full in where && where[full] != FILENAME)
            print FILENAME ":" FNR ": " full " is defined in " where[full] " too"
        else
            where[full] = FILENAME
    }')
}

fail() {
    echo "type_names: $*"
    exit 1
}

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
# expect FIRST SECOND WANTED: two files with this text name a type twice iff WANTED is yes.
expect() {
    rm -rf "$tree/lib"
    mkdir -p "$tree/lib/kernel/geom" "$tree/lib/kernel/env"
    printf 'namespace ispace {\n%b\n}  // namespace ispace\n' "$1" >"$tree/lib/kernel/geom/a.h"
    printf 'namespace ispace {\n%b\n}  // namespace ispace\n' "$2" >"$tree/lib/kernel/env/b.cc"
    local found
    found=$(doubled "$tree")
    if [ "$3" = yes ]; then
        [ -n "$found" ] || fail "self-test: not noticed: $1 | $2"
    else
        [ -z "$found" ] || fail "self-test: wrongly reported: $found"
    fi
}
expect 'struct Look {' 'struct Look {' yes
expect 'struct Look {' 'class Look : public Other {' yes
expect 'using Quaternion = std::array<double, 4>;' 'struct Quaternion {' yes
expect 'enum class Kind { A, B };' 'enum class Kind : char {' yes
expect 'template <bool kBounded>\nclass Look {' 'struct Look {' yes
expect 'struct Point {' 'namespace {\nstruct Own {\n}  // namespace\nstruct Point {' yes
expect 'struct Look;' 'struct Look {' no
expect 'enum class Kind : char;' 'enum class Kind : char {' no
expect 'struct Look {' 'namespace {\nstruct Look {\n}  // namespace' no
expect 'struct Look {' 'namespace test {\nstruct Look {\n}  // namespace test' no
expect 'class Other {\n    struct Look {' 'struct Look {' no
expect 'using std::min;' 'using std::min;' no
expect 'struct VisibilityMap {' 'struct VisibilityMap::Data {' no

found=$(doubled "$root")
[ -z "$found" ] || fail "$(printf 'names of types stand for two things\n%s' "$found")"
[ -n "$(ls "$root"/lib/kernel/base/*.cc)" ] || fail "no sources in $root"
