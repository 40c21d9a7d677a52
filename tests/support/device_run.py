# SPDX-License-Identifier: GPL-3.0-or-later
"""For tests of protocols: simrun with ports of devices, in a folder that goes with the script."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(os.environ["ISPACE_SOURCE_DIR"])
SCENES = SOURCE / "share" / "scenes"


def skip(why):
    print("skipped:", why)
    sys.exit(77)


def need(*programs):
    """Ends the script unless all of them are here."""
    missing = [name for name in programs if shutil.which(name) is None]
    if missing:
        skip("no " + ", ".join(missing) + " here")


def check(condition, message):
    if not condition:
        sys.exit("FAILED: " + message)


def scratch():
    """A folder to be in."""
    root = pathlib.Path(os.environ["ISPACE_BINARY_DIR"]) / "tests" / "scratch"
    root.mkdir(parents=True, exist_ok=True)
    return tempfile.TemporaryDirectory(dir=root, prefix="wire.")


class Run:
    """A running simrun. `ports["scip"]["l1"]` is the pair of address and port."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(["simrun", *map(str, arguments)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        check(line, "simrun said nothing: " + self.process.stderr.read() if not line else "")
        self.first_line = json.loads(line)
        self.ports = {}
        for name, devices in self.first_line.items():
            if isinstance(devices, dict):
                self.ports[name] = {one: self.split(address) for one, address in devices.items()}
        self.listen = self.split(self.first_line["listen"])

    @staticmethod
    def split(address):
        host, port = address.rsplit(":", 1)
        return host, int(port)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def stop(self):
        """Ends it, and fails unless it ended well."""
        if self.process.poll() is None:
            self.process.terminate()
        said = self.process.communicate(timeout=60)[1]
        check(self.process.returncode == 0, f"simrun ended with {self.process.returncode}: {said}")
