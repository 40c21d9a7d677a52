#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# arrange --robust, --crowd, --facing and --privacy: options, reports, and the same figures as coverage.
. "$(dirname "$0")/common.sh"

cat >room.env <<'END'
#env 1
fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes height=2.5
door id=north from=-2.5,3 to=-1.5,3
zone id=entrance path=-3,1;-1,1;-1,2.95;-3,2.95
zone id=desk1 path=2,-2.5;3,-2.5;3,-1.5;2,-1.5
desk id=d at=2,1
END
sed 's/^desk.*/screen id=s at=0,0 size=0.1,3,2/' room.env >moved.env
job=(room.env --sensor laser,range=4,fov=200:2 --candidates 1,1,8 --cell 10cm)

# Rooms: the worst of them, as coverage measures the layout there.
arrange "${job[@]}" --robust rooms:moved.env -o worst.3dm --report worst.html 2>report
for case in room.env moved.env 'worst of all' mean; do
    has "<th scope=\"row\">$case</th><td class=\"r\">[0-9.]*%" <worst.html || fail "no row of $case in the page"
done
has 'in room.env [0-9.]*%, moved.env [0-9.]*%; worst [0-9.]*%, mean [0-9.]*%' <report || fail "no cases: $(cat report)"
has -- '--robust rooms:moved.env' <worst.3dm || fail "no cases in the history"
share() { sed -n "s/.*$1 \([0-9.]*\)%.*/\1/p" report | head -1; }
for room in room moved; do
    coverage $room.env worst.3dm --cell 10cm --any-environment --json 2>err >$room.json
    python3 - "$(share "$room.env")" $room.json <<'END' || fail "$room.env: $(cat report)"
import json, sys
told, measured = float(sys.argv[1]) / 100, json.load(open(sys.argv[2]))["coverage"]["grid"]
sys.exit(abs(told - measured) > 6e-5)
END
done
mkdir -p rooms && cp moved.env rooms/
arrange "${job[@]}" --robust rooms:"$PWD/rooms/moved.env" --case mean -q -o mean.3dm
has -- '--robust rooms:moved.env --case mean' <mean.3dm || fail "a folder in the history: $(head -3 mean.3dm)"
arrange "${job[@]}" --robust rooms:moved.env -j 1 -q -o again.3dm
cmp -s worst.3dm again.3dm || fail "another layout with one thread"

# Failures: the worst one, as coverage finds it. None is the plain search.
arrange "${job[@]}" --robust failures:1 -o failing.3dm --report failing.html 2>report
has '<th scope="row">worst of all: without laser[12]</th><td class="r">[0-9.]*%' <failing.html || fail "no case in the page"
has 'checks one' <failing.html && fail "an option of coverage in a page of arrange"
has 'without laser[12], the worst failure, [0-9.]*%; mean over all failures' <report || fail "no failure: $(cat report)"
coverage room.env failing.3dm --cell 10cm --failures 1 --json >failing.json
python3 - "$(share "the worst failure,")" failing.json <<'END' || fail "another failure: $(cat report)"
import json, sys
told = float(sys.argv[1]) / 100
worst = json.load(open(sys.argv[2]))["failures"]["figures"][0]["worst"]
sys.exit(abs(told - worst) > 5e-3)  # exact there, by cells here
END
arrange "${job[@]}" --robust failures:0 -q | grep -v '^#\|result' >none
arrange "${job[@]}" -q | grep -v '^#\|result' >plain
cmp -s none plain || fail "another layout without failures"

arrange "${job[@]}" --robust mounting:5cm,3deg -q -o mounted.3dm
arrange "${job[@]}" --crowd 3 --seed 2 --report crowd.html 2>report >crowd.3dm
has '<th scope="row">worst of 16 crowds</th>' <crowd.html || fail "no crowds in the page"
has 'in 16 crowds of 3 people; worst [0-9.]*%, mean [0-9.]*% with a standard error of 0*[.0-9]*[1-9][0-9]*%' <report || fail "no crowds: $(cat report)"

# Privacy and faces: coverage passes the layouts.
cameras=(room.env --sensor camera:2 --candidates 1,1,8 --cell 10cm)
arrange "${cameras[@]}" --privacy 'desk*' -o private.3dm 2>report --report private.html
has 'privacy of desk1: is kept' <report || fail "no rule: $(cat report)"
has 'privacy of desk1' <private.html || fail "no rule in the report"
expect_status 0 coverage room.env private.3dm --privacy 'desk*'
arrange "${cameras[@]}" --facing entrance,45deg --zone entrance -o faces.3dm 2>report
has 'facing entrance through [a-z0-9]* within 45 degrees of -90: [0-9.]*% of 3.90 m2 is seen' <report || fail "no faces: $(cat report)"
coverage room.env faces.3dm --facing entrance,45deg >out
has "^$(sed -n 's/^arrange: \(facing.*\)/\1/p' report)\$" <out || fail "other faces: $(cat report)"
# A target without zones is of all floor, which is told with the zones to add; those are read as they are written there.
arrange "${cameras[@]}" --facing entrance --target 5% -o x.3dm 2>report
has "is of all floor: .* add --zone 'entrance'" <report || fail "no note: $(cat report)"
arrange "${cameras[@]}" --facing 'door:*' --target 5% -o x.3dm 2>report
has "add --zone 'door:\*,1.5'" <report || fail "no note of doors: $(cat report)"
arrange "${cameras[@]}" --facing 'door:*' --zone 'door:*' --target 5% -o x.3dm 2>report
has 'is of all floor' <report && fail "a note in vain: $(cat report)"
arrange "${cameras[@]}" --facing 'door:*' --zone 'door:*,1.5' --target 5% -o y.3dm 2>report
cmp <(grep -v '^#' x.3dm) <(grep -v '^#' y.3dm) || fail 'door:* is not door:*,1.5'
# A camera that stays sees the desk.
printf '#3dm 1\ncamera id=c at=0,0,2.4 tilt=-90 projection=omni fov=179 pixels=2000,2000 range=30\n' >dome.3dm
expect_status 3 arrange room.env dome.3dm --sensor camera --candidates 1,1,8 --privacy desk1 -o x.3dm

for words in 'rooms:' 'rooms:a.env,' failures:4 failures:x mounting:5cm floods x; do
    expect_error 2 arrange "${job[@]}" --robust "$words"
done
for options in '--robust failures:2' '--robust failures:1 --redundancy 2' '--robust failures:1 --target 90%' \
    '--robust rooms:moved.env --budget 2' '--crowd 3 --refine' '--crowd -1' '--crowd 2.7' '--crowd 3 --robust failures:1' \
    '--case worst' '--privacy bed' '--privacy desk1 --refine' '--facing entrance,45deg=90%' '--facing desk1,45deg' \
    '--facing entrance,45deg --crowd 2' '--robust rooms:-' '--robust rooms:moved.env --privacy desk1'; do
    # shellcheck disable=SC2086
    expect_error 2 arrange "${job[@]}" $options
done
expect_error 1 arrange "${job[@]}" --robust rooms:missing.env
