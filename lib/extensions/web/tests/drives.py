#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions on the page reach the world: keys, drags, buttons, the pad of phones."""

import time

from page import Page
from running import Run, ask, check, eventually, pose, skip

try:
    from selenium.webdriver import ActionChains, Keys
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")


def drives_by_keys(run, page):
    page.select("r1")
    page.part("map").click()  # on the floor: this ends the selection
    page.select("r1")
    start = pose(run, "r1")
    actions = ActionChains(page.browser)
    actions.key_down(Keys.ARROW_UP).perform()
    eventually("r1 moves", lambda: pose(run, "r1")[0] > start[0] + 0.2)
    eventually("the page shows its speed", lambda: page.facts()["speed"] > 0)
    ActionChains(page.browser).key_up(Keys.ARROW_UP).perform()
    eventually("r1 stops", lambda: page.facts()["speed"] == 0)
    eventually("the page shows its place",
               lambda: abs(page.facts()["x"] - pose(run, "r1")[0]) < 0.002)
    heading = page.facts()["heading"]
    ActionChains(page.browser).key_down(Keys.ARROW_LEFT).perform()
    eventually("r1 turns left", lambda: page.facts()["heading"] > heading + 10)
    ActionChains(page.browser).key_up(Keys.ARROW_LEFT).perform()
    eventually("r1 turns no more", lambda: page.facts()["turn"] == 0)


def holds_and_frees(run, page):
    """The page drives the selected mover, until another selection."""
    check(ask(run, "ROBOT r1")[0].startswith("ERR 409"), "r1 is free while the page drives it")
    page.select("r2")
    eventually("r1 is free", lambda: ask(run, "ROBOT r1")[0].startswith("OK ROBOT r1"))


def follows(page):
    page.select("r1")
    page.click("follow")
    width, height = page.map_size()
    eventually("r1 is in the middle",
               lambda: near(page.centers("#0072b2"), (width / 2, height / 2), 3))
    return width, height


def near(found, wanted, most):
    return found and abs(found[0] - wanted[0]) <= most and abs(found[1] - wanted[1]) <= most


def drags_a_goal(run, page):
    """Followed, the robot is in the middle: from there its goal is dragged, back where it came from,
    as how far it drove depends on how fast the browser is."""
    follows(page)
    x, y = pose(run, "r1")
    ActionChains(page.browser).move_to_element(page.part("map")).click_and_hold().move_by_offset(
        -40, 20).move_by_offset(-40, 20).release().perform()
    eventually("r1 has arrived", lambda: "r1 has arrived" in page.log())
    after = pose(run, "r1")
    check(after[0] < x - 0.5 and after[1] < y - 0.1, f"from {x, y} it went to {after}")
    width, height = page.map_size()
    eventually("r1 is in the middle still",
               lambda: near(page.centers("#0072b2"), (width / 2, height / 2), 3))


def pauses(run, page):
    page.click("run")
    eventually("the page says so", lambda: page.text("pace") == "paused")
    paused = page.time()
    time.sleep(0.5)
    check(page.time() == paused, "the clock goes on")
    before = ask(run, "WORLD", "TIME")[1]
    page.click("step")
    eventually("a step is taken", lambda: ask(run, "WORLD", "TIME")[1] != before)
    steps = [int(text.split("steps=")[1]) for text in (before, ask(run, "WORLD", "TIME")[1])]
    check(steps[1] == steps[0] + 1, f"not one step: {steps}")
    # By the keyboard alone.
    page.part("map").send_keys(" ")
    eventually("time goes on", lambda: page.time() > paused + 0.2)
    check(page.text("run") == "Pause", "the button does not know")


def drives_people(run, page):
    """She walks on until something is in her way."""
    page.select("h1")
    before = pose(run, "h1")
    ActionChains(page.browser).key_down(Keys.ARROW_UP).perform()
    eventually("h1 walks", lambda: not near(pose(run, "h1"), before, 0.3))
    eventually("the page tells what stops her", lambda: "h1 ran into " in page.log())
    ActionChains(page.browser).key_up(Keys.ARROW_UP).perform()


def zooms(page):
    page.click("fit")
    page.click("scans")
    def walls():
        return page.colors().get("#24292f", 0)
    page.settle()
    fit = walls()
    for _ in range(3):
        page.click("farther")
    eventually("the room is smaller", lambda: walls() < 0.6 * fit)
    page.click("fit")
    eventually("all of it again", lambda: abs(walls() - fit) < 0.05 * fit)


def drives_by_touch(run):
    with Page(run.url, 400, 800, touch=True) as page:
        page.select("r2")
        before = pose(run, "r2")
        forward = page.browser.find_element("css selector", "#pad button[data-key=ArrowUp]")
        ActionChains(page.browser).click_and_hold(forward).perform()
        eventually("r2 moves", lambda: not near(pose(run, "r2"), before, 0.1))
        ActionChains(page.browser).release(forward).perform()
        eventually("r2 stops", lambda: page.facts()["speed"] == 0)
        page.screenshot("pad_400.png")


def tells_the_end(run, page):
    check(run.stop() == 0, "simrun did not end well")
    eventually("the page says so", lambda: page.text("banner").startswith("The run has ended."))


with Run() as run:
    with Page(run.url) as page:
        drives_by_keys(run, page)
        holds_and_frees(run, page)
        drags_a_goal(run, page)
        drives_people(run, page)
        pauses(run, page)
        page.screenshot("driven_1280.png")
        zooms(page)
        drives_by_touch(run)
        tells_the_end(run, page)
