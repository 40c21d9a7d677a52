# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of ispace-sweep."""

from __future__ import annotations

import argparse
import contextlib
import csv
import json
import os
import re
import shlex
import signal
import sys
import tempfile
from typing import TYPE_CHECKING, Iterable, Iterator, NoReturn, Sequence

from .errors import DataError, UsageError, did_you_mean
from .model import CommandWriter, Job, Jobs, Sweep

if TYPE_CHECKING:  # slow imports wait until an action requires them
    from .listing import Left
    from .parts import Part

TOOL = "ispace-sweep"
# The function of each action, and its options besides the common ones.
ACTIONS = {
    "commands": ("a line of the shell for each job", {"only", "shard", "missing", "threads", "json"}),
    "names": ("the files that the jobs make", {"only", "shard", "missing", "suffix"}),
    "makefile": ("rules for GNU make", {"only", "threads"}),
    "run": ("run the jobs, with all results in one file", {"only", "shard", "threads", "retry", "reuse"}),
    "status": ("how far the parts of a run are", {"only", "json", "failed"}),
    "join": ("the results of all jobs as one table", {"only", "partial", "to", "raw", "columns"}),
    "plot": ("one picture of the results", {"only", "partial", "to", "x", "y", "by", "over"}),
}
DEFAULTS: dict[str, object] = {
    "only": [], "shard": None, "missing": False, "threads": None, "json": False, "suffix": None,
    "retry": False, "reuse": [], "failed": False, "partial": False, "raw": False, "columns": None,
    "to": None, "x": None, "y": None, "by": None, "over": None}


def main(version: str, arguments: Sequence[str] | None = None) -> int:
    """Runs the program; the exit status is that of the other tools: 1 bad data or failed I/O, 2 usage."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _stop)
    words = list(sys.argv[1:] if arguments is None else arguments)
    # Selected at once, so that errors of the command line have that form.
    say = _Speaker(version if _wants_json_errors(words) else None)
    try:
        _run(_parse(arguments, version), version, say)
        return 0
    except UsageError as error:
        say([str(error)], 2)
        return 2
    except DataError as error:
        say(error.findings, 1)
        return 1
    except BrokenPipeError:  # the reader of the output has ended: as by default
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGPIPE)
        return 128 + signal.SIGPIPE
    except OSError as error:
        name = f"{os.fsdecode(error.filename)}: " if error.filename else ""
        say([f"{name}error: {os.strerror(error.errno or 0)}"], 1)
        return 1
    except _Stopped as stopped:
        signal.signal(stopped.number, signal.SIG_DFL)
        os.kill(os.getpid(), stopped.number)
        return 128 + stopped.number


class _Stopped(BaseException):
    """Exits on a signal, removing half-written files on the way out."""

    def __init__(self, number: int) -> None:
        self.number = number
        super().__init__(number)


def _stop(number: int, _frame: object) -> NoReturn:
    raise _Stopped(number)


def _wants_json_errors(words: list[str]) -> bool:
    pairs = zip(words, words[1:])
    return "--errors=json" in words or ("--errors", "json") in pairs


class _Speaker:
    """Writes messages to stderr, each as a line for people or as JSON, as the other tools do."""

    def __init__(self, json_version: str | None) -> None:
        self.version = json_version

    def __call__(self, messages: Iterable[str], status: int = 0) -> None:
        for message in messages:
            line = f"{TOOL}: {_printable(message)}" if self.version is None else self._object(message, status)
            print(line.encode(errors="backslashreplace").decode(), file=sys.stderr)

    def _object(self, message: str, status: int) -> str:
        found = re.match(r"(?:(?P<file>[^:]+):(?:(?P<line>\d+):(?:(?P<column>\d+):)?)? )?"
                         r"(?P<severity>error|warning): ", message)
        words: dict[str, object] = {"schema": "ispace-message/1", "tool": TOOL, "version": self.version,
                                    "severity": found["severity"] if found else "error"}
        if status:
            words["status"] = status
        if found and found["file"]:
            words["file"] = _printable(found["file"])
            words.update({key: int(found[key]) for key in ("line", "column") if found[key]})
        words["message"] = _printable(message[found.end():] if found else message)
        return json.dumps(words, separators=(",", ":"))


def _printable(text: str) -> str:
    """One line, whatever it quotes."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (--help shows how)")


