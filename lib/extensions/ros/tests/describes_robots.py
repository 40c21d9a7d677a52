# SPDX-License-Identifier: GPL-3.0-or-later
"""/robot_description is URDF that urdfdom reads; its links are frames of /tf and /tf_static, and its wheels are joints of
/joint_states, at the angles that the ways of the robot make."""
import math
import os
import shutil
import socket
import subprocess
import xml.etree.ElementTree as xml

from device_run import SOURCE, Run, check, need, scratch
from rosbridge import Rosbridge

RADIUS, TRACK = 0.0975, 0.33  # of a Pioneer 3-DX
TOPICS = ("/robot_description", "/joint_states", "/tf", "/tf_static")


def newest(address):
    """A message of each topic to a new client."""
    client, found = Rosbridge(address), {}
    for topic in TOPICS:
        client.say({"op": "subscribe", "topic": topic})
    while len(found) < len(TOPICS):
        message = client.message()
        if message["op"] == "publish":
            found[message["topic"]] = message["msg"]
    client.socket.close()
    return found


def check_wheels(found, way, turn):
    """After a way in metres and a turn in radians."""
    joints = found["/joint_states"]
    at = dict(zip(joints["name"], joints["position"]))
    frames = {one["child_frame_id"]: one for one in found["/tf"]["transforms"]}
    for side, name in ((1, "r1_left_wheel"), (-1, "r1_right_wheel")):
        wanted = (way - side * turn * TRACK / 2) / RADIUS
        check(math.isclose(at[name + "_joint"], wanted, abs_tol=1e-9), f"{name} at {at[name + '_joint']}, not {wanted}")
        rotation = frames[name]["transform"]["rotation"]
        angle = 2 * math.atan2(rotation["y"], rotation["w"])
        check(abs(math.remainder(angle - wanted, 2 * math.pi)) < 1e-9, f"{name} turned by {angle}, not {wanted}")


def main():
    need("check_urdf")
    with scratch() as folder:
        os.chdir(folder)
        shutil.copy(SOURCE / "tests" / "data" / "square.env", "square.env")
        with open("layout.3dm", "w", encoding="ascii") as file:
            file.write("#3dm 1\nrobot id=r1 model=pioneer-3dx at=-1.2,-0.5\nlaser id=l1 on=r1 at=0.1,0,0.3\n"
                       "camera id=c-1 on=r1 at=0.1,0,0.4 pixels=8,6\n")
        with Run("square.env", "layout.3dm", "--clock", "step", "--rosbridge", "0") as run:
            address = run.first_line["rosbridge"]
            begin = newest(address)
            text = begin["/robot_description"]["data"]
            with open("robot.urdf", "w", encoding="utf-8") as file:
                file.write(text)
            said = subprocess.run(["check_urdf", "robot.urdf"], capture_output=True, text=True, check=False)
            check(said.returncode == 0 and "root Link: r1" in said.stdout, said.stdout + said.stderr)
            robot = xml.fromstring(text)
            links = {link.get("name") for link in robot.iter("link")}
            frames = {one["child_frame_id"] for topic in ("/tf", "/tf_static") for one in begin[topic]["transforms"]}
            check(links == {"r1", "r1_left_wheel", "r1_right_wheel", "l1", "c_1", "c_1_optical"}, f"links {links}")
            check(links <= frames, f"no frames {links - frames}")
            check({"odom", "base_footprint", "base_link"} <= frames, f"frames {frames}")
            turning = {joint.get("name") for joint in robot.iter("joint") if joint.get("type") == "continuous"}
            check(turning == set(begin["/joint_states"]["name"]), f"joints {turning}")
            check_wheels(begin, 0, 0)
            with socket.create_connection(run.listen) as robot_socket, socket.create_connection(run.listen) as world:
                answers = robot_socket.makefile()
                robot_socket.sendall(b"ROBOT r1\n")
                steps = world.makefile()
                world.sendall(b"WORLD\n")
                way = turn = 0
                for order, metres, degrees in (("FORWARD 1.1", 1.1, 0), ("LEFT 400", 0, 400), ("BACKWARD 0.25", -0.25, 0)):
                    robot_socket.sendall((order + "\n").encode())
                    while not answers.readline().startswith("OK " + order.split()[0]):
                        pass
                    world.sendall(b"STEP 2000\n")
                    while not steps.readline().startswith("OK STEP"):
                        pass
                    way, turn = way + metres, turn + math.radians(degrees)
                    check_wheels(newest(address), way, turn)
        print(said.stdout.strip().splitlines()[2])


main()
