#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Other programs read scan's output back: clouds by PCL, CARMEN logs by MRPT, depth pictures by OpenCV. They must find
# the values of scan's CSV and JSON of the same readings.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/../pipelines/common.sh"

cp "$data/room.env" .
cat >sensors.3dm <<'END'
#3dm 1
laser id=l1 model=urg-04lx at=-1.5,-1,0.15 heading=33
laser id=n1 at=-2,0,0.6 heading=10 tilt=-20 range=0.3,2 fov=90 step=0.5
ranger id=r1 at=-2.5,-1.5,1.1 heading=25 tilt=-15 roll=4 pixels=64,48 range=0.5,4
ranger id=v1 at=0.3,-0.4,0.5 heading=120 roll=-10 projection=spherical pixels=90,16 fov=360,32 range=0.1,3
END
done_parts=""

# list NAME FILE: the numbers of a list of the readings in FILE, one a line.
list() { sed -n "s/.*\"$1\":\[\([^]]*\)\].*/\1/p" "$2" | tr , '\n'; }

# close_columns MESSAGE TOLERANCE A B: files of numbers that differ by at most that; nan is nan.
close_columns() {
    paste "$3" "$4" | awk -v t="$2" '
        NF % 2 { bad = 1; exit }
        { for (i = 1; i <= NF / 2; i++) {
            a = $i; b = $(i + NF / 2); d = a - b
            if ((a == "nan") != (b == "nan") || (a != "nan" && (d > t || d < -t))) { bad = 1; exit }
            n++ } }
        END { exit bad || !n }' ||
        fail "$1: not the same numbers: $(diff "$3" "$4" | head -n 6)"
}

# wanted_points SENSOR FRAME: x y z of each beam or pixel.
wanted_points() {
    scan room.env sensors.3dm --select "$1" --coordinates "$2" --to csv | tail -n +2 |
        awk -F, '{ if ($NF == "") print "nan nan nan"; else print $(NF - 2), $(NF - 1), $NF }'
}

# points FILE.pcd: the same as PCL reads them; its header goes to ./pcd_head.
points() {
    pcl_convert_pcd_ascii_binary "$1" ascii.pcd 0 >pcl.log 2>&1 || fail "PCL: $(cat pcl.log)"
    sed '/^DATA/q' ascii.pcd >pcd_head
    sed '1,/^DATA/d' ascii.pcd
}

# expect_head LINE MESSAGE
expect_head() { grep -qx "$1" pcd_head || fail "$2: no '$1' in $(cat pcd_head)"; }

# turned: points of a sensor's frame, by the viewpoint in ./pcd_head, in the world.
turned() {
    awk 'FNR == NR { if ($1 == "VIEWPOINT") for (i = 2; i <= 8; i++) v[i - 1] = $i; next }
        $1 == "nan" { print; next }
        {   w = v[4]; x = v[5]; y = v[6]; z = v[7]
            tx = 2 * (y * $3 - z * $2); ty = 2 * (z * $1 - x * $3); tz = 2 * (x * $2 - y * $1)
            print $1 + w * tx + y * tz - z * ty + v[1], $2 + w * ty + z * tx - x * tz + v[2], \
                  $3 + w * tz + x * ty - y * tx + v[3] }' pcd_head -
}

if command -v pcl_convert_pcd_ascii_binary >/dev/null && command -v pcl_ply2pcd >/dev/null; then
    for sensor in l1:682:1 n1:181:1 r1:64:48 v1:90:16; do
        IFS=: read -r id width height <<<"$sensor"
        wanted_points "$id" world >"$id.world"
        for frame in world sensor; do
            wanted_points "$id" $frame >wanted
            grep -q nan wanted || fail "$id: no beam without return: the test proves less"
            grep -v nan wanted >present
            for encoding in binary ascii; do
                what="$id in the frame of the $frame, $encoding"
                scan room.env sensors.3dm --select "$id" --coordinates $frame \
                    --encoding $encoding -o cloud.pcd
                points cloud.pcd >seen
                expect_head "WIDTH $width" "$what"
                expect_head "HEIGHT $height" "$what"
                close_columns "$what, PCD" 2e-6 wanted seen
                if [ $frame = sensor ]; then
                    turned <seen >world
                    close_columns "$what, by its viewpoint" 2e-5 "$id.world" world
                else
                    expect_head "VIEWPOINT 0 0 0 1 0 0 0" "$what"
                fi

                scan room.env sensors.3dm --select "$id" --coordinates $frame \
                    --encoding $encoding -o cloud.ply
                pcl_ply2pcd cloud.ply from_ply.pcd >pcl.log 2>&1 || fail "PCL: $(cat pcl.log)"
                points from_ply.pcd >seen
                if [ "$height" -eq 1 ]; then
                    expect_head "POINTS $(wc -l <present)" "$what, PLY"
                    close_columns "$what, PLY" 2e-6 present seen
                else
                    expect_head "WIDTH $width" "$what, PLY"
                    expect_head "HEIGHT $height" "$what, PLY"
                    close_columns "$what, PLY" 2e-6 wanted seen
                fi
            done
        done
    done
    scan room.env sensors.3dm --select r1 -o cloud.pcd
    pcl_pcd2ply -format 1 cloud.pcd by_pcl.ply >pcl.log 2>&1 || fail "PCL: $(cat pcl.log)"
    grep -aqx "element vertex $((64 * 48))" by_pcl.ply || fail "PCL makes no PLY of our PCD"
    done_parts+=" pcl"
fi

