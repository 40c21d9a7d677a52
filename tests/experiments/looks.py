#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""looks.py BUILD: the report in a browser, at the width of a desk and of a phone: every picture is there, and no
element is wider than the page."""

import os
import sys

from running import check, eventually, start_browser

SCRATCH = os.path.join(sys.argv[1], "tests", "scratch", "experiments")
INDEX = os.path.join(SCRATCH, "first", "index.html")

PICTURES = """return [...document.images].map(image =>
    [image.alt, image.complete, image.naturalWidth, image.naturalHeight, image.clientWidth])"""
WIDTH = "return document.documentElement.scrollWidth"
TALL = "return document.documentElement.scrollHeight"
BROKEN = """return [...document.querySelectorAll('a[href^="#"]')]
    .filter(link => !document.querySelector(link.getAttribute('href'))).map(link => link.href)"""
# Text that exceeds its box, unless the box scrolls.
CUT = """return [...document.querySelectorAll('p, h1, h2, h3, td, th, li, figcaption')]
    .filter(one => one.scrollWidth > one.clientWidth + 1).map(one => one.textContent.slice(0, 60))"""


def looks(width):
    browser = start_browser(width, 900, touch=width < 500)
    from selenium.common.exceptions import TimeoutException  # start_browser() has found it
    try:
        browser.get("file://" + INDEX)
        eventually("pictures", lambda: all(row[1] for row in browser.execute_script(PICTURES)))
        pictures = browser.execute_script(PICTURES)
        check(len(pictures) > 20, f"only {len(pictures)} pictures")
        for name, _, wide, high, shown in pictures:
            check(wide >= 200 and high >= 100, f"{name}: {wide} x {high} pixels")
            check(shown >= min(wide, 280), f"{name}: {shown} pixels wide on a page of {width}")
        check(browser.execute_script(WIDTH) <= width, f"the page is wider than {width}")
        check(not browser.execute_script(BROKEN), "links into nowhere")
        cut = browser.execute_script(CUT)
        check(not cut, f"too wide: {cut}")
        # Enlarged, a picture is scrolled in its frame, not with the page.
        browser.find_element("css selector", "figure img").click()
        check(browser.execute_script(WIDTH) <= width, "an enlarged picture widens the page")
        errors = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
        check(not errors, f"the browser complains: {errors}")
        tall = min(browser.execute_script(TALL), 16000)
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": tall, "deviceScaleFactor": 1, "mobile": width < 500})
        # For people to look at: no check needs it, and on a busy machine the browser gives up after 10 s.
        try:
            browser.save_screenshot(os.path.join(SCRATCH, f"looks_{width}.png"))
        except TimeoutException:
            print(f"no picture of the page at a width of {width}: the machine is too busy")
    finally:
        browser.quit()


looks(1280)
looks(400)
