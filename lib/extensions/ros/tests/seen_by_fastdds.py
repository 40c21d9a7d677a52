# SPDX-License-Identifier: GPL-3.0-or-later
"""simrun --ros2 as a node over Fast DDS sees it, set up as ROS does: scans, frames and map are those of scan and envc,
value for value; the robot drives by orders and stops without them; services answer; bytes that are no orders, and many
of them, harm nothing; and the run ends at once."""
import json
import math
import os
import shutil
import struct
import subprocess
import time

from dds_run import Client, free_domain, need_dds
from device_run import SOURCE, Run, check, scratch

LAYOUT = """#3dm 1
robot id=r1 model=pioneer-2dx at=-1.2,-0.5 heading=10
laser id=l1 on=r1 at=0.1,0,0.3 fov=180 step=1 range=3.2 rate=20
laser id=l2 at=1,1 heading=-120 fov=90 step=0.25 range=0.5,8 rate=10
"""
TWIST = "geometry_msgs::msg::dds_::Twist_"
EMPTY = "std_srvs::srv::dds_::Empty_Request_"


def single(value):
    """The value as a float of four bytes."""
    return struct.unpack("f", struct.pack("f", math.inf if value is None else value))[0]


def check_scans(client):
    text = subprocess.run(["scan", "square.env", "layout.3dm", "--to", "jsonl"], check=True, text=True,
                          stdout=subprocess.PIPE).stdout
    wanted = {one["sensor"]: one for one in map(json.loads, text.splitlines()[1:])}
    for laser, count in (("l1", 181), ("l2", 361)):
        message = client.newest(f"rt/{laser}/scan")
        ranges = [single(one) for one in wanted[laser]["ranges"]]
        other = [i for i, one in enumerate(ranges) if message["ranges"][i:i + 1] != [one]]
        check(len(ranges) == len(message["ranges"]) == count and not other, f"{laser} has other ranges: {other}")
        check(message["frame"] == laser and message["intensities"] == 0, f"{laser}: {message['frame']}")
    check(any(math.isinf(one) for one in client.newest("rt/l1/scan")["ranges"]), "no beam is open")
    first, last, step, *_ = client.newest("rt/l2/scan")["limits"]
    check((first, last) == (single(-math.pi / 4), single(math.pi / 4)), "l2 has another field of view")
    check(step == single(math.radians(0.25)), "l2 has another step")


def check_frames(client):
    static = {one["child"]: one for one in client.newest("rt/tf_static")["transforms"]}
    check(static["l1"]["frame"] == "r1" and static["l1"]["pose"] == [0.1, 0, 0.3, 0, 0, 0, 1], "l1 on r1")
    x, y, *_, z, w = static["l2"]["pose"]
    check(static["l2"]["frame"] == "map" and (x, y) == (1, 1), "l2 in the room")
    check(abs(math.degrees(2 * math.atan2(z, w)) + 120) < 1e-9, "heading of l2")
    moving = {one["child"]: one for one in client.newest("rt/tf")["transforms"]}
    parents = {"r1_odom": "map", "r1": "r1_odom", "r1_left_wheel": "r1", "r1_right_wheel": "r1"}
    check({child: one["frame"] for child, one in moving.items()} == parents, f"frames of r1: {moving}")
    check(moving["r1_odom"]["pose"][:2] == [-1.2, -0.5], "start of r1")


def check_map(client):
    subprocess.run(["envc", "square.env", "--to", "ros", "-o", "map.yaml"], check=True)
    with open("map.pgm", "rb") as file:
        pixels = file.read()
    message = client.newest("rt/map")
    width, height = message["width"], message["height"]
    rows = [pixels[len(pixels) - (i + 1) * width:len(pixels) - i * width] for i in range(height)]
    values = {254: 0, 0: 100}
    cells = [values.get(pixel, -1) for row in rows for pixel in row]
    check(message["cells"] == cells and 100 in cells and 0 in cells, "another map")
    check(message["resolution"] == [single(0.05)], "another resolution")


def check_driving(client, type_of_order):
    def ahead():
        return client.newest("rt/r1/odom")["pose"][0]
    start = ahead()
    client.wait(lambda: ahead() > start + 0.1, "the robot to go", f"{type_of_order} rt/r1/cmd_vel 0.3 0")
    check(abs(client.newest("rt/r1/odom")["pose"][1]) < 1e-6, "the robot turned")
    # Without orders it stops by itself, 1.5 s later.
    client.wait(lambda: client.newest("rt/r1/odom")["twist"][0] == 0, "the robot to stop")


