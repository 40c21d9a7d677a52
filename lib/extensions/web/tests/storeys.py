#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page shows a building, one of its rooms at a time."""

from page import Page
from running import Run, ask, check, eventually, skip

try:
    from selenium.webdriver.support.select import Select
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

BUILDING = """- storey: {id: ground, height: 3, records: &room [{fence: {id: f, path: [[0, 0], [12, 0], [12, 8], [0, 8]], closed: yes}}]}
- storey: {id: upper, z: 3, height: 3, records: *room}
- stairs: {id: s1, storeys: 'ground,upper', at: [4, 1], heading: 0, size: [1.6, 4]}
"""
LAYOUT = """#3dm 1
human id=ground/h1 at=6,4
robot id=upper/r1 at=8,6
laser id=upper/l1 at=11,7,0.2 heading=225
"""

with Run("--clock", "real:10", environment=BUILDING, layout=LAYOUT) as run, Page(run.url) as page:
    rooms = Select(page.part("rooms"))
    eventually("rooms to choose", lambda: page.part("rooms").is_displayed())
    check([option.text for option in rooms.options] == ["ground", "upper", "s1"], "other rooms")
    eventually("the ground floor", lambda: page.browser.title == "office.env, ground")
    page.select("ground/h1")
    check(ask(run, "PERSON ground/h1", "GOTO upper/9,3")[1].startswith("OK GOTO"), "no way")
    rooms.select_by_visible_text("upper")
    eventually("the upper floor", lambda: page.browser.title == "office.env, upper")
    page.select("upper/r1")
    check(page.facts()["x"] == 8, "r1 is elsewhere")
