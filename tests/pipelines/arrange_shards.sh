#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# arrange --shard and --merge: the work that shards divide (candidates, starts, the tree of a proof) merges to the
# result of one run.
. "$(dirname "$0")/common.sh"

envc "$scenes/crowded.env" -o room.glb
laser=(arrange room.glb --sensor laser,range=4,fov=180:3 -q)
coarse=(--candidates 0.5,0.5,8)

# in_shards N COMMAND…: ./whole.3dm
in_shards() {
    local n=$1 i
    shift
    rm -f s*.part
    for ((i = 1; i <= n; ++i)); do "$@" --shard "$i/$n" -o "s$i.part"; done
    arrange -q --merge s*.part -o whole.3dm
}
joins() {
    local what=$1 counts=$2 n
    shift 2
    "$@" -o single.3dm
    for n in $counts; do
        in_shards "$n" "$@"
        expect_same whole.3dm single.3dm "$what: $n shards are not the whole"
    done
}
joins greedy "1 2 3 7 40" "${laser[@]}" --optimize greedy
joins "greedy cameras" "3" arrange "$data/room.env" -q --sensor camera:2 --candidates 1,1,4 --optimize greedy
joins "a grid" 2 "${laser[@]}" --strategy grid -X 6 -Y 6
"${laser[@]}" "${coarse[@]}" -o single.3dm
in_shards 2 "${laser[@]}" "${coarse[@]}" --share candidates
expect_same whole.3dm single.3dm "candidates of swap"
joins "a target" 3 "${laser[@]}" "${coarse[@]}" --target 40%
joins "a target of greedy" 2 "${laser[@]}" "${coarse[@]}" --target 40% --optimize greedy
joins "a target of exact" 2 "${laser[@]}" "${coarse[@]}" --target 30% --optimize exact
joins "starts in random places" 3 "${laser[@]}" --strategy random --optimize swap
joins starts "1 2 3 7 21 26" "${laser[@]}" "${coarse[@]}" --seed 3
joins "many starts" 3 "${laser[@]}" "${coarse[@]}" --starts 50
joins "kinds and a budget" 3 arrange room.glb -q --sensor laser,range=4,fov=180,cost=2:4 \
    --sensor laser,range=2,fov=360,cost=1:4 --budget 6 "${coarse[@]}"

# A proof on 8 shards has the value and closes the gap of a single run; shards of 1 and more, too.
# key KEY FILE
key() { grep '^result ' "$2" | tr ' ' '\n' | sed -n "s/^$1=//p"; }
proof=(arrange room.glb --sensor laser,range=4,fov=180:4 --candidates 0.4,0.4,12 --optimize exact -q)
"${proof[@]}" -o single.3dm
[ "$(key coverage single.3dm)" = "$(key bound single.3dm)" ] || fail "the single run proves nothing"
for n in 8 1 3; do
    in_shards $n "${proof[@]}"
    for figure in coverage area bound candidates complete; do
        [ "$(key $figure whole.3dm)" = "$(key $figure single.3dm)" ] ||
            fail "$n shards of a proof: $figure is $(key $figure whole.3dm), not $(key $figure single.3dm)"
    done
done

# A shard that time cuts short has a bound that holds; so has the merge, which says so.
long=(arrange room.glb --sensor laser,range=4,fov=180:9 --candidates 0.15,0.15,32 --optimize exact -q)
for i in 1 2; do "${long[@]}" --time-limit 4 --shard $i/2 -o t$i.part; done
arrange -q --merge t1.part t2.part -o cut.3dm
[ "$(key complete cut.3dm)" = no ] || fail "not marked as cut short: $(tail -n 1 cut.3dm)"
python3 - "$(key coverage cut.3dm)" "$(key bound cut.3dm)" <<'END' || fail "no bound: $(tail -n 1 cut.3dm)"
import sys
value, bound = (float(word.rstrip("%")) for word in sys.argv[1:])
assert 0 < value <= bound < 100
END

