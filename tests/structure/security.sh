#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Each item of SECURITY.md names a test, and each test that it names exists.
. "$(dirname "$0")/../pipelines/common.sh"

# is_there FILE: pipelines, or the tests of an extension, have it.
is_there() { compgen -G "$source_dir/tests/pipelines/$1" || compgen -G "$source_dir/lib/extensions/*/tests/$1"; } >/dev/null

# Prints the items of $1 that name no test, and the names of tests that do not exist.
wrong() {
    awk '/^## / { inside = 1 } /^## Reporting/ { exit }
         inside && /^(- |##)/ { printf "\n" } inside { printf "%s ", $0 }' "$1" | grep '^- ' |
        grep -vE '`([a-z]+\.[a-z_.]+|[A-Z][A-Za-z]+\.[A-Z*][A-Za-z]*)`' || true
    sed -n '/^## /,/^## Reporting/p' "$1" |
        grep -oE '`([a-z]+\.[a-z_.]+|[A-Z][A-Za-z]+\.[A-Z*][A-Za-z]*)`' | tr -d '`' | sort -u |
        while IFS=. read -r suite name; do
            case $suite in
                pipeline) is_there "$name.sh" ;;
                torture) [ -e "$source_dir/tests/torture/part_$name.py" ] ;;
                structure) [ -e "$source_dir/tests/structure/$name.sh" ] ;;
                dds) is_there "$name.py" ;;
                golden) compgen -G "$source_dir/tests/${name/.//}*" >/dev/null ;;
                [A-Z]*) grep -rqE --include='*_test.cc' "^TEST(_[FP])?\($suite, ${name/\*/}" "$source_dir/lib" ;;
            esac || echo "$suite.$name"
        done
}
found=$(wrong "$source_dir/SECURITY.md")
[ -z "$found" ] || fail "SECURITY.md: no test, or none of that name: $found"

# The test can fail.
printf '## Bounds\n- An item (`pipeline.bounds`)\n  and `pipeline.boundless`.\n- Another, without.\n## Reporting\n' >small
[ "$(wrong small)" = "- Another, without. 
pipeline.boundless" ] || fail "self-test: $(wrong small)"
