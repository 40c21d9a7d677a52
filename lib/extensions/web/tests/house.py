#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a building in which people live: its lamps and doors, whom it follows over the stairs, and its clock."""

import os
import socket

from page import Page
from running import Run, ask, check, eventually, skip

try:
    from selenium.webdriver import ActionChains, Keys
    from selenium.webdriver.support.select import Select
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

BUILDING = """- storey: {id: ground, height: 3, records: &room [{fence: {id: f, path: [[0, 0], [12, 0], [12, 8], [0, 8]], closed: yes}}, {lamp: {id: lamp, at: [9, 6]}}]}
- storey: {id: upper, z: 3, height: 3, records: *room}
- stairs: {id: s1, storeys: 'ground,upper', at: [4, 1], heading: 0, size: [1.6, 4]}
"""
LAYOUT = """#3dm 1
human id=ground/h1 at=6,4
human id=ground/h2 at=10,7
robot id=upper/r1 at=8,6
"""


def buttons(page, part):
    return {button.text.split()[0]: button for button in page.part(part).find_elements("tag name", "button")
            if button.text.strip()}


def lamp(page, press=False):
    """Whether the button of the lamp is pressed, null without one; presses it."""
    return page.browser.execute_script("""
        const lamp = document.querySelector('#state-list li button');
        if (lamp && arguments[0]) lamp.click();
        return lamp && lamp.getAttribute('aria-pressed') === 'true';""", press)


def switches(run, page):
    """The lamp of the storey that is shown, and no other."""
    eventually("the lamp", lambda: lamp(page) is False)
    lamp(page, press=True)
    eventually("it is on", lambda: "ground/lamp.on=1" in ask(run, "WORLD", "STATE")[1])
    check("upper/lamp.on=0" in ask(run, "WORLD", "STATE")[1], "the other lamp is on, too")
    eventually("the button is pressed", lambda: lamp(page))
    # On the map it shines, and a press there puts it out.
    x, y = eventually("it shines", lambda: page.centers("#f0b429"))
    width, height = page.map_size()
    press = ActionChains(page.browser).move_to_element_with_offset(page.part("map"), x - width / 2 + 5, y - height / 2)
    press.click().perform()
    eventually("it is out", lambda: "ground/lamp.on=0" in ask(run, "WORLD", "STATE")[1])
    eventually("the button is up", lambda: lamp(page) is False)
    lamp(page, press=True)
    eventually("it is on again", lambda: lamp(page))
    ask(run, "WORLD", "ACT upper/lamp on=1")
    ask(run, "WORLD", "ACT ground/lamp on=0")
    eventually("it follows its own storey", lambda: lamp(page) is False)
    check("upper/lamp: on 1" in page.log(), f"the log is {page.log()}")
    page.part("state-list").find_element("css selector", "input").click()  # whatever is typed there is no shortcut
    page.browser.switch_to.active_element.send_keys(" f.")
    check(page.text("run") == "Pause", "typing has paused the world")


def follows(run, page):
    names = buttons(page, "movers")
    check(set(names) == {"ground/h1", "ground/h2", "upper/r1"}, f"the list has {set(names)}")
    check("upper" in names["upper/r1"].text, f"r1 is {names['upper/r1'].text}")
    page.select("ground/h1")
    page.click("follow")
    with socket.create_connection(("127.0.0.1", run.port)) as client:  # it goes as long as somebody leads it
        client.sendall(b"PERSON ground/h1\nGOTO upper/9,3\n")
        eventually("the storey above", lambda: page.chosen("rooms") == "upper")
        eventually("h1 arrives", lambda: page.facts().get("x", 0) > 8.9)
    eventually("its way is told", lambda: "ground/h1 comes to s1" in page.log() and "ground/h1 comes to upper" in page.log())
    check("DELETE" not in page.log(), f"the log is {page.log()}")
    check(page.part("follow").get_attribute("aria-pressed") == "true", "it follows no more")
    check(page.text("name") == "ground/h1", f"{page.text('name')} is selected")
    # Another one in another room.
    page.select("ground/h2")
    eventually("h2's storey", lambda: page.chosen("rooms") == "ground" and page.facts().get("x") == 10)


def keeps_to_its_widgets(run, page):
    """Keys within the chooser of storeys neither drive nor pause."""
    rooms = page.part("rooms")
    rooms.send_keys(Keys.ARROW_DOWN)
    eventually("the next storey", lambda: page.browser.title == "office.env, upper")
    rooms.send_keys(Keys.SPACE)
    rooms.send_keys(Keys.ESCAPE)
    check(page.text("run") == "Pause", "a key of the chooser has paused the world")
    page.click("run")
    eventually("a pause", lambda: page.text("pace") == "paused")
    page.click("run")
    check(page.chosen("rate") == "10 ×", f"the rate is {page.chosen('rate')}")
    Select(page.part("rate")).select_by_visible_text("50 ×")
    eventually("the clock is faster", lambda: "rate=50" in ask(run, "WORLD")[0])
    eventually("the page says so", lambda: 40 < float((page.text("pace") or "0").split()[0]) < 60)


def keeps_its_trail(page, run):
    """A changed scene changes what it changes, and no more."""
    page.part("movers").find_elements("tag name", "button")[0].send_keys(Keys.NULL)
    focused = page.browser.execute_script(
        "document.querySelector('#movers button').focus(); return document.activeElement.textContent")
    pace = page.text("pace")
    page.click("farther")
    page.browser.execute_script("document.querySelector('#movers button').focus()")
    ask(run, "WORLD", "ADD cube id=ground/b at=2,2 size=0.3", "ADD cube id=upper/b at=2,6 size=0.3")
    eventually("it is told", lambda: "changed: ADD" in page.log())
    page.settle()
    now = page.browser.execute_script("return document.activeElement.textContent")
    check(now == focused, f"the focus went from {focused} to {now}")
    check(page.text("pace") != "", f"the pace was {pace}, and is gone")


SCRIPT = "daily 00:01 ground/h2 walk: stays 30s\n"

with Run("--clock", "real:10", environment=BUILDING, layout=LAYOUT) as run, Page(run.url) as page:
    eventually("rooms to choose", lambda: page.part("rooms").is_displayed())
    switches(run, page)
    follows(run, page)
    page.screenshot("house.png")
    keeps_to_its_widgets(run, page)
    keeps_its_trail(page, run)

with open(os.path.join(os.environ.get("TMPDIR", "/tmp"), f"days-{os.getpid()}.txt"), "w", encoding="utf-8") as script:
    script.write("daily 00:01 p1 walk: stays 30s\n")
try:
    with Run("--clock", "real:100", "--script", script.name, layout="#3dm 1\nhuman id=p1 at=2,2\n") as run, \
            Page(run.url) as page:
        eventually("the time of day", lambda: page.text("time").startswith("day 1, 0"))
finally:
    os.remove(script.name)
