#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The examples of each --help run as they stand, and each tool has two.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/../simrun/server.sh"

cp "$scenes/ispace.env" room.env
arrange room.env --sensor urg-04lx:2 --strategy grid -X 3 -Y 3 -q -o layout.3dm
cp "$scenes/ispace.3dm" robots.3dm
envc room.env -q -o flat.dxf
printf '%s\n' '0 0 0 0.2 0 0 0 1' '0.1 0.1 0 0.2 0 0 0 1' >way.txt

for tool in envc arrange scan coverage simrun; do
    "$tool" --help | sed -n "/^Examples:/,/^Exit status/s/^  \($tool .*\)/\1/p" >examples
    [ "$(wc -l <examples)" -eq 2 ] || fail "$tool --help has $(wc -l <examples) examples"
    while read -r example; do
        case $example in
            *--web*)
                $example >address 2>said &
                server=$!
                eventually "the address of $example" test -s address
                kill "$server"
                wait "$server" || fail "$example: $(cat said)"
                ;;
            *)
                status=0
                $example >out 2>said || status=$?
                # 3: the requirement of the example is not met in this room.
                [ "$status" -eq 0 ] || [ "$status" -eq 3 ] || fail "$example: status $status, $(cat said)"
                ;;
        esac
    done <examples
done
