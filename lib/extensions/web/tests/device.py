#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of one device (?device=ID), as a handheld shows it: its states or its picture, and no other; things of
extensions are pressed, and an LED has its colour on the map."""

from page import Page
from running import Run, ask, check, eventually

HOME = """#env 1
ispace size=6,4,2.5 ceiling=yes
inside at=0,0
lamp id=l1 at=1,0
lamp id=l2 at=-1,0
"""
LAYOUT = """#3dm 1
robot id=r1 at=2,-1
led id=busy of=r1 at=0,0,0.3 color=1,0,0
camera id=eye at=-2,0,1 pixels=64,48 fov=60
"""


def listed(page):
    """What the page lists: ["l1 on", ...]"""
    return page.browser.execute_script(
        "return [...document.querySelectorAll('#state-list li > :first-child')].map(part => part.firstChild.textContent.trim())")


def is_shown(page, name):
    return page.part(name).is_displayed()


def states_of(run):
    return dict(word.split("=", 1) for word in ask(run, "WORLD", "STATE")[1].split() if "=" in word)


with Run(environment=HOME, layout=LAYOUT) as run:
    with Page(run.url + "?device=l1", 400, 700) as page:
        eventually("the states of the lamp", lambda: listed(page) == ["l1 on", "l1 level", "l1 color"])
        check(page.text("title") == "l1", f"the title is {page.text('title')}")
        check(not is_shown(page, "map") and not is_shown(page, "run") and not is_shown(page, "log"), "more than the device")
        page.part("state-list").find_element("tag name", "button").click()
        eventually("the lamp", lambda: states_of(run)["l1.on"] == "1")
        page.screenshot("device.png")
    with Page(run.url + "?device=eye", 400, 700) as page:
        eventually("the picture", lambda: is_shown(page, "picture") and page.browser.execute_script(
            "return document.getElementById('picture').width") == 64)
        check(not is_shown(page, "states"), "a camera has no states")
    with Page(run.url + "?device=x", 400, 700) as page:
        eventually("a word about it", lambda: "is x" in page.text("banner"))
    with Page(run.url, 1200, 800) as page:
        eventually("all states", lambda: "busy on" in listed(page) and "l2 on" in listed(page))
        before = page.colors().get("#ff0000", 0)
        page.press("state-list", "busy on")
        eventually("the LED", lambda: states_of(run)["busy.on"] == "1")
        eventually("its colour on the map", lambda: page.colors().get("#ff0000", 0) > before + 10)
