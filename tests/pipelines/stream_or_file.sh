#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Through a pipe or through files: the same figures and the same picture.
. "$(dirname "$0")/common.sh"

envc "$scenes/ispace.env" -o room.glb
placing=(--sensor urg-04lx:2 --strategy grid -X 5 -Y 5 --deg 8)
arrange room.glb "${placing[@]}" -o best.3dm
coverage room.glb best.3dm -o file.png >file.txt

arrange room.glb "${placing[@]}" | coverage room.glb -o pipe.png >pipe.txt
expect_same file.png pipe.png "another picture through the pipe"
expect_same file.txt pipe.txt "another report through the pipe"

arrange room.glb "${placing[@]}" | tee copy.3dm | coverage room.glb - -o dash.png >dash.txt
expect_same file.png dash.png "another picture with -"
expect_same best.3dm copy.3dm "another layout on stdout than with -o"

# Messages go to stderr: a summary in a line; progress only on request; with -q no line.
arrange room.glb "${placing[@]}" --progress 2>talk | cmp - best.3dm || fail "progress on stdout"
grep -q '100 %' talk || fail "--progress shows nothing"
arrange room.glb "${placing[@]}" 2>talk | cmp - best.3dm || fail "another layout"
[ "$(wc -l <talk)" -eq 1 ] || fail "more than a line of talk: $(cat talk)"
grep -q 'bound .* over .* candidates .* cells' talk || fail "it does not say what the bound is over"
arrange room.glb "${placing[@]}" -q 2>talk | cmp - best.3dm || fail "another layout"
[ ! -s talk ] || fail "talk in spite of -q: $(cat talk)"

# ENV may be the source instead of the compiled form, or left to the layout.
coverage "$scenes/ispace.env" best.3dm -o source.png >source.txt
expect_same file.txt source.txt "another report from the source than from the compiled form"
coverage best.3dm >named.txt
expect_same file.txt named.txt "another report where the layout names the environment"
scan room.glb best.3dm >a.jsonl
scan room.glb <best.3dm >b.jsonl
cmp <(tail -n +2 a.jsonl) <(tail -n +2 b.jsonl) || fail "another scan from stdin"

# The layout names its ENV relative to itself, and never by an absolute path.
mkdir sub
arrange "$scratch/room.glb" "${placing[@]}" -o sub/best.3dm
(cd / && coverage "$scratch/sub/best.3dm" >"$scratch/elsewhere.txt")
expect_same file.txt elsewhere.txt "the environment is not found from another folder"
! grep -q "$scratch" sub/best.3dm best.3dm || fail "an absolute path in a layout"
for stream in - /dev/stdin; do
    arrange "$stream" "${placing[@]}" <room.glb >streamed.3dm
    grep -q '^environment digest=' streamed.3dm ||
        fail "not a digest alone for an environment from a stream: $(grep '^env' streamed.3dm)"
    grep -q '^# arrange - ' streamed.3dm || fail "a stream is no - in history: $(sed -n 2p streamed.3dm)"
done

# Another room than the one the layout was made for is refused if that is asked for.
expect_error 1 coverage "$scenes/crowded.env" best.3dm --same-environment
expect_status 0 coverage "$scenes/crowded.env" best.3dm --any-environment

# TERM ends the wait for the reader of a pipe, also in tools that end their work in order at TERM.
mkfifo unread
for command in "arrange $data/room.env --sensor laser,range=1 --candidates 1,1,4 -q -o unread" \
    "simrun $data/room.env --until 1000 --port-file unread"; do
    # shellcheck disable=SC2086
    interrupt TERM 2 timeout --preserve-status 60 $command
done
