#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Foxglove Studio 1.48, the open viewer that Lichtblick continues, on a run with --foxglove: it shows the world by
the layout of the examples and drives its robot. npm has it as the package studio-base, which a page of some lines starts."""

import functools
import http.server
import os
import sys
import threading

from running import LAYOUT, Run, check, eventually, pose, skip, start_browser

PATIENCE = 150  # seconds; it takes ten on a free machine
SCAN = (0xD1, 0x49, 0x5B)  # colour of /l1/scan in the layout
SOURCE = os.environ["ISPACE_SOURCE_DIR"]
PACKAGES = os.path.join(os.environ["ISPACE_BINARY_DIR"], "npm", "node_modules")
FILES = {
    "/react.js": os.path.join(PACKAGES, "react/umd/react.production.min.js"),
    "/react-dom.js": os.path.join(PACKAGES, "react-dom/umd/react-dom.production.min.js"),
    "/layout.json": os.path.join(SOURCE, "share/examples/lichtblick.json"),
}
PAGE = """<!doctype html><meta charset="utf-8"><body style="margin:0">
<div id="root" style="height:100vh"></div>
<script>self.global = self</script>
<script src="react.js"></script><script src="react-dom.js"></script>
<script>self["react"] = React; self["react-dom"] = ReactDOM;</script>
<script src="assets/index.js"></script>
<script>
(async () => {
    const data = await (await fetch("layout.json")).json();
    const layouts = new Map([["room", {id: "room", name: "room", permission: "CREATOR_WRITE",
                                       baseline: {data, savedAt: new Date().toISOString()}}]]);
    const layoutStorage = {
        list: async () => [...layouts.values()], get: async (_, id) => layouts.get(id),
        put: async (_, layout) => { layouts.set(layout.id, layout); return layout; },
        delete: async (_, id) => { layouts.delete(id); }, importLayouts: async () => {}};
    const settings = new Map([["telemetry.telemetryEnabled", false],
                              ["telemetry.crashReportingEnabled", false]]);
    const appConfiguration = {
        get: key => settings.get(key), set: async (key, value) => { settings.set(key, value); },
        addChangeListener() {}, removeChangeListener() {}};
    await initI18n();
    ReactDOM.render(React.createElement(App, {
        deepLinks: [location.href], dataSources: [new FoxgloveWebSocketDataSourceFactory()],
        extensionLoaders: [], enableGlobalCss: true, layoutStorage, appConfiguration,
    }), document.getElementById("root"));
})();
</script>
"""
# Pixels of the screen that have nearly this colour.
COUNT = """
const [png, color, done] = arguments, image = new Image();
image.onload = () => {
    const canvas = document.createElement('canvas'), draw = canvas.getContext('2d');
    [canvas.width, canvas.height] = [image.width, image.height];
    draw.drawImage(image, 0, 0);
    const {data} = draw.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
        if (color.every((value, k) => Math.abs(value - data[i + k]) < 16)) ++count;
    done(count);
};
image.src = 'data:image/png;base64,' + png;
"""


class Handler(http.server.SimpleHTTPRequestHandler):
    def translate_path(self, path):
        path = path.split("?")[0]
        return FILES.get(path) or super().translate_path(path)

    def do_GET(self):
        if self.path.split("?")[0] not in ("/", "/favicon.ico"):
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(PAGE.encode())

    def log_message(self, *_):
        pass


def drive(browser, run):
    from selenium.webdriver import ActionChains
    forward = eventually("the buttons of teleoperation",
                         lambda: browser.find_elements("css selector", "svg [role=button]"))[0]
    start = pose(run, "r1")[0]
    ActionChains(browser).click_and_hold(forward).perform()
    eventually("the robot to go", lambda: pose(run, "r1")[0] > start + 0.3, PATIENCE)
    ActionChains(browser).release().perform()


def looks(browser, run):
    def rows():
        """Messages read of each topic, by the list of the side bar."""
        lines = browser.execute_script("return document.body.innerText").split("\n")
        return {line: int(lines[i + 2]) for i, line in enumerate(lines[:-2])
                if line.startswith("/") and lines[i + 2].isdigit()}

    wanted = {"/diagnostics", "/l1/scan", "/map", "/people"}
    eventually(f"messages of {wanted}", lambda: wanted <= rows().keys(), PATIENCE)
    eventually("the scan in its colour", lambda: browser.execute_async_script(
        COUNT, browser.get_screenshot_as_base64(), SCAN) > 50, PATIENCE)
    eventually("the diagnostics", lambda: "robot r1" in browser.execute_script(
        "return document.body.innerText"), PATIENCE)
    drive(browser, run)
    if len(sys.argv) > 1:
        browser.save_screenshot(sys.argv[1])
    # Later versions fetch package://ispace/room.glb from the server.
    errors = [entry["message"] for entry in browser.get_log("browser")
              if entry["level"] == "SEVERE" and "package://" not in entry["message"]]
    check(not errors, f"the viewer complains: {errors}")
    lines = browser.execute_script("return document.body.innerText").split("\n")
    problems = lines[lines.index("Problems") + 1]
    check(problems.startswith("/"), f"{problems} problems")  # no number before the first topic


studio = os.path.join(PACKAGES, "@foxglove/studio-base")
if not os.path.isdir(studio):
    skip("npm could not fetch @foxglove/studio-base")
server = http.server.ThreadingHTTPServer(
    ("127.0.0.1", 0), functools.partial(Handler, directory=studio))
threading.Thread(target=server.serve_forever, daemon=True).start()
one_robot = "".join(line for line in LAYOUT.splitlines(True) if not line.startswith("robot id=r2"))
viewer = start_browser(1400, 900, "--enable-unsafe-swiftshader")
try:
    viewer.set_script_timeout(PATIENCE)
    with Run("--foxglove", "0", layout=one_robot) as simrun:
        viewer.get(f"http://127.0.0.1:{server.server_address[1]}/?ds=foxglove-websocket"
                   f"&ds.url={simrun.announced['foxglove']}&layoutId=room")
        looks(viewer, simrun)
finally:
    viewer.quit()
