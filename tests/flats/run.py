# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a flat, with programs that read its floors and meters, turn heads and send messages; a record, and what they read."""

import math
import os

import ispace

from flat import SECONDS, STEP

EVERY = 3.0  # seconds between the readings of programs


class Heard:
    """What programs have read: lists of (time, ...)."""

    def __init__(self):
        self.before, self.after = {}, {}  # states at the start and at the end
        self.floors, self.meters, self.turns, self.sent = [], [], [], []


def run(flat, folder):
    """Runs it in a folder, and returns what programs have read."""
    flat.write(folder)
    heard = Heard()
    files = [os.path.join(folder, name) for name in ("flat.env", "flat.3dm")]
    options = {"script": os.path.join(folder, "day.txt"), "record": os.path.join(folder, "run"), "quiet": True}
    with ispace.simrun(*files, clock="step", dt=STEP, seed=flat.seed, **options) as server, server.world() as world:
        floor = server.floor() if flat.floors or flat.seats else None
        meter = server.meter()
        heads = server.heads() if flat.robots else None
        radios = server.radios() if flat.robots else None
        heard.before = world.states()
        for turn in range(round(SECONDS / EVERY)):
            if heads and turn % 10 == 7:
                pan = flat.random.random() * 300 - 150
                heard.turns.append((world.time(), pan, heads.turn("neck", pan, 0)))
            if radios and turn % 2:
                name = "base" if turn % 4 == 1 else "rover"
                other = "rover" if name == "base" else "base"
                before = radios.heard(other)
                radios.send(name, f"turn {turn}")
                world.advance(STEP)
                heard.sent.append((world.time(), name, radios.heard(other) - before))
                world.advance(EVERY - STEP)
            else:
                world.advance(EVERY)
            if floor:
                heard.floors += [floor.read(name) for name in flat.floors]
        heard.meters = [meter.read(plug) for plug in flat.plugs]
        heard.after = world.states()
        for client in (floor, meter, heads, radios):
            if client:
                client.close()
        world.shutdown()
        server.wait(30)
    return heard