def _parse(arguments: Sequence[str] | None, version: str) -> argparse.Namespace:
    what = "\n".join(f"  {name:10}{text}" for name, (text, _) in ACTIONS.items())
    parser = _Parser(
        prog=TOOL, usage=f"{TOOL} ACTION SWEEP [PART]... [OPTION]...", allow_abbrev=False, add_help=False,
        formatter_class=lambda prog: argparse.RawDescriptionHelpFormatter(prog, max_help_position=28, width=100),
        description=f"Lists the jobs of a sweep or runs them, and joins their results.\n\nactions:\n{what}",
        epilog="examples:\n  ispace-sweep commands sweep.yaml | sh\n      run all jobs, one after another\n"
               "  ispace-sweep join sweep.yaml -o results.csv\n      join their reports in a table\n"
               "  ispace-sweep run sweep.yaml --shard 7/1000 -o part7.jsonl\n      run the seventh of a thousand parts\n")
    parser.add_argument("action", metavar="ACTION", nargs="?", help=argparse.SUPPRESS)
    parser.add_argument("sweep", metavar="SWEEP", nargs="?", help=argparse.SUPPRESS)
    parser.add_argument("parts", metavar="PART", nargs="*", help=argparse.SUPPRESS)
    add = parser.add_argument
    add("-o", "--output", metavar="FILE", default="-", help="write to FILE, whole or not at all (default: -)")
    add("--only", metavar="AXIS=VALUE", action="append", help="jobs with this choice alone; may be repeated")
    add("--shard", metavar="I/N", help="the I-th of N nearly equal parts of the jobs, 1-based")
    add("--missing", action="store_true", default=None, help="only what is not done yet")
    add("--json", action="store_true", default=None, help="JSON lines that describe the jobs")
    add("-j", "--threads", metavar="N", help="give the tools this number of threads; run: jobs at a time")
    add("--retry", action="store_true", default=None, help="run: do again what failed before")
    add("--reuse", metavar="PART", action="append", help="run: take lines of equal jobs from this part; may be repeated")
    add("--failed", action="store_true", default=None, help="status: a line for each job that failed")
    add("--suffix", metavar="SUFFIX", help="only the files with this suffix")
    add("--partial", action="store_true", default=None, help="do without the jobs that are not done")
    add("--columns", metavar="NAME,...", help="join: these columns alone, in this order")
    add("--raw", action="store_true", default=None, help="CSV: leave texts that look like formulas")
    add("--to", metavar="FORMAT", help="csv, jsonl or npz; svg, png or pdf (default: the suffix of FILE)")
    add("--x", metavar="AXIS", help="what lies along the picture")
    add("--y", metavar="COLUMN,...", help="what is drawn, a curve each (default: the coverage)")
    add("--by", metavar="AXIS", help="a curve for each choice of AXIS")
    add("--over", metavar="AXIS", help="a heat map with the choices of AXIS up its side")
    add("-q", "--quiet", action="store_true", help="report only errors")
    add("--errors", metavar="text|json", choices=["text", "json"], default="text",
        help="errors on stderr as lines for people, or as JSON objects (default: text)")
    add("-h", "--help", action="store_true", help="show this help and exit")
    add("-V", "--version", action="store_true", help="show version and licence and exit")
    options = parser.parse_intermixed_args(arguments)
    if options.help:
        parser.print_help()
        sys.exit(0)
    if options.version:
        if options.json:
            print(json.dumps({"schema": "ispace-version/1", "tool": TOOL, "version": version,
                              "licence": "GPL-3.0-or-later"}, separators=(",", ":")))
            sys.exit(0)
        print(f"{TOOL} (ispace) {version}\nLicence GPL-3.0-or-later; there is no warranty.")
        sys.exit(0)
    _check(options)
    return options


