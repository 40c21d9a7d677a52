# SPDX-License-Identifier: GPL-3.0-or-later
"""For the tests of ispace-sweep: the program, in a folder of the test's own."""

import os
import shutil
import subprocess
import sys
import tempfile

PROGRAM = shutil.which("ispace-sweep")


def skip(why):
    print("skipped:", why)
    sys.exit(77)


try:
    import yaml  # noqa: F401
except ImportError:
    skip("no PyYAML (Debian: python3-yaml)")


class Folder:
    """A folder with files, in which programs run."""

    def __enter__(self):
        self.path = tempfile.mkdtemp(prefix=f"sweep.{os.getpid()}.")
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.path)

    def __truediv__(self, name):
        return os.path.join(self.path, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self / name), exist_ok=True)
        with open(self / name, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())

    def read(self, name):
        with open(self / name, "rb") as file:
            return file.read()

    def run(self, *words, status=0, **more):
        """Standard output of a program that ends with this status; its standard error is in self.talk."""
        done = subprocess.run(words, cwd=self.path, capture_output=True, text=True, check=False, **more)
        self.talk = done.stderr
        if done.returncode != status:
            sys.exit(f"{words}: status {done.returncode} instead of {status}: {done.stderr}")
        return done.stdout

    def sweep(self, action, *options, text=None, status=0):
        """Standard output of ispace-sweep about sweep.yaml, which holds `text` from now on."""
        if text is not None:
            self.write("sweep.yaml", text)
        out = self.run(PROGRAM, action, "sweep.yaml", *options, status=status)
        same("standard error of a success", "" if status == 0 else self.talk, self.talk)
        return out


def same(what, wanted, found):
    if wanted != found:
        sys.exit(f"failed: {what}:\n  wanted {wanted!r}\n  found  {found!r}")


def check(is_so, what):
    if not is_so:
        sys.exit(f"failed: {what}")
