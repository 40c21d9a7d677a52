#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The first minutes of three people on the page: driving a robot, living in a flat, planning cameras in a house.
Their screenshots are those of docs/page.md."""

import os
import shutil
import subprocess
import tempfile
import time

from page import Page
from running import Run, ask, check, eventually, pose, skip

try:
    from selenium.webdriver import ActionChains, Keys
    from selenium.webdriver.support.select import Select
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

WEBGL = ("--enable-unsafe-swiftshader", "--use-angle=swiftshader")
WAY, SHINES = "#0072b2", "#f0b429"


def at(page, px, py):
    """The pointer at a pixel of the map."""
    width, height = page.map_size()
    return ActionChains(page.browser).move_to_element_with_offset(page.part("map"), px - width // 2, py - height // 2)


def rows(page, part="state-list"):
    return [row for row in page.part(part).find_elements("css selector", "li") if row.is_displayed()]


def heap(page):
    """Bytes of JavaScript in use, after what is not needed is freed."""
    page.browser.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
    return page.browser.execute_cdp_cmd("Runtime.getHeapUsage", {})["usedSize"]


def drives_a_robot():
    """The robot of the thesis: by keys, to a point with a heading round what is put in its way, and seen from above,
    beside and in numbers."""
    with Run("--web-edit", shipped=("scenes/ispace.env", "scenes/ispace.3dm")) as run, \
            Page(run.url, options=WEBGL) as page:
        page.select("r1")
        start = pose(run, "r1")
        ActionChains(page.browser).key_down(Keys.ARROW_UP).perform()
        eventually("it goes", lambda: pose(run, "r1")[1] < start[1] - 0.3)
        ActionChains(page.browser).key_up(Keys.ARROW_UP).perform()
        eventually("it stands", lambda: page.facts()["speed"] == 0)
        x, y = page.centers(WAY)  # of its ring
        page.part("map").send_keys("g")
        at(page, x + 20, y + 320).click_and_hold().move_by_offset(40, 0).move_by_offset(20, 0).release().perform()
        eventually("its way", lambda: ask(run, "WORLD", "STATE")[0].startswith("OK") and
                   page.colors().get(WAY, 0) > 300)
        page.screenshot("page_robot.png")
        eventually("it is there", lambda: "r1 has arrived" in page.log())
        eventually("it looks east", lambda: abs(page.facts()["heading"]) < 1)
        page.part("map").send_keys(Keys.ESCAPE)
        # A goal in a wall is refused, on the map and in the log.
        page.part("map").send_keys("g")
        at(page, 30, 30).click().perform()
        eventually("a refusal", lambda: "r1" in page.text("notice"))
        page.part("map").send_keys(Keys.ESCAPE)
        page.click("measure")
        at(page, 300, 300).click().perform()
        at(page, 400, 300).click().perform()
        eventually("a length", lambda: " m" in page.text("said"))
        page.click("measure")
        page.click("solid")
        eventually("three dimensions", lambda: page.part("space").is_displayed())
        time.sleep(0.5)
        page.screenshot("page_space.png")
        page.click("solid")
        Select(page.part("rate")).select_by_visible_text("5 ×")
        eventually("a faster clock", lambda: "rate=5" in ask(run, "WORLD")[0])
        print(f"heap of the robot's page: {heap(page) / 1e6:.1f} MB")


def lives_there():
    """A day of four people at 300 times its pace: lamps on the plan, a slider, a search, a course, the log."""
    with Run("--clock", "real:300", "--script", "week.txt",
             shipped=("examples/home/flat.env", "examples/home/flat.3dm", "examples/home/week.txt")) as run, \
            Page(run.url) as page:
        eventually("the time of day", lambda: page.text("time").startswith("day 1, "))
        eventually("states", lambda: rows(page))
        page.part("state-find").send_keys("lamp")
        eventually("lamps alone", lambda: all("lamp" in row.text for row in rows(page)))
        lamp = next(row for row in rows(page) if "hall-lamp on" in row.text)
        lamp.find_element("css selector", "button").click()
        eventually("the lamp of the hall", lambda: "hall-lamp.on=1" in ask(run, "WORLD", "STATE")[1])
        eventually("it shines on the plan", lambda: page.centers(SHINES))
        page.part("state-find").send_keys(Keys.CONTROL, "a")
        page.part("state-find").send_keys(Keys.DELETE)
        eventually("somebody is up", lambda: page.text("time").startswith("day 1, 07"), patience=200)
        lamp.find_element("css selector", ".course").click()
        eventually("its course", lambda: page.part("plot").is_displayed())
        page.part("log-find").send_keys("ann")
        eventually("what ann did", lambda: "ann" in page.log())
        page.screenshot("page_home.png")
        print(f"heap of the home's page: {heap(page) / 1e6:.1f} MB")


def plans():
    """A camera is added to the house, moved, turned and taken back; the storey is saved."""
    with Run("--web-edit", shipped=("scenes/house/house.env", "../tests/data/house.3dm", "scenes/house/ground.env",
                                    "scenes/house/upper.env")) as run, Page(run.url) as page:
        eventually("rooms to choose", lambda: page.part("rooms").is_displayed())
        eventually("something to edit", lambda: page.part("editing").is_displayed())
        page.part("edit-kind").send_keys("camera")
        page.part("edit-keys").send_keys("id=new fov=90 z=2.4 tilt=-30")
        page.part("edit-add").find_element("css selector", "button").click()
        width, height = page.map_size()
        at(page, 0.66 * width, 0.26 * height).click_and_hold().move_by_offset(-60, 60).release().perform()
        eventually("a camera", lambda: "ground/new" in " ".join(ask(run, "WORLD", "LIST")))
        eventually("it is chosen", lambda: "id=new" in page.text("edit-record"))
        check(",2.4 " in page.text("edit-record") and "heading=-135" in page.text("edit-record"), page.text("edit-record"))
        page.part("edit-value").send_keys("z=2.6", Keys.ENTER)
        eventually("it hangs higher", lambda: ",2.6 " in page.text("edit-record"))
        page.click("edit-left")
        eventually("it has turned", lambda: "heading=-120" in page.text("edit-record"))
        page.part("lenses").find_element("css selector", "button").click()
        eventually("its picture", lambda: " at " in page.text("camera-name"))
        time.sleep(1)
        page.screenshot("page_planner.png")
        page.click("edit-undo")
        eventually("it has turned back", lambda: "heading=-135" in page.text("edit-record"))
        check("wants a room" not in page.log(), page.log())
        folder = tempfile.mkdtemp()
        try:
            page.browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": folder})
            for form in ("env", "3dm"):
                page.click(f"save-{form}")
                eventually(f"ground.{form}", lambda form=form: os.path.exists(os.path.join(folder, f"ground.{form}")))
            report = subprocess.run(["coverage", "ground.env", "ground.3dm", "-q", "--json"], cwd=folder, text=True,
                                    capture_output=True, check=False)
            check(report.returncode == 0 and '"new"' in report.stdout, f"coverage does not read them: {report.stderr}")
        finally:
            shutil.rmtree(folder)
        print(f"heap of the planner's page: {heap(page) / 1e6:.1f} MB")


if __name__ == "__main__":
    drives_a_robot()
    lives_there()
    plans()