if command -v carmen2rawlog >/dev/null && command -v rawlog-edit >/dev/null; then
    # The field of view of this laser is not symmetric: it begins at -119.53 and ends at 119.88 degrees.
    cat >robot.3dm <<'END'
#3dm 1
robot id=p1 model=pioneer-2dx at=0.5,0.4 heading=-150
laser id=l1 model=urg-04lx on=p1 at=0.1,0.05,0.3 heading=-10
END
    scan room.env robot.3dm --frames 2 -o log.jsonl
    scan room.env robot.3dm --frames 2 --to carmen -o carmen.log
    carmen2rawlog -i carmen.log -o carmen.rawlog -w >mrpt.log 2>&1 || fail "MRPT: $(cat mrpt.log)"
    rawlog-edit -i carmen.rawlog --export-txt >mrpt.log 2>&1 || fail "MRPT: $(cat mrpt.log)"
    rawlog-edit -i carmen.rawlog --list-poses --text-file-output poses.txt -w >mrpt.log 2>&1
    rawlog-edit -i carmen.rawlog --describe >described 2>&1

    # Ranges in millimetres, then whether each is one.
    grep -v '^%' carmen_ROBOTLASER1.txt >scans
    [ "$(wc -l <scans)" -eq 2 ] || fail "MRPT reads no two scans"
    list ranges log.jsonl | sed 's/null/4.095/' >wanted
    awk '{ for (i = 2; i <= 683; i++) print $i }' scans >seen
    close_columns "ranges as MRPT reads them" 0.00051 wanted seen
    missing=$(list ranges log.jsonl | grep -c null)
    [ "$missing" -gt 0 ] || fail "no beam without return: the test proves less"
    valid=$(awk '{ for (i = 684; i <= NF; i++) n += $i } END { print n }' scans)
    [ "$((valid + missing))" -eq $((2 * 682)) ] || fail "MRPT: $valid valid, $missing missing"

    # Where the robot stands, and where on it the middle of the fan looks.
    grep -v '^%' carmen_ODOMETRY.txt | awk '{ print $2, $3, $4 }' >seen
    printf '0.5 0.4 -2.61799\n%.0s' 1 2 >wanted
    close_columns "the robot's pose" 1e-5 wanted seen
    tr -d '[]' <poses.txt | awk '$1 != 0 { print $1, $2, $4 }' >seen
    printf '0.1 0.05 -9.824219\n%.0s' 1 2 >wanted
    close_columns "the laser's pose on the robot" 1e-5 wanted seen
    grep -q 'aperture"): 239.4 deg' described || fail "MRPT: $(grep -a aperture described)"
    grep -q 'maximum range: 4.09' described || fail "MRPT: $(grep -a 'maximum range' described)"
    done_parts+=" mrpt"
fi

if command -v "$binary_dir/tests/read_picture" >/dev/null; then
    for sensor in r1:64:48 v1:90:16; do
        IFS=: read -r id width height <<<"$sensor"
        scan room.env sensors.3dm --select "$id" -o depth.jsonl
        for per_metre in 1000 5000; do
            scan room.env sensors.3dm --select "$id" --depth-scale $per_metre -o depth.png
            "$binary_dir/tests/read_picture" depth depth.png >seen
            [ "$(head -n 1 seen)" = "$width $height 16 1" ] ||
                fail "OpenCV: the picture of $id is $(head -n 1 seen)"
            list depths depth.jsonl | awk -v s=$per_metre '
                { print ($1 == "null" || $1 * s >= 65535.5 ? 0 : $1 * s) }' >wanted
            grep -qx 0 wanted || fail "$id: no pixel without return: the test proves less"
            tail -n +2 seen >samples
            close_columns "depths of $id as OpenCV reads them" 0.5001 wanted samples
        done
    done
    scan room.env sensors.3dm --select r1 --to png -o depth.png
    "$binary_dir/tests/read_picture" depth depth-color.png >seen
    grep -q ' 8 3$' seen || fail "OpenCV: the coloured picture is $(cat seen)"
    scan room.env sensors.3dm --select l1 --size 500 -o map.png
    "$binary_dir/tests/read_picture" depth map.png | has -x '500 500 8 3' || fail "not a map of 500"
    "$binary_dir/tests/read_picture" camera depth.yaml >camera || fail "yaml-cpp reads no camera"
    scan room.env sensors.3dm --select r1 -o depth.jsonl
    number() { sed -n "s/.*\"$1\":\([-0-9.e+]*\)[,}].*/\1/p" depth.jsonl; }
    fx=$(number fx) fy=$(number fy)
    cat >wanted <<END
image_width 64
image_height 48
camera_name r1
camera_matrix.rows 3
camera_matrix.cols 3
camera_matrix.data $fx 0 31.5 0 $fy 23.5 0 0 1
distortion_model plumb_bob
distortion_coefficients.rows 1
distortion_coefficients.cols 5
distortion_coefficients.data 0 0 0 0 0
rectification_matrix.rows 3
rectification_matrix.cols 3
rectification_matrix.data 1 0 0 0 1 0 0 0 1
projection_matrix.rows 3
projection_matrix.cols 4
projection_matrix.data $fx 0 31.5 0 0 $fy 23.5 0 0 0 1 0
END
    expect_same wanted camera "the camera file, read by yaml-cpp: $(diff wanted camera)"
    done_parts+=" opencv"
fi

[ -n "$done_parts" ] || skip "neither PCL nor MRPT nor OpenCV is there"
echo "read by:$done_parts"