def check_services(client):
    head = "00010000" + bytes(range(16)).hex()

    def call(name, content=head):
        return f"raw {EMPTY} rq/{name}Request {content}00"
    for name in ("pause", "resume"):
        client.wait(lambda: client.seen[f"rr/{name}Reply"], name, call(name))
        check(client.seen[f"rr/{name}Reply"][0]["bytes"].startswith(head), f"{name}: another client's answer")
    client.wait(lambda: client.seen["rr/resetReply"], "reset", call("reset"))
    client.wait(lambda: is_at_start(client), "the robot at its start")
    time.sleep(0.5)  # for calls that were repeated
    # With neither a header nor an identity the request is carried out.
    client.wait(lambda: not is_at_start(client), "the robot to go", "twist rt/r1/cmd_vel 0.3 0")
    client.wait(lambda: is_at_start(client), "the robot at its start", call("reset", "00010000"))
    time.sleep(0.5)


def is_at_start(client):
    frames = {one["child"]: one["pose"] for one in client.newest("rt/tf")["transforms"]}
    x, y = frames["r1"][:2]
    z, w = frames["r1_odom"][5:]
    turn = 2 * math.atan2(z, w)
    at = (frames["r1_odom"][0] + x * math.cos(turn) - y * math.sin(turn),
          frames["r1_odom"][1] + x * math.sin(turn) + y * math.cos(turn))
    return math.dist(at, (-1.2, -0.5)) < 1e-9


def check_hostile(client, domain):
    """Bytes that are no orders; then more orders than any reader takes."""
    time.sleep(2)  # it goes on after a reset, until orders are missed
    client.wait(lambda: client.newest("rt/r1/odom")["twist"][0] == 0, "the robot to stop")
    start = client.newest("rt/r1/odom")["pose"]
    whole = "00010000" + struct.pack("<6d", 0.3, 0, 0, 0, 0, 0).hex()
    broken = struct.pack("<6d", math.nan, 0, 0, 0, 0, math.inf).hex()
    for content in ("", "00", "00010000", whole[:-8], whole[:60], "00000000" + whole[8:], "00070000" + whole[8:],
                    "ffffffff" + whole[8:], "00010000" + broken, "00010000" + "ff" * 3000):
        client.say(f"raw {TWIST} rt/r1/cmd_vel {content or '-'}")
        time.sleep(0.02)  # each is read: a reader keeps the newest
    client.say("raw geometry_msgs::msg::dds_::PoseWithCovarianceStamped_ rt/r1/initialpose 00010000ffffffffffffffffffffff7f")
    time.sleep(0.3)
    now = client.newest("rt/r1/odom")["pose"]
    check(now == start, f"the robot obeyed bytes that are no order: {start}, {now}")
    time.sleep(0.3)
    began, seen = time.monotonic(), client.newest("rt/clock")["t"]
    with Client(domain) as other:
        other.say(f"flood {TWIST} rt/r1/cmd_vel {'00010000' + bytes(48).hex()} 200000")
    took = time.monotonic() - began
    time.sleep(0.3)
    share = (client.newest("rt/clock")["t"] - seen) / 1e9 / (took + 0.3)
    print(f"200000 orders within {took:.1f} s: the clock went at {share:.2f} of its rate")
    check(share > 0.8, "a flood of orders stops the world")


def main():
    need_dds()
    with scratch() as folder:
        os.chdir(folder)
        shutil.copy(SOURCE / "tests" / "data" / "square.env", "square.env")
        with open("layout.3dm", "w", encoding="ascii") as file:
            file.write(LAYOUT)
        domain = free_domain()
        with Run("square.env", "layout.3dm", "-q", f"--ros2={domain}") as run:
            check(run.first_line["ros2"] == domain, str(run.first_line))
            with Client(domain, "rt/l1/scan", "rt/l2/scan", "rt/tf", "rt/tf_static", "rt/map", "rt/r1/odom", "rt/clock",
                        "rr/resetReply", "rr/pauseReply", "rr/resumeReply", "ros_discovery_info") as client:
                check_scans(client)
                with Client(domain, "rt/l1/scan", reliable=True) as other:  # as RViz does by default
                    check(other.newest("rt/l1/scan")["ranges"], "no scans for reliable readers")
                check_frames(client)
                check_map(client)
                check("simrun".encode().hex() in client.newest("ros_discovery_info")["bytes"], "no node simrun")
                check_driving(client, "twist")
                with Client(domain, "rt/r1/odom") as other:  # a topic has one type in a participant of Fast DDS
                    check_driving(other, "stamped")
                check_services(client)
                check_hostile(client, domain)
                began = time.monotonic()
                run.stop()
                took = time.monotonic() - began
                print(f"simrun ended within {took:.2f} s")
                check(took < 1, "simrun ended late")


main()