def _check(options: argparse.Namespace) -> None:
    """Missing operands, options of other actions, values out of range."""
    if options.action is None:
        raise UsageError(f"an action is needed: {', '.join(ACTIONS)} (--help shows how)")
    if options.action not in ACTIONS:
        raise UsageError(f"unknown action `{options.action}`"
                         f"{did_you_mean(options.action, ACTIONS) or ': one of ' + ', '.join(ACTIONS)}")
    if options.sweep is None:
        raise UsageError("the sweep's file is needed (--help shows how)")
    if options.sweep.endswith((".csv", ".npz")):
        parts = " PART..." if options.action in ("join", "plot", "status") else ""
        raise UsageError(f"{options.sweep} holds results: the sweep comes first, "
                         f"`{TOOL} {options.action} sweep.yaml{parts}`")
    if options.parts and options.action in ("commands", "names") and not options.missing:
        raise UsageError(f"{options.parts[0]}: `{options.action}` takes parts with --missing, to list what they lack")
    if options.parts and options.reuse:  # --reuse old*.jsonl
        options.reuse += options.parts
        options.parts = []
    if options.parts and options.action in ("makefile", "run"):
        raise UsageError(f"{options.parts[0]}: `{options.action}` takes one sweep")
    if options.sweep == "-" and sys.stdin.isatty():
        raise UsageError("the sweep would be read from a terminal")
    for name, default in DEFAULTS.items():
        if getattr(options, name) is None:
            setattr(options, name, default)
        elif name not in ACTIONS[options.action][1]:
            raise UsageError(f"--{name} is not for `{options.action}`")
    if options.threads is not None and not re.fullmatch(r"[0-9]{1,4}", options.threads):
        raise UsageError(f"-j {options.threads}: not a number of threads")
    if options.action == "plot":
        if options.x is None:
            raise UsageError("--x AXIS is needed")
        if options.by and options.over:
            raise UsageError("--by and --over: one of them")
        if len({options.x, options.by, options.over}) < 2 + bool(options.by or options.over):
            raise UsageError(f"`{options.x}` can lie one way alone")


def _run(options: argparse.Namespace, version: str, say: _Speaker) -> None:
    from .parts import is_part
    from .reader import read_sweep

    if options.output != "-" and options.sweep != "-" and _same_file(options.output, options.sweep):
        raise UsageError(f"{options.output} is the sweep itself")
    for part in [*options.parts, *options.reuse]:
        if options.output != "-" and _same_file(options.output, part):
            raise UsageError(f"{options.output} is one of the parts")
    if options.sweep != "-" and (is_part(options.sweep) or options.sweep.endswith(".jsonl")):
        if options.action not in ("join", "status"):
            raise UsageError(f"{options.sweep} holds results: the sweep comes first, "
                             f"`{TOOL} {options.action} sweep.yaml`")
        if options.only:
            raise UsageError("--only: give the sweep before its parts")
        options.parts.insert(0, options.sweep)  # parts know their axes
        if options.action == "join":
            return _join(None, options, version, say)
        return _status(None, options, version)
    sweep = read_sweep(options.sweep)
    if options.action in ("commands", "names", "makefile"):
        with _output(options.output) as write:
            for line in _lines(sweep, _chosen(sweep, options), options, version):
                write(line.encode("utf-8", "surrogateescape") + b"\n")
    elif options.action == "run":
        _run_jobs(sweep, options, version, say)
    elif options.action == "status":
        _status(sweep, options, version)
    else:
        _join(sweep, options, version, say)
    return None


def _run_jobs(sweep: Sweep, options: argparse.Namespace, version: str, say: _Speaker) -> None:
    from . import parts
    from .run import run

    if os.path.isabs(sweep.folder):
        raise UsageError(f"{sweep.file}: `folder: {sweep.folder}`: run needs a relative folder")
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # of a tool that has ended; Popen gives jobs the default
    share = parts.Share(*(_shard(options.shard) if options.shard else (1, 1)), tuple(options.only))
    size = int(options.threads) if options.threads else _cores()

    def note(text: str) -> None:
        if not options.quiet:
            say([text])

    failed = run(sweep, _chosen(sweep, options), share, options.output, version, max(1, size), options.retry,
                 options.reuse, say, note)
    if failed:
        raise DataError([f"error: {failed} {'job' if failed == 1 else 'jobs'} failed: `ispace-sweep status --failed` "
                         "lists them, --retry runs them again"])


def _cores() -> int:
    """Those of this task on a cluster, else of this process."""
    given = os.environ.get("SLURM_CPUS_PER_TASK", "")
    return int(given) if given.isdigit() and int(given) else len(os.sched_getaffinity(0))


def _parts_of(sweep: Sweep | None, paths: Sequence[str]) -> list[Part]:
    """The parts in the order of jobs. Throws DataError for those of another sweep."""
    from . import parts

    found = parts.in_order(paths)
    if sweep is not None and found[0].head["digest"] != sweep.digest:
        raise DataError([f"{found[0].path}: error: of another state of {sweep.file}, or of another sweep: "
                         f"`ispace-sweep run {shlex.quote(sweep.file)} --reuse {shlex.quote(found[0].path)} "
                         "-o NEW.jsonl` takes over the lines of equal jobs"])
    return found


def _status(sweep: Sweep | None, options: argparse.Namespace, version: str) -> None:
    from . import status

    if not options.parts:
        raise UsageError("status needs the parts: the files of `run -o`")
    found = _parts_of(sweep, options.parts)
    jobs = len(_chosen(sweep, options)) if sweep is not None else sum(part.jobs for part in found)
    lines = status.failures(found, options.json) if options.failed else status.lines(found, jobs, options.json, version)
    with _output(options.output) as write:
        for line in lines:
            write(line.encode("utf-8", "surrogateescape") + b"\n")


