#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# arrange --proof poses: a run that ends early continues to the bytes of one that did not, and shards prove its bound.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

printf '#env 1\nfence path=0,0;6,0;6,2;6.2,2;6.2,0;9,0;9,5;6.2,5;6.2,3;6,3;6,5;0,5 closed=yes\ninside at=1,1\n' >flat.env
# key KEY FILE
key() { grep '^result ' "$2" | tr ' ' '\n' | sed -n "s/^$1=//p"; }
few=(arrange flat.env --sensor laser,range=3,fov=240:2 --candidates 1,1,8 --proof poses --gap 4% -q)
"${few[@]}" --certificate single.certificate -o single.3dm
[ "$(key complete single.3dm)" = "" ] || fail "the single run is cut short"

# Signals and kills end it again and again; the last run has the bytes of the first one.
kept=0
for ((runs = 1; runs < 60; ++runs)); do
    signal=TERM
    ((runs % 3)) || signal=KILL
    timeout -s $signal "$((runs * runs / 64)).$((runs % 10))" \
        "${few[@]}" --certificate resumed.certificate --resume --checkpoint-interval 0 -o resumed.3dm || true
    if [ -e resumed.3dm ]; then break; fi
    if grep -aqs '^=posestate' resumed.3dm.resume; then kept=1; fi
done
[ $kept = 1 ] || fail "no state was kept in $runs runs"
expect_same resumed.3dm single.3dm "a run of $runs parts"
expect_same resumed.certificate single.certificate "the certificate of $runs parts"
[ ! -e resumed.3dm.resume ] || fail "a state is left"

# A state of another command is refused.
timeout -s TERM 1 "${few[@]}" --resume -o other.3dm || true
if [ -e other.3dm.resume ]; then
    expect_status 1 "${few[@]/4%/3%}" --resume -o other.3dm
    grep -q 'the command.*differs' err || fail "$(cat err)"
fi

# Shards: subtrees of the proof.
for n in 1 3; do
    rm -f s*.part
    for ((i = 1; i <= n; ++i)); do "${few[@]}" --shard $i/$n --resume -o s$i.part; done
    arrange -q --merge s*.part -o whole.3dm
    python3 - "$(key value whole.3dm)" "$(key bound whole.3dm)" "$(key value single.3dm)" "$(key bound single.3dm)" \
        <<'END' || fail "$n shards: $(tail -n 1 whole.3dm)"
import sys
value, bound, other, limit = (float(word.rstrip("%")) for word in sys.argv[1:])
assert 0 < value <= bound and value <= limit and other <= bound
assert value >= 0.96 * bound - 1e-9
END
    [ "$(key proof whole.3dm)" = poses ] && [ "$(key complete whole.3dm)" = "" ] || fail "$(tail -n 1 whole.3dm)"
done
"${few[@]}" --shard 1/1 -o s1.part
arrange -q --merge s1.part -o whole.3dm
expect_same whole.3dm single.3dm "a shard of 1"

# Cut short by time, shards have a bound that holds.
for i in 1 2; do "${few[@]/4%/0.1%}" --time-limit 1 --shard $i/2 -o t$i.part; done
arrange -q --merge t1.part t2.part -o cut.3dm
[ "$(key complete cut.3dm)" = no ] || fail "not marked as cut short: $(tail -n 1 cut.3dm)"

expect_status 2 "${few[@]}" --shard 1/2 --certificate c -o s1.part
grep -q 'certificate needs all of the search' err || fail "$(cat err)"
expect_status 2 "${few[@]}" --shard 1/2 --share starts -o s1.part
grep -q 'shards of --proof poses share poses' err || fail "$(cat err)"
expect_status 2 arrange flat.env --sensor laser:2 --shard 1/2 --share poses -o s1.part
grep -q 'is about --proof poses' err || fail "$(cat err)"
exit 0
