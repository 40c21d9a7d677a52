#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The drawing of the page, at the width of a desk and of a phone."""

from page import Page
from running import Run, check

FLOOR, WALL, ROBOT, PERSON, SELECTED = "#fbf5e9", "#24292f", "#8e2c2c", "#33507a", "#0072b2"


def looks(url, width, height):
    with Page(url, width, height, touch=width < 500) as page:
        check(page.browser.title == "office.env", f"the title is {page.browser.title}")
        map_width, map_height = page.map_size()
        check(map_width > 0.7 * width and map_height > 0.4 * height, "the map is small")
        scroll = page.browser.execute_script("return document.documentElement.scrollWidth")
        check(scroll <= width, f"the page is {scroll} pixels wide on a screen of {width}")
        page.screenshot(f"looks_{width}.png")

        colors = page.colors()
        for what, color in (("walls", WALL), ("robots", ROBOT), ("people", PERSON)):
            check(colors.get(color, 0) > 30, f"no {what} at {width}")
        # Scans lie on most of the floor; without them it shows.
        page.click("scans")
        page.settle()
        bare = page.colors()
        shown, hidden = colors.get(FLOOR, 0), bare.get(FLOOR, 0)
        check(hidden > 1.5 * shown, f"floor with scans {shown}, without {hidden}")
        check(SELECTED not in bare, "something is selected")
        page.select("r1")
        page.settle()
        check(page.colors().get(SELECTED, 0) > 20, "the selected robot has no ring")
        facts = page.facts()
        check(facts["x"] == 2 and facts["y"] == 2, f"r1 is said to be at {facts}")
        page.screenshot(f"selected_{width}.png")


with Run() as run:
    looks(run.url, 1280, 800)
    looks(run.url, 400, 800)
