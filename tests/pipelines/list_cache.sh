#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# --batch with --cache: the bytes of a run without it, whatever became of the files or of the cache; and only changed
# scenes are measured.
. "$(dirname "$0")/common.sh"

cp "$data"/{square.env,half.3dm,whole.3dm,several.3dm,zones.env} "$scenes"/near-far.env .
printf 'v 2 2 0\nv 3 2 0\nv 3 3 0\nv 2 2 1\nv 3 2 1\nv 3 3 1\nf 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\n' >block.obj
{ cat square.env; printf 'mesh file=block.obj\nlaser at=1,1 fov=360 step=1 range=9\n'; } >meshed.env
cat >list <<'LIST'
square.env half.3dm
square.env whole.3dm
zones.env several.3dm
meshed.env
missing.env half.3dm
LIST
how=(-v --any-environment --require 60%)

# Runs coverage with and without a cache, and compares all that they write.
compare() {
    sleep 0.05  # a file of the same tick of the clock counts as changed
    expect_status 1 coverage "${how[@]}" --batch list --junit without.xml
    mv out without && mv err err.without
    expect_status 1 coverage "${how[@]}" --batch list --junit with.xml --cache cache
    expect_same without out "$1: reports"
    expect_same err.without err "$1: messages"
    diff <(sed 's/ time="[0-9.]*"//g' without.xml) <(sed 's/ time="[0-9.]*"//g' with.xml) || fail "$1: JUnit"
}
# $1: number of known scenes, in a run of the scenes that succeed
expect_known() {
    sleep 0.05
    sed /missing/d list >whole_list
    coverage -v --any-environment --batch whole_list --cache counted >counted.out 2>counted.err || fail "$(cat counted.err)"
    grep -q " jobs done, $1 of them known from counted" counted.err || fail "not $1 known, $2: $(cat counted.err)"
}

compare "from nothing"
[ -s cache ] || fail "no cache"
compare "without a change"
expect_known 0 "from nothing"
expect_known 4 "without a change"
expect_known 4 "twice without a change"

# Edits of the room, the layout and a mesh; lines that move; the same scene twice.
echo '# a comment' >>half.3dm
expect_known 3 "an edited layout"
echo 'cube at=4,4 size=1' >>square.env
compare "an edited room"
expect_known 2 "an edited room of two scenes"
sed -i 's/v 3 3/v 3.5 3/' block.obj
compare "an edited mesh"
expect_known 3 "an edited mesh"
{ echo '# moved'; tac list; echo square.env half.3dm; } >moved && mv moved list
compare "moved lines"
expect_known 5 "moved lines"
touch square.env half.3dm
expect_known 5 "new times of the same bytes"

# Results for other options are not reused; a scene that left the list is forgotten.
for other in "--grid 20" "--height 1" "--seed 3" "--max-work none"; do
    cp cache old
    # shellcheck disable=SC2086
    coverage "${how[@]}" --batch list $other >without 2>/dev/null || true
    # shellcheck disable=SC2086
    coverage "${how[@]}" --batch list $other --cache old >with 2>/dev/null || true
    expect_same without with "a cache of runs without $other"
done
cp counted all_of_them
printf 'square.env half.3dm\n' >one
coverage -v --any-environment --batch one --cache counted >/dev/null 2>err
grep -q '1 jobs done, 1 of them known' err || fail "$(cat err)"
[ "$(grep -ac ^=sha256: counted)" -eq 1 ] || fail "the cache grows without end"
mv all_of_them counted

# Caches that are old, cut, damaged, or something else.
sed -i '0,/^tool coverage .*/s//tool coverage 0.0.1/' counted
expect_known 0 "a cache of another version"
size=$(stat -c %s counted)
for left in 40 $((size / 2)) $((size - 3)); do
    cp counted cut
    truncate -s "$left" cut
    cp cut cache
    if [ "$left" -eq 40 ]; then
        expect_error 1 coverage -q --any-environment --batch whole_list --cache cache
        expect_same cut cache "a file that is no cache was replaced"
    else
        coverage -q --any-environment --batch whole_list >without
        coverage -q --any-environment --batch whole_list --cache cache >with
        expect_same without with "a cache cut at $left"
    fi
