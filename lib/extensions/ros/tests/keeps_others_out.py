# SPDX-License-Identifier: GPL-3.0-or-later
"""Another machine, which a network namespace stands for, announces itself to the ports of simrun --ros2: it is heard
if --allow admits its network, and not otherwise, even though it knows the ports. Programs of the same machine are heard
each time. Needs root rights."""
import os
import shutil
import subprocess
import sys
import time

from dds_run import Client, free_domain, need_dds
from device_run import SOURCE, Run, check, scratch, skip

LAYOUT = """#3dm 1
robot id=r1 at=-1.2,-0.5
"""
HERE, THERE = "10.201.7.1", "10.201.7.2"


def other_machine():
    """Starts a process in a network of its own, joined to this one's by a pair of interfaces."""
    process = subprocess.Popen(["unshare", "--net", "sleep", "600"])
    inside = ["nsenter", "--target", str(process.pid), "--net"]
    time.sleep(0.3)
    for command in ([*"ip link set lo up".split()],
                    f"ip link add here type veth peer name there netns {process.pid}".split(),
                    f"ip addr add {HERE}/24 dev here".split(), "ip link set here up".split(),
                    [*inside, *"ip link set lo up".split()],
                    [*inside, *f"ip addr add {THERE}/24 dev there".split()],
                    [*inside, *"ip link set there up".split()]):
        subprocess.run(command, check=True)
    return process, inside


def is_heard(client, patience):
    deadline = time.monotonic() + patience
    while not client.seen["rt/clock"] and time.monotonic() < deadline:
        time.sleep(0.05)
    return bool(client.seen["rt/clock"])


def main():
    need_dds()
    if os.getuid() != 0 or not shutil.which("nsenter") or not shutil.which("ip"):
        skip("no root rights, or no ip and nsenter, here")
    if len(sys.argv) == 1:
        # This machine's network is left alone, too.
        if subprocess.run(["unshare", "--net", "true"], check=False, stderr=subprocess.DEVNULL).returncode != 0:
            skip("no right to make namespaces")
        os.execvp("unshare", ["unshare", "--net", sys.executable, "-B", __file__, "inside"])
    other, inside = other_machine()
    try:
        with scratch() as folder:
            os.chdir(folder)
            shutil.copy(SOURCE / "tests" / "data" / "square.env", "square.env")
            with open("layout.3dm", "w", encoding="ascii") as file:
                file.write(LAYOUT)
            domain = free_domain()
            os.environ["FASTDDS_PEER"] = HERE
            for allow, is_wanted in (([], False), (["--allow", "10.202.0.0/16"], False),
                                     (["--allow", "10.201.7.0/24"], True), (["--allow", THERE], True)):
                with Run("square.env", "layout.3dm", "-q", f"--ros2={domain}", *allow), \
                        Client(domain, "rt/clock") as near, \
                        Client(domain, "rt/clock", prefix=inside) as far:
                    check(is_heard(near, 30), f"{allow}: not seen by this machine")
                    check(is_heard(far, 30 if is_wanted else 5) == is_wanted,
                          f"{allow}: the other machine sees " + ("nothing" if is_wanted else "the clock"))
    finally:
        other.kill()
        other.wait()


main()
