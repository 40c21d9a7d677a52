# SPDX-License-Identifier: GPL-3.0-or-later
"""The lab of an experiment: the tools, a folder, and the sheet that goes into the report."""

import contextlib
import json
import os
import shlex
import shutil
import subprocess
import sys
import time

TOOLS = ("envc", "arrange", "scan", "coverage", "simrun")
SHARE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


PATIENCE = 300  # seconds; far more than any command takes


# The lists that the report begins with.
REPRODUCED, FITTED, MISSED = "Reproduced", "Fitted", "Not reproduced"


class ToolFailed(Exception):
    """A command failed, or did not return the expected status."""


class Port(int):
    """A port that the system chose; commands are shown with one that a reader can type."""

    SHOWN = 7001


class Lab:
    """Runs commands in the lab's folder, with the tools of the build in PATH, and shows them as a reader types them
    there."""

    def __init__(self, name, title, source, build, folder, quick=False):
        self.name, self.title, self.source = name, title, source
        self.build, self.folder, self.quick = build, folder, quick
        self.parts = []     # of the report, in order: ("text", …), ("picture", …), ("rows", [Row])
        self.commands = []  # as typed
        self.cited, self.assumed, self.fits = [], [], []
        self.failures = []
        self.timings = []   # (task, seconds of wall time), for timings.csv
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)

    # ---- Files

    def path(self, name):
        """The full name of a file of the folder."""
        return os.path.join(self.folder, name)

    def scene(self, *names):
        """Copies scenes of share/scenes into the folder, where commands name them without a path."""
        for name in names:
            shutil.copy(os.path.join(SHARE, "scenes", name), self.folder)
        self.command("cp " + " ".join(f"$ISPACE/share/scenes/{name}" for name in names) + " .")

    def write(self, name, text):
        """Writes a file that is shown among the commands as typed."""
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        self.command(f"cat > {name} <<'END'\n{text.rstrip()}\nEND")

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    # ---- Commands

    def tool(self, name, *args, stdout=None, shown=True, statuses=(0,)):
        """Runs a program of build/bin or build/examples, or one in PATH, and returns its standard output,
        which also goes to the file `stdout`, if given; standard error is in `self.talk`."""
        line = _line(name, args)
        if shown:
            self.command(line + (f" > {stdout}" if stdout else ""))
        start = time.monotonic()
        try:
            done = subprocess.run([self._program(name), *map(_argument, args)], cwd=self.folder,
                                  capture_output=True, text=True, env=self._environment(),
                                  check=False, timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            raise ToolFailed(f"{line}: not done after {PATIENCE} s") from None
        self.timings.append((line, time.monotonic() - start))
        self.talk = done.stderr
        if done.returncode not in statuses:
            raise ToolFailed(f"{line}: status {done.returncode}: {_last_line(done.stderr)}")
        if stdout:
            with open(self.path(stdout), "w", encoding="utf-8") as file:
                file.write(done.stdout)
        return done.stdout

    @contextlib.contextmanager
    def serve(self, *args, shown=True):
        """Runs simrun with these arguments, serving clients on a port (the value, for tool()) during the block. With
        --clock step its replies do not depend on the machine."""
        start = _line("simrun", [*args, "--listen", f"127.0.0.1:{Port.SHOWN}"]) + " &\nsleep 1"
        shown = shown and start not in self.commands
        if shown:
            self.command(start)
        with subprocess.Popen([self._program("simrun"), *map(_argument, args), "-q", "--listen",
                               "127.0.0.1:0"], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True,
                              env=self._environment()) as server:
            first = server.stdout.readline()
            if not first:
                raise ToolFailed(f"{_line('simrun', args)}: {_last_line(server.stderr.read())}")
            try:
                yield Port(json.loads(first)["listen"].rsplit(":", 1)[1])
            finally:
                server.terminate()
                server.communicate(timeout=PATIENCE)
                if shown:
                    self.commands.append("kill $!; wait")  # as often as a simrun has begun

    def json(self, name, *args, shown=True):
        """The report of a tool as a value."""
        return json.loads(self.tool(name, *args, "--json", shown=shown))

    def seeds(self, count, few=3):
        """0, 1, … of a run with `count` seeds; `few` in a quick one."""
        return range(few if self.quick else count)

    def each_seed(self, seeds, name, *args):
        """The standard output of a tool for each seed, shown as a loop of the shell."""
        self.command(f"for seed in $(seq {seeds[0]} {seeds[-1]}); do {_line(name, args)} "
                     "--seed $seed; done")
        return [self.tool(name, *args, "--seed", seed, shown=False) for seed in seeds]

    def shell(self, text):
        """Runs a line of the shell, shown unchanged; for files that a loop writes."""
        self.command(text)
        done = subprocess.run(["sh", "-ec", text], cwd=self.folder, capture_output=True, text=True,
                              env=self._environment(), check=False, timeout=PATIENCE)
        if done.returncode != 0:
            raise ToolFailed(f"{text}: status {done.returncode}: {_last_line(done.stderr)}")
        return done.stdout

    def layout(self, name):
        """The records of a layout of the folder: keyword and keys, as words."""
        return [_record(line) for line in self.read(name).splitlines()
                if line.strip() and not line.startswith("#")]

    def result(self, name):
        """Reads the result of `arrange` in a layout of the folder: numbers, shares in per cent."""
        (record,) = [keys for keyword, keys in self.layout(name) if keyword == "result"]
        return {key: float(value.rstrip("%")) for key, value in record.items()
                if value.rstrip("%").replace(".", "", 1).isdigit()}

    def poses(self, name, keyword="laser"):
        """x, y and heading of each sensor of a layout."""
        return [(*(float(word) for word in keys["at"].split(",")[:2]), float(keys.get("heading", 0)))
                for found, keys in self.layout(name) if found == keyword]

    def command(self, text):
        """Records a command for the report, once."""
        if text not in self.commands:
            self.commands.append(text)

    def _program(self, name):
        if name == "python3":
            return sys.executable
        path = shutil.which(name, path=self._environment()["PATH"])
        if not path:
            raise ToolFailed(f"no program {name} in bin or examples of the build or in PATH: run `make "
                             "experiments`, which builds it")
        return path

    def _environment(self):
        folders = [os.path.join(self.build, "bin"), os.path.join(self.build, "examples"),
                   os.environ.get("PATH", os.defpath)]
        source = os.path.dirname(SHARE)
        return {**os.environ, "PATH": os.pathsep.join(folders), "LC_ALL": "C", "ISPACE": source,
                "PYTHONPATH": os.path.join(source, "lib", "client", "python"),
                "PYTHONDONTWRITEBYTECODE": "1"}

    # ---- The sheet

    def text(self, paragraph):
        self.parts.append(("text", paragraph))

    def row(self, what, thesis, ours, unit="", bound=None, note="", digits=None, verdict=None):
        """A line of the table: numbers, or words without numbers (None: unstated). `bound` is (least, most), the
        limits of ours; `note` gives the reason for a difference in a sentence; whole numbers have no decimals and
        others two, unless `digits` sets them. `verdict` is the list of the report for the thesis' figure:
        REPRODUCED unless stated; a number that differs and has no bound requires one."""
        if not self.parts or self.parts[-1][0] != "rows":
            self.parts.append(("rows", []))
        kept = bound is None or (ours is not None and bound[0] <= ours <= bound[1])
        if not kept:
            value = "nothing" if ours is None else f"{ours:.6g}"
            self.fail(f"{what}: {value}{_gap(unit)} is not within {_interval(bound)}{_gap(unit)}")
        if not note and _differ(thesis, ours, digits):
            self.fail(f"{what}: ours differs from the thesis, and no note says why")
        if not verdict and bound is None and _differ(thesis, ours, digits):
            self.fail(f"{what}: ours differs from the thesis without a bound, and no verdict is stated")
        self.parts[-1][1].append({"what": what, "thesis": thesis, "ours": ours, "unit": unit,
                                  "bound": bound, "kept": kept, "note": note, "digits": digits,
                                  "verdict": None if thesis is None else verdict or REPRODUCED})

    def picture(self, path, caption):
        """A PNG, JPEG or SVG of the folder; pictures one after another stand side by side."""
        with open(self.path(path), "rb") as file:
            self.parts.append(("picture", {"name": path, "bytes": file.read(), "caption": caption}))

    def svg(self, name, text, caption):
        """A drawing of the experiment's own, kept in the folder as well."""
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        self.picture(name, caption)

    def given(self, what, source):
        """A figure or a parameter of the thesis, and where it stands there."""
        self.cited.append((what, source))

    def assumption(self, text):
        """Records an assumption of ours that the thesis does not state."""
        self.assumed.append(text)

    def fitted(self, text):
        """Records a choice that reproduces a figure of the thesis."""
        self.fits.append(text)

    def require(self, holds, what):
        """A claim that makes the experiment fail if it does not hold."""
        if not holds:
            self.fail(what)

    def fail(self, why):
        self.failures.append(why)


def _record(line):
    keyword, *words = shlex.split(line, comments=True)
    return keyword, dict(word.split("=", 1) for word in words)


def _argument(value):
    return str(int(value)) if isinstance(value, Port) else str(value)


def _line(name, args):
    """Returns a command as a reader types it."""
    return shlex.join([name, *(str(Port.SHOWN) if isinstance(arg, Port) else str(arg)
                               for arg in args)])


def _last_line(text):
    return (text.strip().splitlines() or ["nothing said"])[-1]


def _differ(thesis, ours, digits):
    """Whether the report shows two numbers that are not the same."""
    numbers = all(isinstance(value, (int, float)) for value in (thesis, ours))
    places = 2 if digits is None else digits
    return numbers and abs(ours - thesis) >= 0.5 * 10 ** -places


def _gap(unit):
    return f" {unit}" if unit else ""


def _interval(bound):
    return f"{bound[0]:g} … {bound[1]:g}"
