#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tools of the map: a robot is sent to a point and a heading, and its way shows; lengths and areas are measured; kinds
of sensors have colours."""

from page import Page
from running import Run, ask, check, eventually, pose, skip

try:
    from selenium.webdriver import ActionChains
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

GOAL, REFUSED = "#0072b2", "#b3261e"


def pixel(page, x, y):
    """Where a point of the room is on the map, from its middle, as pointers count."""
    return page.browser.execute_script("""
        const map = document.getElementById('map'), place = document.getElementById('place');
        const at = (px, py) => {
          const box = map.getBoundingClientRect();
          map.dispatchEvent(new PointerEvent('pointermove', {clientX: box.left + px, clientY: box.top + py}));
          return place.textContent.split(' · ')[0].split(', ').map(Number);
        };
        const [x0, y0] = at(0, 0), [x1, y1] = at(1000, 1000);
        return [1000 * (arguments[0] - x0) / (x1 - x0) - map.clientWidth / 2,
                1000 * (arguments[1] - y0) / (y1 - y0) - map.clientHeight / 2].map(Math.round);""", x, y)


def press(page, *points):
    """Presses at the first point of the room, and lets go at the last."""
    pixels = [pixel(page, *point) for point in points]
    actions = ActionChains(page.browser, duration=50).move_to_element_with_offset(page.part("map"), *pixels[0])
    actions.click_and_hold()
    for (x0, y0), (x1, y1) in zip(pixels, pixels[1:]):
        actions.move_by_offset(x1 - x0, y1 - y0)
    actions.release().perform()


def sends(run, page):
    check(not page.part("send").is_enabled(), "no robot is selected, and one can be sent")
    page.select("r1")
    page.click("send")
    check(page.part("send").get_attribute("aria-pressed") == "true", "the button is not pressed")
    page.settle()
    before = page.colors().get(GOAL, 0)
    press(page, (2.6, 3), (2.6, 4))
    eventually("the way", lambda: page.colors().get(GOAL, 0) > before + 40)
    eventually("r1 has arrived", lambda: "r1 has arrived" in page.log())
    x, y = pose(run, "r1")
    check(abs(x - 2.6) < 0.05 and abs(y - 3) < 0.05, f"r1 is at {x, y}")
    eventually("it faces where the drag went", lambda: abs(page.facts()["heading"] - 90) < 1)
    # Behind a wall its way has corners.
    press(page, (8, 1))
    page.screenshot("way_1280.png")
    eventually("r1 is behind the wall", lambda: page.log().count("r1 has arrived") == 2)
    check(page.text("name") == "r1", "the press has ended the selection")


def is_refused(page):
    press(page, (8, 5))  # on the table
    eventually("a reason on the map", lambda: "no room at" in page.text("notice"))
    eventually("in the log, too", lambda: "no room at" in page.log())
    check(page.colors().get(REFUSED, 0) > 20, "no cross at the goal")
    page.screenshot("refused_1280.png")
    page.click("send")
    check(page.part("send").get_attribute("aria-pressed") == "false", "the tool is still used")


def measures(page):
    page.click("measure")
    press(page, (1, 1))
    press(page, (4, 1))
    eventually("a length", lambda: page.text("said")[:3] in ("3.0", "2.9"))
    press(page, (4, 3))
    eventually("an area", lambda: "m²" in page.text("said"))
    length, area = float(page.text("said").split(" m")[0]), float(page.text("said").split(", ")[-1].split()[0])
    check(abs(length - 5) < 0.05 and abs(area - 3) < 0.05, f"it is said to be {page.text('said')}")
    page.screenshot("measured_1280.png")
    page.part("map").send_keys("m")
    check(not page.part("said").is_displayed(), "the ruler is still in use")


def colors_kinds(page):
    page.click("fit")
    page.browser.execute_script("""
        const [, color, opacity] = document.querySelectorAll('#kinds li[data-kind=laser] input');
        opacity.value = 1;
        opacity.dispatchEvent(new Event('input'));
        color.value = '#00ff00';
        color.dispatchEvent(new Event('input'));""")
    def greens():
        return page.browser.execute_script("""
            const map = document.getElementById('map');
            const {data} = map.getContext('2d').getImageData(0, 0, map.width, map.height);
            let n = 0;
            for (let i = 0; i < data.length; i += 4) n += data[i + 1] > data[i] + 15 && data[i + 1] > data[i + 2] + 15;
            return n;""")
    eventually("green lasers", lambda: greens() > 1000)
    page.part("kinds").find_element("css selector", "li[data-kind=laser] input").click()
    eventually("no lasers", lambda: greens() < 100)
    page.browser.refresh()
    eventually("the page again", lambda: page.text("time") != "–")
    page.settle()
    eventually("none still", lambda: greens() < 100)


def folds(page):
    """A section stays as it was left, also if the page is left right after the click."""
    def is_open():
        return page.browser.execute_script("return document.querySelector('[aria-labelledby=log-name] details').open")
    for _ in range(10):
        was_open = is_open()
        page.browser.find_element("css selector", "section[aria-labelledby=log-name] summary").click()
        eventually("a change", lambda: is_open() != was_open)
        page.browser.refresh()
        eventually("the page again", lambda: page.text("time") != "–")
        check(is_open() != was_open, "the log is folded as it was before the click")


def main():
    with Run("--clock", "real:3") as run, Page(run.url) as page:
        sends(run, page)
        is_refused(page)
        measures(page)
        colors_kinds(page)
        folds(page)


if __name__ == "__main__":
    main()
