#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""recipes.py PAGE: runs the code of a page as a reader would, from top to bottom.

A recipe is an indented block of a Markdown page, or an .EX block in the EXAMPLES of a manual page. All of
a page run in one folder, which has the scenes, INPUTS, the files in inputs/ and links to lib and share. They are
lines for bash, and a line that fails is reported as PAGE:LINE, unless a mark before the block says else:
<!-- recipe: MARK --> in Markdown, .\\" recipe: MARK in roff. A MARK is one of

    not run: REASON
    file NAME             the block is the text of that file
    file NAME: COMMAND    and the command must accept it
    printed by: COMMAND   the command prints these lines among others; seconds may differ
    serves                simrun in the last line answers until it is interrupted, and ends with status 0
    session               `$` begins a command, `<` a line that is sent, `>` an answer; times may differ

Ports are those of the text, in a network namespace where the kernel grants one.
"""
import contextlib
import fcntl
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PATIENCE = 300  # seconds for one block, on a busy machine
TYPING = 0.5  # seconds for a line of a session: scans ten times a second then hold the answered state
MARKS = ("not run", "file", "printed by", "serves", "session")
INPUTS = {"map.yaml": "tests/data/map.yaml", "map.pgm": "tests/data/map.pgm", "scan.jpg": "tests/data/pictures/room.jpg",
          "house.ifc": "lib/extensions/ifc/golden/inputs/ifc/cabin-2x3-mm.ifc"}
ESCAPES = {r"\-": "-", r"\e": "\\", r"\(aq": "'", r"\(dq": '"', r"\&": ""}


class Broken(Exception):
    """A failing recipe, with its line of the page."""

    def __init__(self, line, why):
        super().__init__(why)
        self.line = line


class Block:
    """Lines of a page, the number of the first one, and the mark before them."""

    def __init__(self, first, mark):
        self.first, self.mark, self.lines = first, mark, []

    def text(self):
        return "\n".join(self.lines).rstrip() + "\n"


def markdown_blocks(lines):
    blocks, block, mark, inside = [], None, None, False
    for number, line in enumerate(lines, 1):
        if line.startswith("```"):
            raise Broken(number, "recipes are indented, not fenced")
        found = re.fullmatch(r"<!-- recipe: (.*) -->", line)
        if found:
            block, mark, inside = None, found[1], False
        elif line.startswith("    ") and (block or not inside):
            if not block:
                block, mark = Block(number, mark), None
                blocks.append(block)
            block.lines.append(line[4:])
        elif not line:
            if block:
                block.lines.append("")
            inside = False
        else:
            if mark:
                raise Broken(number, "a mark without a block")
            block, inside = None, True
    return blocks


def roff_blocks(lines):
    blocks, block, mark, examples = [], None, None, False
    for number, line in enumerate(lines, 1):
        found = re.fullmatch(r'\.\\" recipe: (.*)', line)
        if line.startswith(".SH "):
            examples = line.startswith(".SH EXAMPLES")
        elif found:
            mark = found[1]
        elif line == ".EX" and examples:
            block, mark = Block(number + 1, mark), None
            blocks.append(block)
        elif line == ".EE":
            block = None
        elif block:
            block.lines.append(re.sub(r"\\(?:\(..|.)", lambda escape: ESCAPES[escape[0]], line))
    return blocks


def start(script, **streams):
    """The lines in a shell that leads a process group."""
    return subprocess.Popen(["bash", "-c", script], start_new_session=True, text=True, **streams)


def stop(process):
    """Ends all that the process has started."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def as_script(lines, first):
    """Lines of the page as a script that stops at the first failure and knows their numbers."""
    trap = "trap 'echo \"line $LINENO: status $?: $BASH_COMMAND\" >&2' ERR; set -Eeuo pipefail"
    return trap + "\n" * (first - 1) + "\n".join(lines) + "\n"


