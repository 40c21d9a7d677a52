# SPDX-License-Identifier: GPL-3.0-or-later
"""The scans of a hundred robots, ten a second each, over DDS to a reader over Fast DDS: all of them, in real time, by
less than one core. A reader that has stopped delays neither the world nor its end."""
import os
import resource
import signal
import time

from dds_run import Client, free_domain, need_dds
from device_run import Run, check, scratch

ROBOTS, BEAMS, SECONDS = 100, 361, 5


def processor_time():
    """Of ended children, in seconds."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def main():
    need_dds()
    with scratch() as folder:
        os.chdir(folder)
        with open("hall.env", "w", encoding="ascii") as file:
            file.write("#env 1\nfence id=f path=-50,-50;50,-50;50,50;-50,50 closed=yes\n")
            for i in range(30):
                x, y = 3 * i - 48, 7 * i % 80 - 40
                file.write(f"fence id=w{i} path={x},{y};{x + 1},{y}\n")
        with open("robots.3dm", "w", encoding="ascii") as file:
            file.write("#3dm 1\n")
            for i in range(ROBOTS):
                file.write(f"robot id=r{i} at={10 * (i % 10) - 45},{10 * (i // 10) - 45} radius=0.2\n"
                           f"laser id=l{i} on=r{i} at=0.1,0,0.3 fov=180 step=0.5 range=10 rate=10\n")
        domain = free_domain()
        topics = [f"rt/l{i}/scan" for i in range(ROBOTS)]
        used = processor_time()
        with Client(domain, *topics) as client:
            with Run("hall.env", "robots.3dm", "-q", "--threads", "1", f"--ros2={domain}"):
                client.wait(lambda: all(client.seen[topic] for topic in topics), "scans of all robots")
                began = {topic: len(client.seen[topic]) for topic in topics}
                start = time.monotonic()
                time.sleep(SECONDS)
                counts = [len(client.seen[topic]) - began[topic] for topic in topics]
                took = time.monotonic() - start
            used = processor_time() - used  # the client has not ended
        check(all(len(message["ranges"]) == BEAMS for message in client.seen[topics[0]]), "other scans")
        print(f"{sum(counts)} scans within {took:.1f} s, {min(counts)} to {max(counts)} of a robot; "
              f"simrun took {used:.1f} s of a processor")
        # The machine may be busy with other tests, too.
        check(min(counts) > 8 * took, "scans are missing")
        check(used < took, "more than one core")
        with Client(domain, *topics, reliable=True) as client:
            with Run("hall.env", "robots.3dm", "-q", f"--ros2={domain}") as run:
                client.wait(lambda: all(client.seen[topic] for topic in topics), "scans of all robots")
                client.process.send_signal(signal.SIGSTOP)
                time.sleep(2)  # each writer keeps what it has not read
                start = time.monotonic()
                run.stop()
                took = time.monotonic() - start
                client.process.send_signal(signal.SIGCONT)
        print(f"simrun ended within {took:.2f} s beside a reader that had stopped")
        check(took < 2, "a reader that has stopped delays the end")


main()
