# SPDX-License-Identifier: GPL-3.0-or-later
"""For the scripts beside it: a domain of DDS that no other test uses, and a client over Fast DDS."""
import fcntl
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

from device_run import check, skip

CLIENT = pathlib.Path(os.environ["ISPACE_BINARY_DIR"]) / "tests" / "fastdds_client"
MODULE = pathlib.Path(os.environ["ISPACE_BINARY_DIR"]) / "lib" / "ispace" / "dds.so"
TYPES = {"scan": "sensor_msgs::msg::dds_::LaserScan_", "tf": "tf2_msgs::msg::dds_::TFMessage_",
         "tf_static": "tf2_msgs::msg::dds_::TFMessage_", "clock": "rosgraph_msgs::msg::dds_::Clock_",
         "map": "nav_msgs::msg::dds_::OccupancyGrid_", "odom": "nav_msgs::msg::dds_::Odometry_",
         "Reply": "std_srvs::srv::dds_::Empty_Response_",
         "feedback": "nav2_msgs::action::dds_::NavigateToPose_FeedbackMessage_",
         "status": "action_msgs::msg::dds_::GoalStatusArray_",
         "info": "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"}
_locks = []


def need_dds():
    """Ends the script without Cyclone DDS or Fast DDS."""
    if not MODULE.exists():
        skip("built without Cyclone DDS")
    if not CLIENT.exists():
        skip("built without Fast DDS")


def free_domain():
    """A domain of this process alone, until it ends. Ports of domains above 101 are those that
    the system gives to any program."""
    for domain in range(11, 101):
        lock = open(pathlib.Path(tempfile.gettempdir()) / f"ispace-dds-{os.getuid()}-{domain}.lock", "w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            continue
        _locks.append(lock)
        return domain
    skip("no domain is free")


class Client:
    """A node over Fast DDS that reads topics: "rt/l1/scan". Messages are dictionaries. Scans are read
    by best effort, as nodes do by custom, or reliably."""

    def __init__(self, domain, *topics, reliable=False, prefix=()):
        words = [f"{'+' if reliable else ''}{TYPES[next(end for end in TYPES if topic.endswith(end))]}:{topic}"
                 for topic in topics]
        self.process = subprocess.Popen([*prefix, CLIENT, str(domain), *words], text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.seen = {topic: [] for topic in topics}
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            message = json.loads(line)
            self.seen[message["topic"]].append(message)

    def newest(self, topic):
        return self.wait(lambda: self.seen[topic], "a message of " + topic)[-1]

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def wait(self, condition, what, order=None, patience=60):
        """Waits, repeating the order as nodes do, and returns the condition's value."""
        deadline = time.monotonic() + patience
        while not (value := condition()):
            check(time.monotonic() < deadline, "waited for " + what)
            check(self.process.poll() is None, "the client has ended")
            if order:
                self.say(order)
            time.sleep(0.05)
        return value

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        check(self.process.wait(timeout=60) == 0, "the client over Fast DDS failed")
        self.reader.join()
