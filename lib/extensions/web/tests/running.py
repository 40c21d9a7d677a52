# SPDX-License-Identifier: GPL-3.0-or-later
"""For the tests of this folder: a simrun with a page, and a browser that shows it."""

import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time

try:
    from selenium.common.exceptions import NoSuchElementException, StaleElementReferenceException
    CHANGING = (NoSuchElementException, StaleElementReferenceException)
except ImportError:
    CHANGING = ()

SHARE = os.path.join(os.environ["ISPACE_SOURCE_DIR"], "share")
PATIENCE = 60  # seconds; far more than anything here takes


def skip(why):
    print("skipped:", why)
    sys.exit(77)


def fail(what):
    sys.exit(f"failed: {what}")


def check(is_so, what):
    if not is_so:
        fail(what)


def eventually(what, condition, patience=PATIENCE):
    """The first result of the condition that counts as true. A page that changes while a condition reads several of its
    parts does not meet it yet."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        try:
            result = condition()
        except CHANGING:
            result = None
        if result:
            return result
        time.sleep(0.05)
    fail(f"in vain: {what}")


ENVIRONMENT = """#env 1
fence id=outer path=0,0;10,0;10,7;4,7;4,5;0,5 closed=yes thickness=0.2 height=2.6
wall id=inner from=6,0 to=6,4 thickness=0.12 height=2.6
inside at=1,1
door id=entry wall=inner offset=1.5 size=0.9,2.1 open=yes
floor id=carpet at=2,3.2 size=2.5,2 kind=checker
zone id=kitchen at=8,1.6 size=3,2.4
desk id=d1 at=1.2,4.2
table id=t1 at=8,5
cube id=box at=4.6,1.1 size=0.5
"""
LAYOUT = """#3dm 1
robot id=r1 model=pioneer-2dx at=2,2
laser id=l1 on=r1 at=0.1,0,0.2 fov=180 range=6
robot id=r2 at=8,3 heading=120
laser id=l2 at=0.3,0.3,0.3 heading=45 fov=90 range=8
human id=h1 at=3.2,3.9 heading=200
"""


class Run:
    """A simrun that serves a page; it ends with the block that uses it."""

    def __init__(self, *arguments, environment=ENVIRONMENT, layout=LAYOUT, shipped=(), web="127.0.0.1:0"):
        """shipped: files of share instead of these two, by their paths below it; the first two are the operands"""
        self.folder = tempfile.mkdtemp()
        operands = [os.path.basename(path) for path in shipped[:2]] or ["office.env", "office.3dm"]
        for path in shipped:
            shutil.copy(os.path.join(SHARE, path), self.folder)
        for name, text in () if shipped else zip(operands, (environment, layout)):
            with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        self.process = subprocess.Popen(
            ["simrun", *operands, "-q", "--web", web, *arguments],
            cwd=self.folder, stdout=subprocess.PIPE, text=True)
        self.announced = json.loads(self.process.stdout.readline())
        self.url = self.announced["web"]
        self.port = int(self.announced["listen"].rsplit(":", 1)[1])

    def stop(self):
        self.process.terminate()
        return self.process.wait(PATIENCE)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        shutil.rmtree(self.folder)


def ask(run, *requests):
    """The replies on a separate connection."""
    with socket.create_connection(("127.0.0.1", run.port)) as client:
        lines = client.makefile("rw", newline="\n")
        lines.readline()
        answers = []
        for request in requests:
            lines.write(request + "\n")
            lines.flush()
            answers.append(lines.readline().rstrip("\n"))
        return answers


def pose(run, mover):
    """x and y from the server."""
    poses = ask(run, "WORLD", "POSES")[1].split("poses=")[1].split()[0]
    for row in poses.split(";"):
        name, x, y = row.split(",")[:3]
        if name == mover:
            return float(x), float(y)


def start_browser(width, height, *more, touch=False):
    """A headless Chromium with a page of that size, and with more options, by chromium-driver."""
    for program in ("chromium", "chromedriver"):
        if shutil.which(program) is None:
            skip(f"no {program} here (Debian: chromium, chromium-driver)")
    try:
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service
    except ImportError:
        skip("no selenium here (Debian: python3-selenium)")
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    # As root, which checks may run as, Chromium has no sandbox.
    for option in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                   "--hide-scrollbars", f"--window-size={width},{height}", *more):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                            {"width": width, "height": height, "deviceScaleFactor": 1,
                             "mobile": touch})
    return browser
