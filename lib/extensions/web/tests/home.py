#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a room that answers: the states of all kinds of sensors and actuators; buttons and fields set them."""

from page import Page
from running import Run, ask, check, eventually, skip

try:
    from selenium.webdriver import Keys
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

HOME = """#env 1
ispace size=6,4,2.5 ceiling=yes
inside at=0,0
zone id=west at=-1.5,0 size=3,4 celsius=19
zone id=east at=1.5,0 size=3,4 celsius=19
door id=front at=3,0
window id=south at=0,-2 size=1.2,0.1,1.2
lamp id=l1 at=1,0
projector id=p1 at=0,0 height=1.5
switch id=b1 at=2.9,1
speaker id=s1 at=1,1
heater id=h1 at=-2,1
weather id=w1 celsius=5
cube id=key at=0.5,0.5 size=0.1 tag=key
"""
LAYOUT = """#3dm 1
human id=ann at=-2,-1 tag=ann
robot id=r1 at=2,-1
pir id=motion at=-2.9,1.9,2.2 heading=-40 tilt=-25
contact id=k1 at=3,0,2 door=front
rfid id=reader at=0.5,0,0.1 heading=90
uwb id=u1 at=-2.9,-1.9,2.2
microphone id=mic at=0,0,1
lux id=light at=0,0,0.8 tilt=90
thermometer id=warm at=0,1,1.5
imu id=i1 on=r1
mote id=m1 at=1,1,1
mote id=m2 at=-1,1,1
"""


def shown(page):
    """The states on the page: {"l1 on": "false", "l1 level": "1", ...}"""
    return page.browser.execute_script("""
        return Object.fromEntries([...document.querySelectorAll('#state-list li > :first-child')].map(part => {
          const field = part.querySelector('input'), text = part.querySelector('.model');
          const name = part.firstChild.textContent.trim();
          return [name, field ? field.value : text.textContent || part.getAttribute('aria-pressed')];
        }));""")


def press(page, name):
    page.press("state-list", name)


def enter(page, name, value):
    def is_entered():
        for label in page.part("state-list").find_elements("tag name", "label"):
            if label.text.strip() == name:
                field = label.find_element("tag name", "input")
                field.click()  # selects its text
                field.send_keys(value, Keys.ENTER)
                return True
        return False

    eventually(f"a field {name}", is_entered)


def state(run, name):
    words = dict(word.split("=", 1) for word in ask(run, "WORLD", "STATE")[1].split() if "=" in word)
    return words[name.replace(" ", ".")]


with Run(environment=HOME, layout=LAYOUT) as run, Page(run.url, 1280, 1400) as page:
    eventually("the states", lambda: "warm celsius" in shown(page))
    first = shown(page)
    for name, value in {
        "front open": "false", "south blind": "false", "l1 on": "false", "l1 level": "1", "p1 pan": "0", "p1 on": "false",
        "b1 on": "false", "s1 volume": "70", "h1 on": "false", "w1 celsius": "5", "motion motion": "false",
        "k1 open": "false", "reader tags": "key", "light lux": "0", "warm celsius": "19", "m1 neighbours": "m2"}.items():
        check(first.get(name) == value, f"{name} is {first.get(name)}, not {value}: {first}")
    check({"u1 tags", "mic level", "m1 lux"} <= set(first), f"no anchors, microphones or motes: {first}")
    rooms = page.browser.execute_script("""
        return Object.fromEntries([...document.querySelectorAll('#state-list h3')].map(title => [title.textContent,
          [...title.nextSibling.querySelectorAll('li')].map(item => item.dataset.name.split(' ')[0])]));""")
    check({"l1", "s1"} <= set(rooms["east"]) and {"h1", "motion"} <= set(rooms["west"]), f"the rooms have {rooms}")
    check(set(rooms) == {"east", "west", "elsewhere"} and "w1" in rooms["elsewhere"], f"the rooms are {rooms}")
    page.screenshot("home_before.png")

    for name in ("l1 on", "p1 on", "front open", "south blind", "b1 on", "s1 on", "h1 on"):
        press(page, name)
        eventually(name, lambda name=name: shown(page)[name] == "true" and state(run, name) == "1")
    eventually("the contact follows", lambda: shown(page)["k1 open"] == "true")
    eventually("the light meter follows", lambda: float(shown(page)["light lux"]) > 50)
    eventually("the microphone hears", lambda: float(shown(page)["mic level"]) > 60)
    enter(page, "p1 pan", "30")
    eventually("the projector turns", lambda: state(run, "p1 pan") == "30")
    enter(page, "l1 level", "50%")
    eventually("the lamp dims", lambda: shown(page)["l1 level"] == "0.5")
    enter(page, "l1 level", "50%")
    eventually("the same level as the world has it", lambda: shown(page)["l1 level"] == "0.5")
    enter(page, "p1 tilt", "up")
    eventually("a complaint", lambda: "tilt" in page.log())
    check(state(run, "p1 tilt") == "0", "the projector tilts")
    ask(run, "WORLD", "ACT w1 celsius=-5")
    eventually("the weather of another client", lambda: shown(page)["w1 celsius"] == "-5")
    check("l1: on 1" in page.log() and "undefined" not in page.log(), f"the log is {page.log()}")
    press(page, "l1 on")
    eventually("the lamp goes off", lambda: state(run, "l1 on") == "0")
    page.screenshot("home.png")
