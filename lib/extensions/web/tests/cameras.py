#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page shows camera pictures, and drives omnidirectional robots sideways."""

import time

from page import Page
from running import LAYOUT, Run, check, eventually, pose, skip

try:
    from selenium.webdriver import ActionChains
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

CAMERAS = LAYOUT + """camera id=c1 at=0.4,0.4,1.8 heading=45 tilt=-20 pixels=160,120 fov=70 rate=30
camera id=c2 on=r1 at=0.15,0,0.2 pixels=80,60 fov=60
robot id=r3 at=5,6 drive=omni
mat id=m1 at=7,1 size=0.6,0.4
gate id=g1 at=7,1 width=0.6
"""

PICTURE = """const picture = document.getElementById('picture'), colors = new Set();
if (picture.width < 2) return [0, 0, 0];
const {data} = picture.getContext('2d').getImageData(0, 0, picture.width, picture.height);
for (let i = 0; i < data.length; i += 4) colors.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
return [picture.width, picture.height, colors.size];"""


def picture(page):
    """Width, height and number of colours of the camera's picture."""
    return page.browser.execute_script(PICTURE)


def looks_through(page, name, size):
    page.press("lenses", name)
    eventually(f"a picture of {name}", lambda: picture(page)[:2] == size)
    check(picture(page)[2] > 20, f"the picture of {name} shows nothing")
    check(page.text("camera-name").startswith(f"{name} at "), page.text("camera-name"))


def refreshes(page):
    """Again and again, and not too often."""
    seen, begun = set(), time.monotonic()
    while time.monotonic() < begun + 3:
        seen.add(page.text("camera-name"))
        time.sleep(0.02)
    check(2 <= len(seen) <= 14, f"{len(seen)} pictures in 3 s")


def click_map(page, x, y):
    """Clicks a point of the room."""
    width, height = page.map_size()
    rim = min(48, 0.08 * width)
    scale = min((width - rim) / 10.2, (height - rim) / 7.2)  # the outline, and its walls of 0.2 m
    page.click("fit")
    page.settle()
    ActionChains(page.browser).move_to_element_with_offset(
        page.part("map"), round((x - 5) * scale), round(-(y - 3.5) * scale)).click().perform()


def opens_and_closes(page):
    page.click("camera-close")
    check(not page.part("camera").is_displayed(), "the picture is shown still")
    click_map(page, 0.4, 0.4)
    eventually("a click on the camera shows it", lambda: picture(page)[:2] == [160, 120])
    click_map(page, 0.4, 0.4)
    eventually("another hides it", lambda: not page.part("camera").is_displayed())


def goes_sideways(run, page):
    page.select("r1")
    check("Q and E" not in page.text("hint"), "r1 is said to go sideways")
    page.select("r3")
    check("Q and E go sideways" in page.text("hint"), page.text("hint"))
    x, y = pose(run, "r3")
    ActionChains(page.browser).key_down("q").perform()
    eventually("r3 goes left", lambda: pose(run, "r3")[1] > y + 0.1)
    ActionChains(page.browser).key_up("q").perform()
    check(abs(pose(run, "r3")[0] - x) < 1e-3, "it went ahead, too")
    far = pose(run, "r3")[1]
    ActionChains(page.browser).key_down("E").perform()
    eventually("r3 goes right", lambda: pose(run, "r3")[1] < far - 0.1)
    ActionChains(page.browser).key_up("E").perform()


def on_a_phone(run):
    with Page(run.url, 400, 800, touch=True) as page:
        page.select("r3")
        side = page.browser.find_element("css selector", "#pad button[data-key=q]")
        check(side.is_displayed(), "no button to go sideways")
        page.screenshot("sideways_400.png")
        looks_through(page, "c1", [160, 120])
        page.screenshot("camera_400.png")
        scroll = page.browser.execute_script("return document.documentElement.scrollWidth")
        check(scroll <= 400, f"the page is {scroll} pixels wide")
        page.select("r1")
        check(not side.is_displayed(), "r1 cannot go sideways")


with Run(layout=CAMERAS) as run:
    with Page(run.url) as page:
        looks_through(page, "c1", [160, 120])
        refreshes(page)
        page.screenshot("camera_1280.png")
        looks_through(page, "c2", [80, 60])
        opens_and_closes(page)
        goes_sideways(run, page)
    on_a_phone(run)
