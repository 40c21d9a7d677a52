# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the steps of jobs: ispace's tools in processes that stay, other programs each in its own."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from typing import Sequence

from .model import TOOLS, CommandWriter, Job, Step, Sweep
from .scratch import Scratch

NOT_FOUND = 127  # the status of a program that is not there, as the shell has it
NOT_RUN = 126  # of one that cannot be run
MOST_MESSAGES = 4000  # characters of standard error that a failed job keeps


class Tool:
    """One of ispace's tools as a process that works off command lines: `TOOL --serve-jobs`. It reads a room once for
    all jobs that name it."""

    def __init__(self, program: str) -> None:
        self._process = subprocess.Popen([program, "--serve-jobs"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def run(self, folder: str, output: str, errors: str, words: Sequence[str]) -> int | None:
        """The exit status of a command line; None if the process has ended, or is of another version."""
        fields = b"".join(os.fsencode(field) + b"\0" for field in (folder, output, errors, *words))
        assert self._process.stdin and self._process.stdout
        try:
            self._process.stdin.write(b"%d\n" % len(fields) + fields)
            self._process.stdin.flush()
            answer = self._process.stdout.readline()
        except OSError:
            return None
        return int(answer) if answer.endswith(b"\n") and answer.strip().isdigit() else None

    def kill(self) -> None:
        """Ends the process and its job at once."""
        self._process.kill()

    def close(self) -> None:
        """Ends the process, after the job that it has begun."""
        assert self._process.stdin and self._process.stdout
        try:
            self._process.stdin.close()
        except OSError:
            pass
        self._process.stdout.close()
        self._process.wait()


class Outcome:
    """What a job left: its status, the files of its steps, and standard error if it failed."""

    def __init__(self) -> None:
        self.status = 0
        self.files: dict[str, bytes] = {}
        self.commands: list[list[str]] = []
        self.messages = ""


class Worker:
    """Runs one job after the other in a scratch folder of its own. For use in one thread."""

    def __init__(self, sweep: Sweep, threads: int | None) -> None:
        self._sweep = sweep
        self._writer = CommandWriter(sweep, threads)
        self._plain = CommandWriter(sweep, None)
        self._scratch = Scratch(sweep.folder)
        self._tools: dict[str, Tool | None] = {}
        self._other: subprocess.Popen[bytes] | None = None
        self._is_killed = False

    def kill(self) -> None:
        """Ends the job at work, from any thread."""
        self._is_killed = True
        for tool in list(self._tools.values()):
            if tool:
                tool.kill()
        other = self._other
        if other:
            _end(other)

    def close(self) -> None:
        for tool in self._tools.values():
            if tool:
                tool.close()
        self._scratch.close()

    def run(self, job: Job) -> Outcome:
        """Runs all steps, up to the first that fails."""
        outcome = Outcome()
        for file in self._sweep.inputs(job):
            self._scratch.mirror(file)
        for step in self._sweep.steps:
            for word in self._plain.words(job, step)[1:]:
                if os.sep in word and os.path.exists(word):
                    self._scratch.mirror(word)
        for step in self._sweep.steps:
            for suffix in step.makes:
                self._scratch.free(job.path(suffix))
        try:
            for step in self._sweep.steps:
                outcome.commands.append(self._plain.words(job, step))
                outcome.status, outcome.messages = self._step(job, step)
                if outcome.status:
                    break
                outcome.messages = ""
                for suffix in step.files:
                    content = self._content(job.path(suffix))
                    if content is None:
                        outcome.status = 1
                        outcome.messages = f"{job.path(suffix)}: not written by this step\n"
                        break
                    outcome.files[suffix] = content
                if outcome.status:
                    break
        finally:
            self._scratch.empty()
        return outcome

    def _content(self, path: str) -> bytes | None:
        """The bytes of a file; None if it is missing or empty, which marks a step that is not done."""
        try:
            with open(os.path.join(self._scratch.path, path), "rb") as file:
                return self._scratch.placed(file.read()) or None
        except OSError:
            return None

    def _step(self, job: Job, step: Step) -> tuple[int, str]:
        """The status of a step, 0 if it is accepted, and its messages."""
        words = self._writer.words(job, step)
        folder = self._scratch.path
        errors = os.path.join(folder, job.stem + ".stderr.tmp")
        output = os.path.join(folder, job.path(step.redirect)) if step.redirect else ""
        status = self._served(words, output, errors)
        if status is None and self._is_killed:
            return 1, ""
        if status is None:
            status = self._spawned(words, output, errors)
        try:
            with open(errors, "rb") as file:
                said = file.read(MOST_MESSAGES + 1).decode("utf-8", "replace")
            os.unlink(errors)
        except OSError:
            said = ""
        if len(said) > MOST_MESSAGES:
            said = said[:MOST_MESSAGES] + "…\n"
        return (0 if status in self._sweep.accept else status), self._scratch.real(said)

    def _served(self, words: Sequence[str], output: str, errors: str) -> int | None:
        """By a tool that stays; None for other programs, and if the tool ended in the middle."""
        name = os.path.basename(words[0])
        if name == "ispace" and len(words) > 1 and words[1] in TOOLS:
            beside = os.path.join(os.path.dirname(words[0]), words[1])
            program, words = beside, words[1:]
        elif name in TOOLS:
            program = words[0]
        else:
            return None
        if program not in self._tools:
            found = shutil.which(program)
            self._tools[program] = Tool(found) if found and _serves(found) else None
        tool = self._tools[program]
        if tool is None:
            return None
        status = tool.run(self._scratch.path, output, errors, words[1:])
        if status is None:
            tool.close()
            self._tools[program] = None
        return status

    def _spawned(self, words: Sequence[str], output: str, errors: str) -> int:
        """By a process of its own, with the statuses of the shell."""
        try:
            with open(errors, "wb") as said, open(output or os.devnull, "wb") as told:
                self._other = subprocess.Popen(words, cwd=self._scratch.path, stdin=subprocess.DEVNULL, stdout=told,
                                               stderr=said, start_new_session=True)
                if self._is_killed:  # kill() came while it began
                    _end(self._other)
                status = self._other.wait()
        except OSError as error:
            with open(errors, "w", encoding="utf-8") as said_of_us:
                said_of_us.write(f"{words[0]}: {os.strerror(error.errno or 0)}\n")
            return NOT_FOUND if isinstance(error, FileNotFoundError) else NOT_RUN
        finally:
            self._other = None
        return status if status >= 0 else 128 - status


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ends a process and those that it began."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except OSError:
        pass  # it has ended


def _serves(program: str) -> bool:
    """Whether a program is one of ours, and no script of the same name in front of it."""
    try:
        with open(program, "rb") as file:
            if file.read(4) != b"\x7fELF":
                return False
        done = subprocess.run([program, "--serve-jobs"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, check=False)
    except OSError:
        return False
    return done.returncode == 0
