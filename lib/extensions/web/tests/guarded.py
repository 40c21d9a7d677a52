#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a run with a token, and of one that comes after another on the same port."""

import os
import socket
import tempfile

from running import Run, ask, check, eventually, skip, start_browser

try:
    from selenium.webdriver import Keys
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")


HOME = """#env 1
ispace size=6,4,2.5
inside at=0,0
lamp id=l1 at=1,0
"""


def wants_its_token(folder):
    path = os.path.join(folder, "token")
    with open(path, "w", encoding="utf-8") as file:
        file.write("a-secret-of-this-test\n")
    with Run("--token-file", path, environment=HOME, layout="#3dm 1\nrobot id=r1 at=0,1\n") as run:
        browser = start_browser(1280, 800)
        part = lambda name: browser.find_element("id", name)
        press = lambda: browser.execute_script(
            "const lamp = document.querySelector('#state-list li button'); lamp?.click(); return Boolean(lamp)")
        says = lambda: part("token-why").text if part("token").is_displayed() else ""
        try:
            # On this machine all may look, and only holders of the token may change the world.
            browser.get(run.url)
            eventually("a first frame", lambda: part("time").text != "–")
            check(says() == "", f"it says {says()}")
            eventually("the lamp", press)
            eventually("a form", lambda: says() == "This run wants its token.")
            part("token-text").send_keys("a-guess", Keys.ENTER)
            eventually("it is wrong", lambda: "not the token of this run" in says())
            part("token-text").clear()
            part("token-text").send_keys("a-secret-of-this-test", Keys.ENTER)
            eventually("no form", lambda: not part("token").is_displayed())
            check(browser.current_url.endswith("#token=a-secret-of-this-test"), browser.current_url)
            # From then on the address is enough.
            browser.refresh()
            eventually("the lamp", press)
            eventually("it is on", lambda: "l1.on=1" in ask(run, "WORLD", "STATE")[1])
        finally:
            browser.quit()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def shows_the_next_run():
    """As in the daily loop of changing a room and running it again."""
    port = free_port()
    with Run(web=f"127.0.0.1:{port}") as first:
        browser = start_browser(1280, 800)
        browser.get(first.url)
        eventually("the first run", lambda: browser.title == "office.env")
        check(first.stop() == 0, "simrun did not end well")
        banner = browser.find_element("id", "banner")
        eventually("its end", lambda: banner.text.startswith("The run has ended."))
    try:
        with Run(web=f"127.0.0.1:{port}", layout="#3dm 1\nrobot id=another at=2,2\n") as second:
            check(second.url == first.url, f"the port is another: {second.url}")
            eventually("the second run", lambda: "another" in browser.execute_script(
                "return document.getElementById('movers')?.textContent ?? ''"))
    finally:
        browser.quit()


with tempfile.TemporaryDirectory() as scratch:
    wants_its_token(scratch)
shows_the_next_run()
