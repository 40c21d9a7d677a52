#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Options that people know from other programs (GDAL, osmium, Nav2, ROS 2, Gazebo, JVSG, Axis' tools): each is refused
# with the option to take, which the tool that is named has.
. "$(dirname "$0")/common.sh"

for tool in envc arrange scan coverage simrun; do $tool --help all >"$tool.help"; done

# TOOL GUESS HINT, in which the words that begin with - are options of TOOL, or of the tool named before them.
count=0
while read -r tool guess hint; do
    status=0
    $tool "$guess" x >out 2>err || status=$?
    [ $status -eq 2 ] || fail "$tool $guess: status $status"
    message=$(cat err)
    case $message in
    *"unknown option "*"$hint"*) ;;
    *) fail "$tool $guess: wanted \"$hint\" in: $message" ;;
    esac
    # Of the whole hint, to its end.
    said=${message#*unknown option }
    said=${said% (see *}
    owner=$tool
    for word in ${said#*:}; do
        case $word in
        envc | arrange | scan | coverage | simrun) owner=$word ;;
        -*)
            option=${word%%[^-a-z0-9A-Z]*}
            grep -q -e "^ .*$option\b" "$owner.help" || fail "$tool $guess: $owner has no $option: $message"
            owner=$tool
            ;;
        esac
    done
    count=$((count + 1))
done <<'TABLE'
coverage --bom --material
arrange --parts-list --material
coverage --customer --client
coverage --company --author
arrange --project-name --project
coverage --prices-file --prices
coverage --html --report
arrange --pdf --report
envc --html --report
coverage --ppm --density
arrange --dori --density
coverage --pixels-per-metre --density
coverage --blind-spots --suggest
coverage --heatmap --color
arrange --heatmap --heat
coverage --roi --zone
arrange --bbox --zone
arrange --exclude --keep-out
coverage --exclude --privacy
arrange --cameras --sensor
arrange --count --sensor
arrange -n --sensor
arrange --fov key
arrange --mounting-height --z
arrange --list-devices --list-models
scan --devices --list-models
arrange --min-coverage --target
coverage --threshold --require
arrange --overlap --redundancy
arrange --algorithm --optimize
arrange --timeout --time-limit
coverage --resolution --cell
arrange --tr --cell
coverage --floor --storey
envc --level --storey
simrun --map ENV
simrun --world ENV
coverage --input operands
envc --input INPUT
arrange --output-format .3dm
envc --of --to
coverage --format --to
simrun --output-dir --record
envc --outfile -o
coverage --overwrite -o
envc -f -o
scan --silent -q
simrun --log-level -v
arrange --num-threads -j
scan --random-seed --seed
envc --validate --check
envc --summary --info
envc --layer --wall-layer
envc --scale --units
envc --crop --inside
scan --pointcloud --to
scan --snapshot --to
scan --trajectory --poses
scan --render --view
scan --topic --select
simrun --headless --web
simrun --rviz --web
simrun --real-time-factor --clock
simrun --duration --until
simrun --timestep --dt
simrun --rosbag --mcap
simrun --ros-args --ros2
simrun --use-sim-time --ros2
simrun --goal GOTO
simrun --waypoints --script
simrun --params-file LAYOUT
simrun --port --listen
simrun --video --replay
simrun --assert --expect
coverage --config records
TABLE
[ $count -ge 60 ] || fail "only $count guesses"

# Devices by words, and reports in place of maps.
: >err
arrange "$scenes/open-office.env" --sensor urg:4 >out 2>err && fail "urg is a sensor"
grep -q 'urg-04lx' err || fail "$(cat err)"
arrange "$scenes/open-office.env" --sensor 'dome 1080p:4' >out 2>err && fail "a sensor of two words"
grep -q 'dome-2.8-1080p' err || fail "$(cat err)"
arrange "$scenes/open-office.env" --sensor dome4k:4 >out 2>err && fail "a sensor whose words stand together"
grep -q 'dome-2.8-4k' err || fail "$(cat err)"
printf '#env 1\nispace id=h size=6,4\ndoor id=front_door wall=h at=0,-2 size=1 height=2\ncamera id=c at=0,0,2\n' >door.env
coverage door.env --facing 'front*,45deg' >out 2>err && fail "a door without door:"
grep -q 'its doors of this name: door:front\*' err || fail "$(cat err)"
coverage "$scenes/open-office.env" -o r.html >out 2>err && fail "a map as HTML"
grep -q -- '--report r.html' err || fail "$(cat err)"
