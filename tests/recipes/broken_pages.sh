#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# recipes.py passes a page that holds, and names the line of each recipe that does not.
. "$(dirname "$0")/../pipelines/common.sh"
run() { /usr/bin/python3 -B "$source_dir/tests/recipes/recipes.py" "$1" >out 2>err; }

cat >whole.md <<'END'
Lines of a shell, a file and the command that reads it, a server, and a session with it:

    envc crowded.env -o room.glb
    [ -s room.glb ]

<!-- recipe: file small.env: envc small.env --check -->

    #env 1
    ispace size=4,4

<!-- recipe: printed by: echo after 0.25 s -->

    after 0.75 s

<!-- recipe: serves -->

    simrun ispace.env ispace.3dm --listen 127.0.0.1:7001

<!-- recipe: session -->

    $ simrun ispace.env ispace.3dm --clock step --listen 127.0.0.1:7001 &
    $ nc 127.0.0.1 7001
    > ISPACE 1
    < QUIT
    > OK QUIT

<!-- recipe: not run: needs docker -->

    docker run ispace
END
run whole.md || fail "a page that holds: $(cat out err)"
grep -qx '6 recipes, 0 of them broken' out || fail "$(cat out)"

# broken LINE SED: the page with this change fails at this line.
broken() {
    sed "$2" whole.md >changed.md
    ! cmp -s whole.md changed.md || fail "no change by $2"
    ! run changed.md || fail "passes in spite of $2"
    grep -q "changed.md:$1: " err || fail "$2: not line $1: $(cat err)"
}
broken 3 's/crowded.env -o/no.env -o/'
broken 4 's/ -s room.glb/ -s other.glb/'
broken 8 's/ispace size=4,4/ispace size=4,/'
broken 13 's/after 0.75 s/before 0.75 s/'
broken 17 's/simrun ispace.env ispace.3dm --listen/simrun no.env --listen/'
broken 25 's/OK QUIT/OK/'
broken 29 's/not run: needs docker/not run:/'
broken 29 's/not run: needs docker/later/'
broken 29 's/^<!-- recipe: not run.*/So:/'

cat >page.1 <<'END'
.SH DESCRIPTION
.EX
a synopsis of no concern
.EE
.SH EXAMPLES
.EX
printf '%s\en' a | grep \-qx \(aqa\(aq
false
.EE
END
! run page.1 || fail "false passes"
grep -q 'page.1:8: status 1' err || fail "$(cat err)"
echo 'Without recipes' >empty.md
! run empty.md || fail "a page without recipes passes"
