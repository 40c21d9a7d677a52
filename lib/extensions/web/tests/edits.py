#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""With --web-edit the page changes the room: things and sensors are added, moved, turned, deleted, and all is taken back;
what it saves is a room that the tools read."""

import os
import shutil
import subprocess
import tempfile

from page import Page
from running import Run, ask, check, eventually, skip
from tools import press

try:
    from selenium.webdriver import ActionChains, Keys
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")


def record(run, name, room=""):
    """The record of something as the world has it; "" without one."""
    import socket
    with socket.create_connection(("127.0.0.1", run.port)) as client:
        lines = client.makefile("rw", newline="\n")
        lines.write(f"WORLD\nRECORDS {room}\n".replace(" \n", "\n"))
        lines.flush()
        for line in lines:
            if line.startswith("OK RECORDS"):
                count = sum(int(word.split("=")[1]) for word in line.split() if word.startswith(("room=", "placed=")))
                return next((text.strip() for text in [next(lines) for _ in range(count)] if f" id={name} " in text), "")


def adds(run, page, kind, at, to=None, keys=""):
    for name, text in (("edit-kind", kind), ("edit-keys", keys)):
        page.part(name).clear()
        page.part(name).send_keys(text)
    page.part("edit-keys").send_keys(Keys.ENTER)
    eventually("the hint", lambda: page.text("said").startswith(f"Press where {kind.split()[0]}"))
    press(page, at, *([to] if to else []))


def edits(run, page):
    kinds = page.browser.execute_script("return [...document.querySelectorAll('#edit-kinds option')].map(o => o.value)")
    check("desk" in kinds and "laser model=hokuyo-ust-10lx" in kinds or any("laser model=" in kind for kind in kinds),
          f"the catalogue has {kinds}")
    page.click("names")
    adds(run, page, "desk", (3, 2), (3, 3), "size=1,0.5")
    text = eventually("a desk", lambda: record(run, "desk1"))
    check("heading=90" in text and "size=1,0.5" in text, f"the desk is {text}")
    x, y = (float(value) for value in text.split(" at=")[1].split()[0].split(","))
    check(abs(x - 3) < 0.03 and abs(y - 2) < 0.03, f"it stands at {x, y}")
    eventually("it is chosen", lambda: "id=desk1" in page.text("edit-record"))

    press(page, (3, 2), (4, 3))
    eventually("it has moved", lambda: " at=4" in record(run, "desk1") or " at=3.99" in record(run, "desk1"))
    page.click("edit-left")
    eventually("it has turned", lambda: "heading=105" in record(run, "desk1"))
    page.part("edit-value").send_keys("size=1.2,0.6", Keys.ENTER)
    eventually("it has grown", lambda: "size=1.2,0.6" in record(run, "desk1"))
    page.screenshot("edited_1280.png")
    page.part("edit-value").send_keys("size=1.2,0.6,huge", Keys.ENTER)
    eventually("a complaint", lambda: "huge" in page.text("notice"))
    page.click("edit-delete")
    eventually("it is gone", lambda: not record(run, "desk1"))
    for what, holds in (("it is back", lambda text: "heading=105" in text), ("the old size", lambda text: "size=1,0.5" in text),
                        ("the old heading", lambda text: "heading=90" in text), ("the old place", lambda text: " at=3,2" in text or "at=3.0" in text or "at=2.9" in text)):
        page.click("edit-undo")
        eventually(what, lambda: holds(record(run, "desk1")))
    page.click("edit-undo")
    eventually("no desk", lambda: not record(run, "desk1"))
    eventually("no more to undo", lambda: not page.part("edit-undo").is_enabled())


def undo(page):
    ActionChains(page.browser).key_down(Keys.CONTROL).send_keys("z").key_up(Keys.CONTROL).perform()


def places(run, page):
    """Sensors, robots and people, too."""
    adds(run, page, "camera", (5, 3), (5, 4))
    eventually("a camera", lambda: "heading=90" in record(run, "camera1"))
    adds(run, page, "human", (7, 6))
    eventually("a person", lambda: record(run, "human1"))
    eventually("she is in the list", lambda: "human1" in page.text("movers"))
    adds(run, page, "robot", (5.2, 6))
    eventually("a robot", lambda: record(run, "robot1"))
    page.part("edit-kind").clear()
    page.part("edit-kind").send_keys("laser")
    page.part("edit-keys").send_keys("on=robot1 at=0,0,0.2", Keys.ENTER)
    eventually("a laser on it", lambda: "on=robot1" in record(run, "laser1"))
    press(page, (5.2, 6), (5.2, 4))
    eventually("the robot was moved", lambda: abs(float(record(run, "robot1").split(" at=")[1].split()[0].split(",")[1]) - 4) < 0.05)
    undo(page)
    eventually("and back", lambda: abs(float(record(run, "robot1").split(" at=")[1].split()[0].split(",")[1]) - 6) < 0.05)
    # What is taken back is the last change, also before it is answered.
    eventually("the page sees it", lambda: "SET robot1.at=5.2,6" in page.log())
    page.settle()
    page.browser.execute_script("WebSocket.prototype.send = (send => function(text) { setTimeout(() => send.call(this, text), 200); })"
                                "(WebSocket.prototype.send)")
    press(page, (5.2, 6), (5.2, 4))
    undo(page)
    eventually("both changes", lambda: page.log().count("SET robot1.at=") == 4)
    eventually("back again", lambda: abs(float(record(run, "robot1").split(" at=")[1].split()[0].split(",")[1]) - 6) < 0.05)
    check(record(run, "laser1"), "an older change was taken back")


def saves(page):
    folder = tempfile.mkdtemp()
    try:
        page.browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": folder})
        for form in ("env", "3dm"):
            page.click(f"save-{form}")
            eventually(f"office.{form}", lambda form=form: os.path.exists(os.path.join(folder, f"office.{form}")))
        result = subprocess.run(["simrun", "office.env", "office.3dm", "-q", "--clock", "fast", "--until", "1"], cwd=folder,
                                capture_output=True, text=True, check=False)
        check(result.returncode == 0, f"simrun does not read them: {result.stderr}")
        with open(os.path.join(folder, "office.3dm"), encoding="utf-8") as file:
            text = file.read()
        check(any(line.startswith("laser id=laser1 ") and " on=robot1" in line for line in text.splitlines()),
              f"the laser is not saved: {text}")
    finally:
        shutil.rmtree(folder)


BUILDING = """- storey: {id: ground, height: 3, records: &room [{fence: {id: f, path: [[0, 0], [12, 0], [12, 8], [0, 8]], closed: yes}}]}
- storey: {id: upper, z: 3, height: 3, records: *room}
"""


def main():
    with Run("--web-edit") as run, Page(run.url) as page:
        eventually("the section", lambda: page.part("editing").is_displayed())
        edits(run, page)
        places(run, page)
        saves(page)
        page.screenshot("edits_1280.png")
    with Run() as run, Page(run.url) as page:
        page.settle()
        check(not page.part("editing").is_displayed() and not page.part("edit").is_displayed(), "it edits without --web-edit")
    with Run("--web-edit", environment=BUILDING, layout="#3dm 1\nrobot id=ground/r1 at=2,2\n") as run, Page(run.url) as page:
        eventually("the section", lambda: page.part("editing").is_displayed())
        adds(run, page, "desk", (6, 4))
        eventually("a desk of that storey", lambda: record(run, "desk1", "ground"))
        check(not record(run, "desk1", "upper"), "it is in the other storey, too")
        page.click("edit-delete")
        eventually("it is gone", lambda: not record(run, "desk1", "ground"))
        page.click("edit-undo")
        eventually("it is back", lambda: record(run, "desk1", "ground"))


if __name__ == "__main__":
    main()
