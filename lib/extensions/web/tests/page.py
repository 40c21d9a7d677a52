# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of simrun --web as people use it: read off the screen, clicked and typed at."""

import os

from running import check, eventually, start_browser


class Page:
    def __init__(self, url, width=1280, height=800, touch=False, options=()):
        self.browser = start_browser(width, height, *options, touch=touch)
        self.browser.get(url)
        eventually("a first frame", lambda: self.text("time") != "–")

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            errors = [entry for entry in self.browser.get_log("browser")
                      if entry["level"] == "SEVERE"]
            check(not errors, f"the browser complains: {errors}")
        self.browser.quit()

    def part(self, name):
        return self.browser.find_element("id", name)

    def text(self, name):
        return self.part(name).text

    def time(self):
        return float(self.text("time").split()[0])

    def log(self):
        return self.text("log")

    def click(self, name):
        """Once it is on the screen: the page learns later than the world what has changed."""
        eventually(f"{name} on the screen", lambda: self.part(name).is_displayed())
        self.part(name).click()

    def press(self, part, name, name_of=lambda button: button.text.strip()):
        """The button of a list that has the name, once it is there."""
        def is_pressed():
            for button in self.part(part).find_elements("tag name", "button"):
                if name_of(button) == name:
                    button.click()
                    return True
            return False

        eventually(f"a button {name} in {part}", is_pressed)

    def select(self, mover):
        """By its button in the list."""
        self.press("movers", mover, lambda button: (button.text.split() or [""])[0])

    def chosen(self, name):
        """The text of a chooser's option, asked for at once, as it may change between two questions."""
        return self.browser.execute_script(
            "return document.getElementById(arguments[0]).selectedOptions[0]?.textContent", name)

    def facts(self):
        """The page's data of the selected mover: {"x": 2.0, …}; {} if it is in another room"""
        rows = self.browser.execute_script(
            "return [...document.querySelectorAll('#facts > *')].map(e => e.textContent)")
        return {name: float(value.split()[0].rstrip("°/s"))
                for name, value in zip(rows[::2], rows[1::2]) if name != "in" and value != "none"}

    def colors(self):
        """How many pixels of the map have which colour, "#rrggbb"."""
        return self.browser.execute_script("""
            const map = document.getElementById('map'), counts = {};
            const {data} = map.getContext('2d').getImageData(0, 0, map.width, map.height);
            for (let i = 0; i < data.length; i += 4) {
              const color = (data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
              counts[color] = (counts[color] ?? 0) + 1;
            }
            return Object.fromEntries(Object.entries(counts).filter(([, count]) => count > 3).map(
                ([color, count]) => ['#' + (+color).toString(16).padStart(6, '0'), count]));""")

    def centers(self, color):
        """The middle of the pixels of a colour, in pixels of the map; None without any."""
        return self.browser.execute_script("""
            const wanted = parseInt(arguments[0].slice(1), 16);
            const map = document.getElementById('map');
            const {data} = map.getContext('2d').getImageData(0, 0, map.width, map.height);
            let n = 0, x = 0, y = 0;
            for (let i = 0; i < data.length; i += 4) {
              if ((data[i] << 16 | data[i + 1] << 8 | data[i + 2]) !== wanted) continue;
              n += 1;
              x += i / 4 % map.width;
              y += Math.floor(i / 4 / map.width);
            }
            return n ? [x / n, y / n] : null;""", color)

    def map_size(self):
        return self.browser.execute_script(
            "const map = document.getElementById('map'); return [map.clientWidth, map.clientHeight]")

    def settle(self):
        """Waits until the last change is drawn."""
        self.browser.execute_script("return new Promise(done => requestAnimationFrame(() => "
                                    "requestAnimationFrame(() => requestAnimationFrame(done))))")

    def screenshot(self, name):
        """Beside the other results of tests, to be looked at."""
        folder = os.path.join(os.environ.get("ISPACE_BINARY_DIR", "."), "tests", "web")
        os.makedirs(folder, exist_ok=True)
        self.browser.save_screenshot(os.path.join(folder, name))
