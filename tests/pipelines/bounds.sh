#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Inputs that took minutes, all memory or all of the disk: an answer, or a message that names the
# bound and the way out.
. "$(dirname "$0")/common.sh"

room='fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes height=2.5'

# bounded TOOL ARGUMENT… -- TEXT: status 1 or 2, and the last line on stderr has the text.
bounded() {
    local status=0 text=${*: -1}
    "${@:1:$#-2}" >out 2>err || status=$?
    { [ "$status" -eq 1 ] || [ "$status" -eq 2 ]; } || fail "status $status of: $*"
    tail -n 1 err | has -F -- "$text" || fail "no \`$text\` of: $*: $(tail -n 1 err)"
}

# Objects as large as towns: 70 000 corners each; their product would take minutes.
printf '#env 1\n%s\n' "$room" >towns.env
for x in 0 5e4 1e5; do echo "table at=$x,0 size=1e5" >>towns.env; done
expect_status 1 envc --check towns.env
grep -q "table1 overlaps table2" err || fail "no overlap found: $(cat err)"
expect_status 0 envc --info towns.env

# All tools reject bodies beyond 1000 km.
for tool in $tools; do
    for value in 1e7 1e300; do
        printf '#env 1\n%s\ncube at=1,1 size=%s\nlaser at=0,0\n' "$room" "$value" >far.env
        bounded "$tool" far.env -- "is above 1000000"
    done
done

# Walls and things that cross each other by the million.
awk 'BEGIN { printf "#env 1\nfence closed=yes path="; for (i = 0; i < 5000; ++i)
    printf "%s%g,%g", i ? ";" : "", (i % 2 ? 5000 - i : i) / 100, i % 2 * 10; print "" }' >zigzag.env
bounded envc --info zigzag.env -- "fence crosses itself near"
sed 's/closed=yes //' zigzag.env >open.env
bounded envc --info open.env -- "times, at most 500000 can be; end them where they meet"
awk -v room="$room" 'BEGIN { printf "#env 1\n%s\n", room; for (i = 0; i < 4000; ++i)
    printf "cube at=%g,%g size=5 heading=%d\n", i / 2000, i * 7919 % 4000 / 2000, i }' >heap.env
bounded envc --info heap.env -- "leave out some of what lies upon each other"

# Streams that never end.
for tool in $tools; do
    bounded "$tool" /dev/zero -- "64 KiB of zeros"
done
bounded scan towns.env --poses /dev/zero --model laser -- "a line of more than 4096 bytes"

# Outputs that a slip makes endless.
printf '#env 1\n%s\nlaser id=l at=0,0 rate=10\nrobot id=r at=2,0\n' "$room" >room.env
printf '0 0 0 0.15 0 0 0 1\n1e7 1 0 0.15 0 0 0 1\n' >slip.tum
bounded scan room.env --poses slip.tum --motion -- "100000000 readings at 10 Hz"
expect_status 0 scan room.env --poses slip.tum --motion --frames 7
[ "$(wc -l <out)" -eq 8 ] || fail "--frames 7 of --motion: $(wc -l <out) lines"
bounded scan room.env --frames 1000000000 -o cloud.ply -- "wanted at most 100000000 in one file"
[ ! -e cloud.ply ] || fail "a cloud in spite of the bound"
bounded simrun room.env --clock fast --until 1e9 --record run -- "--record-limit, which is 16G"
[ ! -e run ] || fail "a record in spite of the bound"
bounded simrun room.env --clock fast --record run --record-limit 2M -- "(--record-limit)"
tail -c 1 run/robots.csv | cmp -s - <(echo) || fail "half a line in robots.csv"
bounded simrun room.env --record run --record-limit 2X -- "is not a size like 500M or 2G"

# YAML that multiplies.
{
    echo 'parts: {p0: [{desk: {at: [1, 1]}}],'
    for i in {1..9}; do
        printf 'p%d: [%s],\n' "$i" "$(for _ in {1..10}; do printf '{place: {part: p%d}},' $((i - 1)); done)"
    done
    echo '}'
    echo 'place: {part: p9}'
} >parts.yaml
bounded envc --check parts.yaml -- "parts and repetitions make more than 10"
head -c 100000 /dev/zero | tr '\0' '[' >deep.yaml
bounded envc --check deep.yaml -- "nested too deep"

