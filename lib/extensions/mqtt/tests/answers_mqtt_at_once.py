# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands over a broker that holds small packets back (mosquitto as it is configured by default) are answered within
milliseconds, as simrun acknowledges its packets at once."""
import contextlib
import os
import pathlib
import sys

from device_run import SOURCE, check, scratch, skip

sys.path.insert(0, str(SOURCE / "tests" / "bench"))
import latency  # noqa: E402


def main():
    with scratch() as folder, contextlib.ExitStack() as stack:
        os.chdir(folder)
        for name, text in (("room.env", latency.ROOM), ("layout.3dm", latency.LAYOUT)):
            pathlib.Path(name).write_text(text, encoding="ascii")
        port = latency.broker(stack)
        if port is None:
            skip("no mosquitto here")
        paths = [("MQTT", None, latency.mqtt_answers, None)]
        times = latency.measure_paths(paths, 50, pathlib.Path(os.environ["ISPACE_BINARY_DIR"]),
                                      ["--mqtt", f"127.0.0.1:{port}"], port=port)["MQTT"]
        check("answer" in times, "no answers")
        median = times["answer"][25]
        print(f"{median:.1f} ms")
        check(median < 30, f"answers take {median:.1f} ms")


main()
