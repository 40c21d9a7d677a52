#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""axe-core finds no fault on the page, at the widths of a desk, a tablet and a phone, by light and dark; and the page
stays small. npm has axe as the package axe-core."""

import os
import urllib.request

from page import Page
from running import ENVIRONMENT, LAYOUT, Run, check, eventually, skip

AXE = os.path.join(os.environ["ISPACE_BINARY_DIR"], "npm", "node_modules", "axe-core", "axe.min.js")
LARGEST = 300_000  # bytes of all files of the page
SCENE = """zone id=hall at=2,2 size=3,3
lamp id=l9 at=7,2
heater id=h9 at=3,1
"""
PLACED = "camera id=c1 at=9,6,2.2 heading=225 tilt=-20\npir id=p1 at=0.2,0.2,2 heading=45\n"


def faults(page, axe):
    page.browser.execute_script(axe)
    results = page.browser.execute_async_script("""
        const done = arguments[arguments.length - 1];
        axe.run(document).then(({violations}) => done(violations.map(({id, nodes}) =>
          `${id}: ${nodes.map(({target, failureSummary}) => `${target} (${failureSummary})`).join('; ')}`)));""")
    return results


def light(page, scheme):
    page.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                 {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    page.settle()


def brightness(page):
    """The mean of the map as people see it, from 0 to 255."""
    return page.browser.execute_async_script("""
        const [png, done] = arguments, bytes = Uint8Array.from(atob(png), c => c.charCodeAt(0));
        createImageBitmap(new Blob([bytes], {type: 'image/png'})).then(image => {
            const canvas = document.createElement('canvas'), draw = canvas.getContext('2d');
            const box = document.getElementById('map').getBoundingClientRect();
            [canvas.width, canvas.height] = [box.width, box.height];
            draw.drawImage(image, -box.left, -box.top);
            const {data} = draw.getImageData(0, 0, canvas.width, canvas.height);
            done(data.reduce((sum, part, i) => sum + (i % 4 < 3 ? part : 0), 0) / (0.75 * data.length));
        });""", page.browser.get_screenshot_as_base64())


def uses(page):
    """All parts at once: one selected, a plot, a picture, an edit, a complaint."""
    page.select("r1")
    eventually("states", lambda: page.part("state-list").find_elements("tag name", "button"))
    page.browser.execute_script("""
        document.querySelector('#state-list .course').click();
        document.querySelector('#lenses button').click();
        document.getElementById('edit-value').value = 'x';
        document.getElementById('edit-kind').value = 'robto';
        document.getElementById('edit-keys').value = 'at=1,1';
        document.querySelector('#edit-add button').click();""")
    eventually("a complaint", lambda: "robto" in page.log())


def is_small(url):
    total, wanted, seen = 0, ["/"], set()
    while wanted:
        path = wanted.pop()
        seen.add(path)
        with urllib.request.urlopen(url.rstrip("/") + path) as answer:
            text = answer.read()
        total += len(text)
        for quote in ("'", '"'):
            for word in text.decode().split(quote)[1::2]:
                name = "/" + word.lstrip("./")
                if word.endswith((".js", ".css", ".svg")) and name not in seen and name not in wanted:
                    wanted.append(name)
    check(len(seen) > 10, f"the page has only {seen}")
    check(total < LARGEST, f"the page has {total} bytes")
    print(f"{total} bytes in {len(seen)} files")


def main():
    with Run("--web-edit", environment=ENVIRONMENT + SCENE, layout=LAYOUT + PLACED) as run:
        is_small(run.url)
        if not os.path.exists(AXE):
            skip("npm could not fetch axe-core")
        with open(AXE, encoding="utf-8") as file:
            axe = file.read()
        for width, height in ((1400, 900), (768, 1024), (400, 800)):
            with Page(run.url, width, height, touch=width < 500) as page:
                eventually("something to edit", lambda page=page: page.part("editing").is_displayed())
                uses(page)
                for scheme in ("light", "dark"):
                    light(page, scheme)
                    page.screenshot(f"axe_{width}_{scheme}.png")
                    mean = brightness(page)
                    check((mean > 160) == (scheme == "light") and (mean < 100) == (scheme == "dark"),
                          f"at {width} pixels, {scheme}: the map has a brightness of {mean:.0f}")
                    found = faults(page, axe)
                    check(not found, f"at {width} pixels, {scheme}: {found}")
                scroll = page.browser.execute_script("return document.documentElement.scrollWidth")
                check(scroll <= width, f"the page is {scroll} pixels wide on a screen of {width}")
                if width == 400:
                    rows = page.browser.execute_script("return document.querySelector('header').getBoundingClientRect().height")
                    check(rows < 60, f"the header of a phone is {rows} pixels high")


main()