def _left(sweep: Sweep, options: argparse.Namespace) -> Left:
    """The steps that are listed: all, or with --missing those without files, or all of jobs that parts lack."""
    if not options.missing:
        return lambda job: sweep.steps
    if not options.parts:
        return sweep.left
    from . import parts

    done = parts.DoneJobs(_parts_of(sweep, options.parts))
    return lambda job: () if done.has(job.number) else sweep.steps


def _lines(sweep: Sweep, jobs: Iterable[Job], options: argparse.Namespace, version: str) -> Iterator[str]:
    from . import listing

    left = _left(sweep, options)
    if options.action == "names":
        if options.suffix is not None and options.suffix not in sweep.suffixes:
            raise UsageError(f"--suffix {options.suffix}: the jobs make {', '.join(sweep.suffixes)}")
        return listing.names(jobs, left, options.suffix)
    writer = CommandWriter(sweep, None if options.threads is None else int(options.threads))
    if options.action == "makefile":
        return listing.makefile(sweep, jobs, writer)
    if options.json:
        return listing.json_lines(sweep, jobs, writer, left, version)
    return listing.commands(jobs, writer, left)


def _join(sweep: Sweep | None, options: argparse.Namespace, version: str, say: _Speaker) -> None:
    """Joins the files of jobs, or the lines of parts, in a table or picture. A join of parts needs no sweep."""
    from . import parts, tables
    from .results import Gaps, from_files, from_lines

    if options.action == "join":
        form = _format(options, tables.FORMATS, "csv")
    else:
        from . import picture

        form = _format(options, picture.FORMATS, "svg")
    if form in ("npz", "png", "pdf") and options.output == "-" and sys.stdout.isatty():
        raise UsageError(f"{form} is not for a terminal: name a file with -o")
    if options.raw and form != "csv":
        raise UsageError("--raw is for csv")
    if options.columns is not None and form == "jsonl":
        raise UsageError("--columns is for csv and npz")
    gaps = Gaps()
    found: list[Part] = []
    if options.parts:
        found = _parts_of(sweep, options.parts)
        head = found[0].head
        wanted = {}
        if sweep is not None:
            jobs = len(_chosen(sweep, options))
            wanted = _wanted(options)
        else:
            jobs = sum(part.jobs for part in found)
        axes, name, digest = head["axes"], head["sweep"], head["digest"]
        rows = from_lines(parts.rows(found), head["suffixes"], gaps, wanted)
    else:
        assert sweep is not None
        chosen = _chosen(sweep, options)
        jobs = len(chosen)
        axes, name, digest = [axis.name for axis in sweep.axes], sweep.file.rsplit("/", 1)[-1], sweep.digest
        rows = from_files(sweep, chosen, gaps)
    table = tables.Table(axes, rows)
    if found:
        gaps.count = max(gaps.count, jobs - table.count)
        gaps.explain(list(_short(name if sweep is None else sweep.file, found)))
        gaps.check(jobs, options.partial, _listing(name if sweep is None else sweep.file, options))
    else:
        gaps.check(jobs, options.partial)
    if not table.count:
        raise DataError(["error: no job is done yet"])
    if table.count < jobs and not options.quiet:
        say([f"warning: {jobs - table.count} of {jobs} jobs are not done"])
    absent = parts.absent(found) if sweep is None and found else []
    if absent and not options.quiet:
        say([f"warning: {parts.shard_list(absent)}: not among these parts"])
    if options.columns is not None:
        table.pick(next(csv.reader([options.columns]), []) or [""])
    if options.action == "plot":
        assert sweep is not None
        data = picture.draw(sweep, table, options.x, options.y, options.by, options.over, form)
    with _output(options.output) as write:
        if options.action == "plot":
            write(data)
        elif form == "csv":
            tables.to_csv(table, write, options.raw)
        elif form == "jsonl":
            tables.to_jsonl(table, write, name, digest, version)
        else:
            tables.to_npz(table, write)


