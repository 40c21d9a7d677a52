# SPDX-License-Identifier: GPL-3.0-or-later
"""A program over Cyclone DDS without a configuration, as Debian has it, finds simrun --ros2 on this machine, although its
ports are any."""
import os
import shutil
import subprocess

from dds_run import CLIENT, MODULE, free_domain
from device_run import SOURCE, Run, check, scratch, skip

PLAIN = CLIENT.parent / "cyclone_client"


def main():
    if not MODULE.exists() or not PLAIN.exists():
        skip("built without Cyclone DDS")
    os.environ.pop("CYCLONEDDS_URI", None)
    with scratch() as folder:
        os.chdir(folder)
        shutil.copy(SOURCE / "tests" / "data" / "square.env", "square.env")
        with open("layout.3dm", "w", encoding="ascii") as file:
            file.write("#3dm 1\nrobot id=r1 at=-1.2,-0.5\n")
        domain = free_domain()
        found = [PLAIN, str(domain), "rt/clock"]
        check(subprocess.run(found, check=False).returncode == 1, "self-test: a topic without a run is found")
        with Run("square.env", "layout.3dm", "-q", f"--ros2={domain}"):
            done = subprocess.run(found, check=False, capture_output=True, text=True)
        check(done.stdout == "rosgraph_msgs::msg::dds_::Clock_\n", f"not found: {done}")
        for name in ("tower.yaml", "tower.3dm"):
            shutil.copy(SOURCE / "tests" / "data" / name, name)
        with Run("tower.yaml", "tower.3dm", "-q", "--rmf", f"--ros2={domain}"):
            for topic, kind in {
                    "rt/lift_states": "rmf_lift_msgs::msg::dds_::LiftState_",
                    "rt/fleet_states": "rmf_fleet_msgs::msg::dds_::FleetState_",
                    "rt/l1/storey": "std_msgs::msg::dds_::String_",
                    "rt/ground_r1/battery_state": "sensor_msgs::msg::dds_::BatteryState_",
                    "rt/ground_r1/navigate_to_pose/_action/status": "action_msgs::msg::dds_::GoalStatusArray_",
                    "rr/ground_r1/navigate_to_pose/_action/send_goalReply":
                        "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Response_"}.items():
                done = subprocess.run([PLAIN, str(domain), topic], check=False, capture_output=True, text=True)
                check(done.stdout == kind + "\n", f"{topic}: {done}")


main()