# The merge writes the files that require the whole search.
for i in 1 2; do "${laser[@]}" "${coarse[@]}" --shard $i/2 -o s$i.part; done
arrange -q --merge s1.part s2.part --trace merged.jsonl --curve merged.csv -o whole.3dm -MD
"${laser[@]}" "${coarse[@]}" --trace single.jsonl --curve single.csv -o single.3dm
expect_same merged.jsonl single.jsonl "--trace of a merge"
expect_same merged.csv single.csv "--curve of a merge"

# A target that is not reached: the merge writes the best layout and says so, as a single run does.
expect_status 3 "${laser[@]}" "${coarse[@]}" --target 99% -o single.3dm
sed 's/^arrange: //' err >err.single
for i in 1 2; do "${laser[@]}" "${coarse[@]}" --target 99% --shard $i/2 -o s$i.part; done
expect_status 3 arrange -q --merge s1.part s2.part -o whole.3dm
expect_same whole.3dm single.3dm "a target out of reach"
expect_same err.single <(sed 's/^arrange: //' err) "what is said of it"
for i in 1 2; do "${laser[@]}" "${coarse[@]}" --shard $i/2 -o s$i.part; done

# A part with an empty command, or one that lacks its NUL, takes bounded memory.
python3 - <<'PY'
data = open('s1.part', 'rb').read()
at = data.index(b'\n=command ') + 1
line = data.index(b'\n', at) + 1
size = int(data[at:line].split()[1])
for name, command in ('cut', data[line:line + size - 1]), ('none', b''), ('one', b'arrange'):
    hash = 0xcbf29ce484222325
    for byte in command:
        hash = (hash ^ byte) * 0x100000001b3 % (1 << 64)
    with open(name + '.part', 'wb') as part:
        part.write(data[:at] + b'=command %d %016x\n' % (len(command), hash) + command +
                   data[line + size:])
PY
for name in cut none one; do
    (ulimit -v 8000000 && expect_error 1 arrange --merge $name.part s2.part -o none.3dm)
    grep -q 'does not say which command made it' err || fail "$name.part: $(cat err)"
done

# Parts of different jobs, and contradictory options.
expect_error 1 arrange --merge s2.part -o none.3dm
grep -q 'missing shard 1 of 2' err || fail "$(cat err)"
"${laser[@]}" "${coarse[@]}" --seed 4 --shard 2/2 -o other.part
expect_error 1 arrange --merge s1.part other.part -o none.3dm
"${laser[@]}" "${coarse[@]}" --share candidates --shard 2/2 -o other.part
expect_error 1 arrange --merge s1.part other.part -o none.3dm
grep -q 'the format' err || fail "$(cat err)"
expect_error 1 scan --merge s1.part
cp room.glb kept.glb
envc "$data/square.env" -o room.glb
expect_error 1 arrange --merge s1.part s2.part -o none.3dm
grep -q 'not of what is read now: the room differs' err || fail "$(cat err)"
rm room.glb
expect_error 1 arrange --merge s1.part s2.part -o none.3dm
cp kept.glb room.glb
[ ! -e none.3dm ] || fail "a product in spite of the error"
for words in "--shard 1/2 -o s.3dm" "--shard 1/2 --strategy random" "--shard 1/2 --time-limit 1" \
    "--shard 1/2 --share tree" "--share starts" "--shard 1/2 --share tree --optimize exact --target 50%" \
    "--shard 1/2 --trace t.jsonl" "--resume" "--checkpoint-interval 1"; do
    # shellcheck disable=SC2086
    expect_error 2 arrange room.glb --sensor laser $words
done
expect_error 2 arrange room.glb --sensor laser --shard 1/2 --strategy random
grep -q 'share the starts of --optimize swap' err || fail "no hint: $(cat err)"
expect_status 2 arrange - --sensor laser --shard 1/2 <room.glb
grep -q 'the merge reads its input again' err || fail "$(cat err)"
