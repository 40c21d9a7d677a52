#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Planned ways on the map: that of a robot that goes somewhere, planned anew round what is put in it, and through a
building, storey by storey."""

import socket

from page import Page
from running import Run, ask, check, eventually, skip

try:
    from selenium.webdriver import ActionChains
    from selenium.webdriver.support.select import Select
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

WAY = "#0072b2"  # of the chosen one, and of its ring
ROOM = """#env 1
fence id=outer path=0,0;10,0;10,6;0,6 closed=yes
wall id=low from=5,0 to=5,2 thickness=0.1
wall id=high from=5,3.4 to=5,4.4 thickness=0.1
inside at=1,1
"""
BUILDING = """- storey: {id: ground, height: 3, records: &room [{fence: {id: f, path: [[0, 0], [12, 0], [12, 8], [0, 8]], closed: yes}}]}
- storey: {id: upper, z: 3, height: 3, records: *room}
- stairs: {id: s1, storeys: 'ground,upper', at: [4, 1], heading: 0, size: [1.6, 4]}
"""


def client(run, *requests):
    """A connection with a role, which stays until it is closed."""
    link = socket.create_connection(("127.0.0.1", run.port))
    link.sendall("".join(request + "\n" for request in requests).encode())
    return link


def height(page):
    """The mean height of the way on the map, in pixels; None without one."""
    page.settle()
    center = page.centers(WAY)
    return center and center[1]


def pixels(page):
    page.settle()
    return page.colors().get(WAY, 0)


def is_planned_anew(run, page):
    ask(run, "WORLD", "PAUSE")
    page.select("r1")
    ring = eventually("the ring of r1", lambda: pixels(page))
    with client(run, "ROBOT r1", "GOTO 9,2.7"):
        eventually("the way", lambda: pixels(page) > 2 * ring)
        straight = height(page)
        page.screenshot("way.png")
        ask(run, "WORLD", "ADD cube id=new at=5,2.7 size=1.3")
        eventually("another way", lambda: abs(height(page) - straight) > 20)
        page.screenshot("way_anew.png")
        page.click("ways")
        eventually("ways are left out", lambda: pixels(page) < 1.2 * ring)
        page.click("ways")
        ask(run, "WORLD", "RESUME")
        eventually("r1 is there", lambda: page.facts().get("x", 0) > 8.9)
    ask(run, "WORLD", "PAUSE")
    eventually("the way has come to its end", lambda: pixels(page) < 1.2 * ring)


def leads_upstairs(run, page):
    rooms = Select(page.part("rooms"))
    eventually("h1 in the list", lambda: "ground/h1" in page.text("movers"))
    page.select("ground/h1")
    rooms.select_by_visible_text("upper")
    eventually("the storey above", lambda: page.browser.title == "office.env, upper")
    eventually("h1 can be sent there", lambda: page.part("send").is_enabled())
    check("Send it" in page.text("hint"), page.text("hint"))
    check(pixels(page) == 0, "a way before it is sent")
    page.click("send")
    page.settle()
    ActionChains(page.browser).move_to_element_with_offset(page.part("map"), 150, -120).click().perform()
    eventually("its way after the stairs", lambda: pixels(page) > 60)
    page.screenshot("way_upper.png")
    rooms.select_by_visible_text("ground")
    eventually("h1 on the ground", lambda: page.facts().get("x") is not None and page.browser.title.endswith("ground"))
    eventually("its way to the stairs", lambda: pixels(page) > 60)
    page.screenshot("way_ground.png")
    page.click("follow")
    eventually("it is upstairs", lambda: page.browser.title == "office.env, upper")
    eventually("it has arrived", lambda: "ground/h1 has arrived" in page.log())


with Run(environment=ROOM, layout="#3dm 1\nrobot id=r1 at=1,2.7\n") as run, Page(run.url) as page:
    is_planned_anew(run, page)
with Run("--clock", "real:5", environment=BUILDING, layout="#3dm 1\nhuman id=ground/h1 at=9,6\n") as run, \
        Page(run.url) as page:
    eventually("rooms to choose", lambda: page.part("rooms").is_displayed())
    leads_upstairs(run, page)