def _short(sweep: str, found: Sequence[Part]) -> Iterator[str]:
    """Errors about the parts that lack jobs, and the shares that are not among them, with the command that goes on."""
    from . import parts

    def run(share: parts.Share, output: str) -> str:
        shard = f" --shard {share.index}/{share.count}" if share.count > 1 else ""
        only = "".join(f" --only {shlex.quote(rule)}" for rule in share.only)
        return f"`{TOOL} run {shlex.quote(sweep)}{shard}{only} -o {shlex.quote(output)}`"

    for part in found:
        if part.count < part.jobs:
            yield f"{part.path}: error: {parts.extent(part)}: {run(part.share, part.path)} continues it"
    absent = parts.absent(found)
    if absent:
        yield (f"error: {parts.shard_list(absent)}: not among these parts: "
               f"{run(absent[0], f'part{absent[0].index}.jsonl')} runs {'it' if len(absent) == 1 else 'the first'}")


def _listing(sweep: str, options: argparse.Namespace) -> str:
    """The command that lists the jobs that parts lack."""
    named = " ".join(map(shlex.quote, options.parts)) if len(options.parts) <= 4 else "PART..."
    only = "".join(f" --only {shlex.quote(rule)}" for rule in options.only)
    return f"{TOOL} commands {shlex.quote(sweep)} {named} --missing{only}"


def _wanted(options: argparse.Namespace) -> dict[str, str | float | int]:
    """The choices of --only, as rows have them."""
    from .listing import number_or_text

    return {name: number_or_text(value) for name, _, value in (rule.partition("=") for rule in options.only)}


def _format(options: argparse.Namespace, known: Sequence[str], usual: str) -> str:
    """That of --to, else of the suffix, else the usual one."""
    suffix = os.path.splitext(options.output)[1][1:]
    form: str = options.to or (suffix if options.output != "-" else "") or usual
    if form not in known:
        what = f"--to {form}" if options.to else f"{options.output}: unknown suffix"
        raise UsageError(f"{what}; {options.action} writes {', '.join(known)}")
    return form


def _chosen(sweep: Sweep, options: argparse.Namespace) -> Jobs:
    """The jobs of --only and --shard; a shard is a part of all jobs, done or not."""
    only: dict[int, int] = {}
    for rule in options.only:
        name, _, value = rule.partition("=")
        names = [axis.name for axis in sweep.axes]
        if name not in names:
            raise UsageError(f"--only {rule}: no such axis{did_you_mean(name, names)}; there are "
                             f"{', '.join(names)}")
        place = names.index(name)
        index = sweep.axes[place].choices.index_of(value)
        if index is None:
            raise UsageError(f"--only {rule}: no such choice"
                             f"{did_you_mean(value, sweep.axes[place].choices.sample())}")
        if only.setdefault(place, index) != index:
            raise UsageError(f"--only {rule}: another choice of `{name}` is given already")
    jobs = sweep.jobs(only)
    if options.shard is None:
        return jobs
    return jobs.share(*_shard(options.shard))


def _shard(text: str) -> tuple[int, int]:
    part = re.fullmatch(r"([0-9]{1,9})/([0-9]{1,9})", text)
    index, count = (int(part[1]), int(part[2])) if part else (0, 0)
    if not 1 <= index <= count:
        raise UsageError(f"--shard {text}: I/N with I from 1 to N")
    return index, count


def _same_file(one: str, other: str) -> bool:
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False


class _Write:
    """Collects small pieces, so that 10 000 lines are few writes. Errors name the file."""

    def __init__(self, descriptor: int, name: str) -> None:
        self._file = os.fdopen(descriptor, "wb", 1 << 16)
        self._name = name

    def __call__(self, data: bytes) -> None:
        with self._named():
            self._file.write(data)

    def close(self) -> None:
        with self._named():
            self._file.close()

    @contextlib.contextmanager
    def _named(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            error.filename = self._name
            raise


@contextlib.contextmanager
def _output(path: str) -> Iterator[_Write]:
    """Standard output, or a file beside its target that gets its name at the end."""
    if path == "-":
        write = _Write(os.dup(1), "stdout")
        yield write
        write.close()
        return
    if os.path.exists(path) and not os.path.isfile(path):  # /dev/null and its like
        write = _Write(os.open(path, os.O_WRONLY), path)
        yield write
        write.close()
        return
    target = os.path.realpath(path)
    descriptor, beside = tempfile.mkstemp(prefix=".ispace.tmp.", dir=os.path.dirname(target))
    try:
        write = _Write(descriptor, path)
        yield write
        mask = os.umask(0)
        os.umask(mask)
        os.fchmod(descriptor, 0o666 & ~mask)
        write.close()
        os.replace(beside, target)
    except BaseException:
        with contextlib.suppress(OSError):
            write.close()
        with contextlib.suppress(OSError):
            os.unlink(beside)
        raise
