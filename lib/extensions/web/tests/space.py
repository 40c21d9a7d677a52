#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The room in three dimensions: it is drawn with its movers, turns, follows, and changes with the room."""

from page import Page
from running import Run, ask, check, eventually, skip

try:
    from selenium.webdriver import ActionChains
except ImportError:
    skip("no selenium here (Debian: python3-selenium)")

WEBGL = ("--enable-unsafe-swiftshader", "--use-angle=swiftshader")
# How many pixels of the picture are ground, dark red (a robot), the blue of what is selected, and how many colours it has.
COUNT = """
const [png, done] = arguments, bytes = Uint8Array.from(atob(png), c => c.charCodeAt(0));
createImageBitmap(new Blob([bytes], {type: 'image/png'})).then(image => {
    const canvas = document.createElement('canvas'), draw = canvas.getContext('2d');
    const box = document.getElementById('space').getBoundingClientRect();
    [canvas.width, canvas.height] = [box.width, box.height];
    draw.drawImage(image, -box.left, -box.top);
    const {data} = draw.getImageData(0, 100, canvas.width, canvas.height - 100);
    const count = {ground: 0, red: 0, blue: 0, colors: new Set()};
    for (let i = 0; i < data.length; i += 4) {
        const [r, g, b] = data.subarray(i, i + 3);
        if (r === 236 && g === 232 && b === 223) ++count.ground;
        if (r > 3 * g && r > 3 * b && r > 60) ++count.red;
        if (b > 1.4 * g && r < 20 && b > 60) ++count.blue;
        count.colors.add(r << 16 | g << 8 | b);
    }
    count.colors = count.colors.size;
    done(count);
});
"""


def looks(page):
    page.settle()
    return page.browser.execute_async_script(COUNT, page.browser.get_screenshot_as_base64())


with Run() as run, Page(run.url, options=WEBGL) as page:
    page.click("solid")
    eventually("the picture", lambda: looks(page)["colors"] > 8)
    check("WebGL" not in page.log(), "the browser has no WebGL")
    first = eventually("robots", lambda: looks(page)["red"] > 100 and looks(page))
    check(first["ground"] > 1000, f"the room fills the picture: {first}")
    page.screenshot("space_1280.png")
    page.select("r1")
    eventually("the selected one is blue", lambda: looks(page)["blue"] > 50)
    ActionChains(page.browser).move_to_element(page.part("space")).click_and_hold().move_by_offset(150, 60).release().perform()
    turned = looks(page)
    check(abs(turned["ground"] - first["ground"]) > 300, f"it does not turn: {first}, {turned}")
    page.click("follow")
    page.click("closer")
    page.click("closer")
    page.click("closer")
    eventually("the robot is near", lambda: looks(page)["blue"] > 2 * turned["blue"])
    page.screenshot("space_near_1280.png")
    page.click("follow")
    page.click("fit")
    before = looks(page)
    ask(run, "WORLD", "ADD pillar id=tower at=3,1 size=0.8")
    eventually("a pillar", lambda: "ADD" in page.log())
    eventually("it is there", lambda: looks(page)["ground"] != before["ground"] or looks(page)["colors"] != before["colors"])
    page.screenshot("space_changed_1280.png")
    # The tools are about the plan.
    page.click("measure")
    check(not page.part("space").is_displayed() and page.part("solid").get_attribute("aria-pressed") == "false", "still 3D")
