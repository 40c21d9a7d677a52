#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page shows a record as it shows a run, without driving."""

import os
import subprocess
import tempfile

from page import Page
from running import LAYOUT, ENVIRONMENT, Run, check, eventually, skip

try:
    from selenium.webdriver import ActionChains, Keys
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")


def record(folder):
    for name, text in (("office.env", ENVIRONMENT), ("office.3dm", LAYOUT),
                       ("drive.txt", "0 r1 FORWARD 1.5\n0 r2 SPEED 1\n")):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    subprocess.run(["simrun", "office.env", "office.3dm", "-q", "--clock", "fast", "--until", "6",
                    "--script", "drive.txt", "--record", "walk"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    return os.path.join(folder, "walk")


def end_of_r1(folder):
    with open(os.path.join(folder, "robots.csv"), encoding="utf-8") as file:
        rows = [line.split(",") for line in file]
    return [float(row[2]) for row in rows if row[1] == "r1"][-1]


with tempfile.TemporaryDirectory() as scratch:
    folder = record(scratch)
    with Run("--replay", folder, "--hold", "--clock", "real") as run, \
            Page(run.url) as page:
        check(page.browser.title == "walk", f"the title is {page.browser.title}")
        page.select("r1")
        eventually("r1 moves", lambda: page.facts()["x"] > 2.2)
        check("record" in page.text("pace"), "the page does not say that it is a record")
        ActionChains(page.browser).key_down(Keys.ARROW_LEFT).pause(0.3).key_up(
            Keys.ARROW_LEFT).perform()
        eventually("the end", lambda: page.text("pace") == "record, at its end")
        facts = page.facts()
        check(abs(facts["x"] - end_of_r1(folder)) < 0.002 and facts["heading"] == 0,
              f"r1 is not where the record has it: {facts}")
        check(not page.part("run").is_enabled(), "the record can go on")
        page.screenshot("replay_1280.png")

        # Back to the beginning and on by keys of the slider; r1 is where it was then.
        slider = page.part("seek")
        check(slider.is_displayed(), "there is no slider")
        slider.send_keys(Keys.HOME)
        eventually("the beginning", lambda: page.text("time") == "0.000 s" and page.facts()["x"] == 2)
        for _ in range(20):
            slider.send_keys(Keys.ARROW_RIGHT)
        eventually("0.2 s later", lambda: page.text("time") == "0.200 s")
        slider.send_keys(Keys.END)
        # Marks: r2 ran into a wall.
        with open(os.path.join(folder, "events.csv"), encoding="utf-8") as file:
            met = [float(line.split(",")[0]) for line in file if ",collision,r2," in line]
        slider.send_keys(Keys.HOME)
        check(page.part("marks").is_displayed(), "there are no marks")
        page.part("map").send_keys("n")
        eventually("the mark", lambda: page.text("time") == f"{met[0]:.3f} s")
        check("r2 ran into" in page.log(), f"the log is {page.log()}")
        page.part("map").send_keys("p")
        slider.send_keys(Keys.HOME)
        eventually("the beginning", lambda: page.text("time") == "0.000 s")
        strip = page.part("marks")
        end = float(slider.get_attribute("max"))
        x = 8 + met[0] / end * (strip.size["width"] - 16) - strip.size["width"] / 2
        ActionChains(page.browser).move_to_element_with_offset(strip, round(x), 0).click().perform()
        eventually("the mark, by a press", lambda: page.text("time") == f"{met[0]:.3f} s")
        page.screenshot("marks_1280.png")

        slider.send_keys(Keys.END)
        eventually("the end again", lambda: abs(page.facts()["x"] - end_of_r1(folder)) < 0.002)

        with Page(run.url, 400, 800) as phone:
            slider = phone.part("seek")
            eventually("the slider", slider.is_displayed)
            wide = phone.browser.execute_script("return document.documentElement.scrollWidth")
            check(wide <= 400, f"the page is {wide} pixels wide")
            slider.send_keys(Keys.HOME)
            eventually("the beginning", lambda: phone.text("time") == "0.000 s")
            eventually("the other page", lambda: page.text("time") == "0.000 s")
            phone.screenshot("replay_400.png")