done
python3 - <<'PYTHON'
data = bytearray(open("counted", "rb").read())
at = data.index(b'"coverage":{')
data[at + 20] ^= 1
open("counted", "wb").write(data)
PYTHON
sleep 0.05
coverage -v --any-environment --batch whole_list --cache counted >with 2>err
coverage -q --any-environment --batch whole_list >without
expect_same without with "a damaged record"
! grep -q '5 of them known' err || fail "a damaged record is known: $(cat err)"
for wrong in square.env list; do
    cp "$wrong" kept
    expect_error 1 coverage -q --any-environment --batch whole_list --cache kept
    grep -q 'kept: error: not a cache of coverage: delete it or name another file' err || fail "$(cat err)"
    expect_same "$wrong" kept "$wrong was replaced"
done
expect_error 2 coverage -q --any-environment --batch whole_list --cache square.env -o square.env
expect_error 2 coverage square.env half.3dm --cache counted
expect_error 2 coverage --batch list --cache -
expect_status 1 coverage -q --any-environment --batch whole_list --cache no/such/folder/cache

# arrange: a layout that is lost or edited is computed again.
printf 'near-far.env\nsquare.env\n' >rooms
where=(arrange -v --sensor laser,range=4,fov=180:2 --candidates 0.5,0.5,8 --no-progress --batch rooms -o layouts/)
sleep 0.05
"${where[@]}" >lines 2>/dev/null
cp -r layouts first
for known in 0 2; do
    "${where[@]}" --cache layouts.cache >again 2>err
    grep -q "2 jobs done, $known of them known" err || fail "not $known layouts known: $(cat err)"
    expect_same lines again "lines of known layouts"
    diff -r first layouts || fail "other layouts"
done
rm layouts/square-0002.3dm
echo '# edited' >>layouts/near-far-0001.3dm
"${where[@]}" --cache layouts.cache >again 2>err
grep -q '2 jobs done, 0 of them known' err || fail "lost layouts are known: $(cat err)"
diff -r first layouts || fail "layouts were not computed again"
expect_error 1 coverage -q --any-environment --batch whole_list --cache layouts.cache

# A model that appears in a folder that comes earlier, or in another GAZEBO_MODEL_PATH, is read instead.
model() { # FOLDER HALF-DEPTH
    local n=0
    mkdir -p "$1/m"
    echo '<model><name>m</name><sdf version="1.7">model.sdf</sdf></model>' >"$1/m/model.config"
    {
        echo '<sdf version="1.7"><model name="m"><static>true</static>'
        for box in "0 $2 0.5|8 0.1 1" "0 -$2 0.5|8 0.1 1" "4 0 0.5|0.1 10 1" "-4 0 0.5|0.1 10 1"; do
            echo "<link name='l$((n += 1))'><pose>${box%|*} 0 0 0</pose><collision name='c'><geometry><box><size>${box#*|}" \
                '</size></box></geometry></collision></link>'
        done
        echo '</model></sdf>'
    } >"$1/m/model.sdf"
}
area() { # of the room, and whether it was known; $1: environment
    sleep 0.05
    env "${1:-none=}" coverage -v --batch worlds.list --cache worlds.cache 2>err | sed 's/.*"indoor_area":\([0-9]*\).*/\1/'
    sed -n 's/.*done, \([01]\) of them known.*/\1/p' err
}
mkdir worlds
model models 3
echo '<sdf version="1.7"><world name="w"><include><uri>model://m</uri></include></world></sdf>' >worlds/w.sdf
printf '#3dm 1\nlaser id=l1 at=0.3,0 range=10 fov=360\n' >one.3dm
echo 'worlds/w.sdf one.3dm' >worlds.list
expect_area() { [ "$(area "${4:-}" | tr '\n' ' ')" = "$1 $2 " ] || fail "$3: not $1 m2, known $2: $(cat err)"; }
expect_area 48 0 "first"
expect_area 48 1 "again"
model worlds/models 2
expect_area 32 0 "an earlier folder appears"
expect_area 32 1 "an earlier folder stays"
rm -r worlds/models models
model elsewhere 2.5
expect_area 40 0 "another path" GAZEBO_MODEL_PATH=elsewhere
expect_area 40 1 "the same path" GAZEBO_MODEL_PATH=elsewhere