# Bounds of a map of maps.
printf 'P5\n30000 30000\n255\n' >huge.pgm
bounded envc --resolution 0.05 huge.pgm -- "wanted at most 400000000"

# Any input is bounded: a file without blocks on the disk, and a pipe that never ends.
truncate -s 5G hollow.env
bounded envc hollow.env -- "more than 4294967296 bytes, the most that an input may have"
endless() { yes '#' | envc -; }
bounded endless -- "more than 1073741824 bytes, the most that a pipe or a device may bring"

# People upon each other, and a crowd that sets out at once: each step is short.
printf '#env 1\nispace size=20,20\n' >crowd.env
{ echo '#3dm 1'; for ((i = 0; i < 400; ++i)); do echo "human at=0,0"; done; } >heap.3dm
bounded simrun crowd.env heap.3dm --clock fast --until 1 -- "overlaps human"
python3 - <<'END'
zones = "".join(f"zone id=z{i} at={-9 + i % 19},{-9 + i // 19} size=0.9,0.9\n" for i in range(361))
people = "".join(f"human id=h{i} at={-9 + i % 35 * 0.52:.2f},{-9 + i // 35 * 0.6:.1f}\n" for i in range(400))
days = "".join(f"at 00:00 h{i} goes z{i * 7 % 361}\n" for i in range(400))
for name, text in {"crowd.env": "#env 1\nispace size=20,20\n" + zones, "crowd.3dm": "#3dm 1\n" + people,
                   "crowd.txt": days}.items():
    with open(name, "w", encoding="ascii") as file:
        file.write(text)
END
for threads in 1 2; do
    expect_status 0 simrun crowd.env crowd.3dm --script crowd.txt --clock fast --until 0.5 -j $threads \
        --record crowd$threads
done
cmp crowd1/people.csv crowd2/people.csv || fail "a crowd sets out in another order with two threads"

# Hundreds of receivers in sight of hundreds of things: figures by cells, with the way to the others; and a dense floor of
# lasers on a page.
python3 - <<'END'
spots = [(round(-19 + 0.35 * (i % 108), 2), round(-14 + 7 * (i // 108), 2)) for i in range(400)]
with open("uwb.3dm", "w", encoding="ascii") as file:
    file.write("#3dm 1\n")
    file.writelines(f"cube at={x},{y} size=0.1 tag=T{i}\n" if i % 2 else f"uwb at={x},{y},2\n" for i, (x, y) in enumerate(spots))
with open("lasers.3dm", "w", encoding="ascii") as file:
    file.write("#3dm 1\n")
    file.writelines(f"laser at={-19.5 + 0.6 * (i % 66):.1f},{-14.5 + i // 66:.1f} range=3\n" for i in range(1500))
with open("far.3dm", "w", encoding="ascii") as file:
    file.write("#3dm 1\n")
    file.writelines(f"laser at={-19 + 2 * (i % 20)},{-14 + 2 * (i // 20)} heading={i} range=8\n" for i in range(300))
with open("flights.env", "w", encoding="ascii") as file:
    file.write("#env 1\nstorey id=s0 file=hall.env height=3\nstorey id=s1 file=hall.env z=3 height=3\n")
    file.writelines(f"stairs storeys=s0,s1 at={-19 + 2 * (i % 19)},{-14 + 2 * (i // 19)} size=0.2,0.4\n" for i in range(266))
END
printf '#env 1\nispace size=40,30\n' >hall.env
(ulimit -t "$(grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt" && echo 6 || echo 120)"
 expect_status 0 coverage hall.env uwb.3dm
 has 'no exact figures of all together: outlines .* more than [0-9]* [a-z]* (`--max-work [0-9]*` allows more)' <out ||
     fail "$(head -n 20 out)"
 expect_status 0 coverage hall.env lasers.3dm --report page.html
 ! has "no exact figures" <out || fail "$(head -n 20 out)"
 # Moves of things among hundreds of receivers are counted by the shadows that change, without a limit of time.
 expect_status 0 coverage hall.env uwb.3dm --suggest 3
 has '^suggestions' <out || fail "$(tail -n 5 out)"
 # Changes that are tried take the time of the views that they change; flights are looked at with those near them.
 expect_status 0 coverage hall.env far.3dm --suggest 3 --time-limit 2s
 has 'suggest' <out || fail "$(tail -n 5 out)"
 expect_status 1 envc --check flights.env)
