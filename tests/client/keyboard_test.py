# SPDX-License-Identifier: GPL-3.0-or-later
"""The keyboard example in a pseudo-terminal: keys drive, the screen shows it."""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
import unittest
from pathlib import Path

import ispace

SOURCE = Path(os.environ["ISPACE_SOURCE_DIR"])
EXAMPLE = SOURCE / "share" / "examples" / "keyboard.py"


ROWS, COLUMNS = 30, 100


class Screen:
    """The screen of a VT100 for the bytes it gets, as far as curses uses it."""

    TOKEN = re.compile(r"\x1b\[(\?)?([\d;]*)([A-Za-z])|\x1b[()].|\x1b.|[\s\S]")

    def __init__(self):
        self.cells = [[" "] * COLUMNS for _ in range(ROWS)]
        self.row = self.column = 0
        self.rest = ""

    @property
    def text(self):
        return "\n".join("".join(row).rstrip() for row in self.cells)

    def feed(self, data):
        data = self.rest + data
        begun = data.rfind("\x1b")
        # A sequence may come in two pieces.
        whole = begun < 0 or re.match(r"\x1b(\[\??[\d;]*[A-Za-z]|[()].|[^\[()])", data[begun:])
        self.rest, data = ("", data) if whole else (data[begun:], data[:begun])
        for token in self.TOKEN.finditer(data):
            self.obey(token)

    def obey(self, token):
        text, verb = token.group(0), token.group(3)
        numbers = [int(n) if n else 0 for n in (token.group(2) or "").split(";")]
        if verb == "H":
            self.row, self.column = max(numbers[0], 1) - 1, max((numbers + [0])[1], 1) - 1
        elif verb == "J":
            for row in range(self.row, ROWS):
                self.erase(row, self.column if row == self.row else 0)
        elif verb == "K":
            first, last = (0, self.column + 1) if numbers[0] == 1 else (self.column, COLUMNS)
            self.erase(self.row, first, last)
        elif verb in ("A", "B", "C", "D"):
            by = max(numbers[0], 1)
            self.row += {"A": -by, "B": by}.get(verb, 0)
            self.column += {"C": by, "D": -by}.get(verb, 0)
        elif text == "\r":
            self.column = 0
        elif text == "\n":
            self.row = min(self.row + 1, ROWS - 1)
        elif text == "\b":
            self.column -= 1
        elif text >= " " and self.column < COLUMNS:
            self.cells[self.row][self.column] = text
            self.column += 1

    def erase(self, row, first, last=COLUMNS):
        self.cells[row][first:last] = [" "] * (last - first)


class Keyboard(unittest.TestCase):
    def setUp(self):
        self.run_ = ispace.simrun(
            SOURCE / "tests/data/square.env", SOURCE / "tests/data/session.3dm", clock="real:10", q=True
        )
        self.addCleanup(self.run_.close)
        try:
            master, slave = pty.openpty()
        except OSError as error:  # as in a container without /dev/pts
            self.skipTest(f"no terminal here: {error}")
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        self.terminal = master
        self.program = subprocess.Popen(
            [sys.executable, EXAMPLE, self.run_.address, "r1"],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env={**os.environ, "TERM": "vt100"},
            start_new_session=True,
        )
        os.close(slave)
        self.addCleanup(os.close, master)
        self.addCleanup(self.end)
        self.screen = Screen()

    def end(self):
        if self.program.poll() is None:
            self.program.send_signal(signal.SIGKILL)
        self.program.wait()

    def read(self):
        if select.select([self.terminal], [], [], 0.1)[0]:
            try:
                self.screen.feed(os.read(self.terminal, 65536).decode(errors="replace"))
            except OSError:
                pass

    def until(self, pattern):
        """Waits until the screen holds this text."""
        end = time.monotonic() + 60
        while not (found := re.search(pattern, self.screen.text)):
            self.assertLess(time.monotonic(), end, f"in vain: {pattern} in\n{self.screen.text}")
            self.read()
            self.assertIsNone(self.program.poll(), f"it has ended: {self.screen.text}")
        return found

    def pose(self):
        with self.run_.world() as world:
            return world.poses()["r1"]

    def test_it_needs_a_terminal(self):
        done = subprocess.run(
            [sys.executable, EXAMPLE, self.run_.address, "r2"], stdin=subprocess.DEVNULL, capture_output=True, text=True
        )
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("needs a terminal", done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_keys_drive(self):
        self.until(r"heading +0\.0")
        self.until("#")  # the laser l2 is on it, and the walls are near
        begun = self.pose()
        up, left = b"\x1bOA", b"\x1bOD"
        os.write(self.terminal, up + up)
        self.until(r"wanted 0\.2\)")
        os.write(self.terminal, left)
        self.until(r"wanted 15\)")
        end = time.monotonic() + 60
        while self.pose().x < begun.x + 0.1:
            self.assertLess(time.monotonic(), end, "the robot does not move")
            self.read()
        os.write(self.terminal, b" ")
        self.until(r"wanted 0\).*wanted 0\)")
        while self.pose() != (stopped := self.pose()):
            self.assertLess(time.monotonic(), end, f"the robot does not stop: {stopped}")
        # Faster than it can: the server's text.
        os.write(self.terminal, up * 20)
        self.until("at most")
        os.write(self.terminal, b"q")
        end = time.monotonic() + 60
        while self.program.poll() is None:
            self.assertLess(time.monotonic(), end, "q does not end it")
            self.read()
        self.assertEqual(self.program.wait(), 0)
        self.run_.robot("r1").close()  # it is free


if __name__ == "__main__":
    unittest.main()