def run_shell(script, first):
    """Standard output and error of the script, in order."""
    with tempfile.TemporaryFile("w+") as output:
        process = start(script, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
        try:
            status = process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            raise Broken(first, f"not done after {PATIENCE} s") from None
        finally:
            stop(process)
        output.seek(0)
        text = output.read()
    if status:
        told = re.search(r"^line (\d+): status", text, re.MULTILINE)
        raise Broken(int(told[1]) if told else first, f"status {status}\n{text[-2000:]}")
    return text


def without_times(line):
    return re.sub(r"(\bt=)\d+\.\d+|(?<=\bseq=)\d+|\b\d+(\.\d+)?( m?s\b)", r"\1…\3", line)


def run_printed(block, command):
    printed = [without_times(line) for line in run_shell(as_script([command], block.first), block.first).splitlines()]
    for number, line in enumerate(block.text().splitlines(), block.first):
        if without_times(line) not in printed:
            raise Broken(number, f"not printed by {command}; that prints\n" + "\n".join(printed))


def wait_for_server(process, line):
    """Reads simrun's first line, which holds its address."""
    for told in process.stdout:
        if told.startswith('{"schema":"ispace-simrun/'):
            return told.rstrip("\n")
    raise Broken(line, f"status {process.wait()} and no server\n{process.stderr.read()}")


def run_server(block):
    process = start(as_script(block.lines, block.first), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE)
    guard = watch(process)
    try:
        wait_for_server(process, block.first)
        time.sleep(0.3)
        os.killpg(process.pid, signal.SIGINT)
        _, talk = process.communicate(timeout=PATIENCE)
        if process.returncode:
            raise Broken(block.first, f"status {process.returncode} when interrupted\n{talk}")
    finally:
        guard.kill()
        stop(process)


def watch(process):
    """A process that ends `process` when it takes too long, so that no read of its output waits for ever."""
    return subprocess.Popen(["sh", "-c", f"exec sleep {PATIENCE}; kill -9 -{process.pid}"])


class Session:
    """Typed lines of a page: the server stays for the sessions that follow, a connection lasts a block."""

    def __init__(self):
        self.server = self.address = self.connection = None

    def run(self, block):
        self.connection = None
        for number, line in enumerate(block.text().splitlines(), block.first):
            try:
                self.do(number, line[:2].strip(), line[2:])
            except (OSError, AttributeError) as error:
                raise Broken(number, f"no connection: {error}") from None

    def do(self, number, sign, text):
        if sign == "$" and text.startswith("nc "):
            self.address = text.split()[1:3]
        elif sign == "$" and text.endswith("&"):
            self.server = start(text[:-1], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.announced = wait_for_server(self.server, number)
        elif sign == "$":
            run_shell(as_script([text], number), number)
        elif sign == "<":
            if not self.connection:
                self.connection = socket.create_connection(self.address, timeout=30).makefile("rw")
                self.greeting = self.connection.readline()
            time.sleep(TYPING)
            self.connection.write(text + "\n")
            self.connection.flush()
        else:
            self.expect(number, sign, text)

    def expect(self, number, sign, text):
        if sign != ">":
            found, text = self.announced, sign + text
        elif not self.connection:
            self.connection = socket.create_connection(self.address, timeout=30).makefile("rw")
            found = self.connection.readline().rstrip("\n")
        else:
            found = self.connection.readline().rstrip("\n")
        if without_times(found) != without_times(text):
            raise Broken(number, f"the answer is\n{found}")

    def close(self):
        if self.server:
            stop(self.server)
        self.server = None


def run_block(block, session):
    kind, _, rest = (block.mark or "").partition(":")
    kind, _, name = kind.partition(" ") if kind.startswith("file ") else (kind, "", "")
    if block.mark and kind not in MARKS:
        raise Broken(block.first, f"unknown mark: {block.mark}")
    if kind != "session":
        session.close()
    if kind == "not run":
        if not rest.strip():
            raise Broken(block.first, "no reason why it is not run")
        print(f"line {block.first}: not run:{rest}")
    elif kind == "file":
        with open(name, "w", encoding="utf-8") as file:
            file.write(block.text())
        if rest:
            run_shell(as_script([rest], block.first), block.first)
    elif kind == "printed by":
        run_printed(block, rest)
    elif kind == "serves":
        run_server(block)
    elif kind == "session":
        session.run(block)
    else:
        run_shell(as_script(block.lines, block.first), block.first)


def furnish(folder):
    """Copies the files that the text names into the folder."""
    for origin in (os.path.join(SOURCE, "share", "scenes"), os.path.join(HERE, "inputs")):
        shutil.copytree(origin, folder, dirs_exist_ok=True)
    for name, origin in INPUTS.items():
        shutil.copy(os.path.join(SOURCE, origin), os.path.join(folder, name))
    for name in ("lib", "share"):
        os.symlink(os.path.join(SOURCE, name), os.path.join(folder, name))
    os.environ["PYTHONPATH"] = os.path.join(SOURCE, "lib", "client", "python")
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"


def into_own_network():
    """Starts this program again where its ports are its own, if the kernel lets it."""
    if os.environ.get("ISPACE_OWN_NETWORK"):
        with socket.socket() as lo:
            fcntl.ioctl(lo, 0x8914, struct.pack("16sh", b"lo", 1))  # SIOCSIFFLAGS, IFF_UP
    elif subprocess.run(["unshare", "-rn", "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
        os.environ["ISPACE_OWN_NETWORK"] = "yes"
        os.execvp("unshare", ["unshare", "-rn", sys.executable, *sys.argv])


def run_page(page):
    """The number of recipes that fail."""
    with open(page, encoding="utf-8") as file:
        lines = file.read().splitlines()
    session, failures = Session(), 0
    blocks = (markdown_blocks if page.endswith(".md") else roff_blocks)(lines)
    for block in blocks:
        try:
            run_block(block, session)
        except Broken as broken:
            print(f"{page}:{broken.line}: {broken}", file=sys.stderr)
            failures += 1
    session.close()
    print(f"{len(blocks)} recipes, {failures} of them broken")
    return failures if blocks else 1


def main():
    into_own_network()
    page = os.path.abspath(sys.argv[1])
    scratch = os.path.join(os.environ["ISPACE_BINARY_DIR"], "tests", "scratch")
    os.makedirs(scratch, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="recipes.", dir=scratch) as folder:
        furnish(folder)
        os.chdir(folder)
        try:
            return 1 if run_page(page) else 0
        except Broken as broken:
            print(f"{page}:{broken.line}: {broken}", file=sys.stderr)
            return 1
        finally:
            os.chdir(HERE)


if __name__ == "__main__":
    sys.exit(main())
