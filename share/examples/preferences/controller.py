#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Serves two people who differ with light and warmth: software under test.

    controller.py 127.0.0.1:7001 [--same-for-all]

Readers of tags tell which people are in a room, and the key `prefers` of their records the light and the temperature that
they like. One alone gets what it likes; several get the geometric mean of light, as eyes judge by ratios, and the mean of
temperatures. With --same-for-all every room in use has 300 lux and 21 degrees. Needs the module ispace, and simrun with
--clock step.
"""

import argparse
import math
import re
import sys
from typing import Dict, Tuple

import ispace

ROOMS = ("study", "living")
CYCLE = 5.0  # seconds
END = 4500.0
BAND = 0.2  # kelvin about the wanted temperature, in which the heater stays as it is
EMPTY = (0.0, 16.0)  # lux and degrees of an empty room


def preferences(world: ispace.World) -> Dict[str, Tuple[float, float]]:
    """Light and temperature by the tags of people."""
    liked = {}
    for record in world.records():
        if not record.startswith("human "):
            continue
        tag = re.search(r'\btag="?([^" ]+)', record)
        wanted = dict(part.split(":") for part in re.search(r'\bprefers="?([^" ]+)', record)[1].split(";"))
        liked[tag[1]] = (float(wanted["light"]), float(wanted["temp"]))
    return liked


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", help="of simrun, HOST:PORT")
    parser.add_argument("--same-for-all", action="store_true", help="300 lux and 21 degrees, for whom it may be")
    options = parser.parse_args()
    host, port = options.address.rsplit(":", 1)
    with ispace.World((host, int(port))) as world:
        liked = preferences(world)
        level = {room: 0.2 for room in ROOMS}
        while world.time() < END:
            states = world.states()
            for room in ROOMS:
                tags = states[f"{room}-reader.tags"]
                people = [liked[tag] for tag in tags.split(",") if tag in liked]
                if people and options.same_for_all:
                    people = [(300.0, 21.0)]
                lux, celsius = EMPTY
                if people:
                    lux = math.exp(sum(math.log(light) for light, _ in people) / len(people))
                    celsius = sum(warmth for _, warmth in people) / len(people)
                lamp, heater = f"{room}-lamp", f"{room}-heater"
                is_lit = states[f"{lamp}.on"] == "1"
                if is_lit != (lux > 0):
                    world.act(lamp, "on", lux > 0)
                measured = float(states[f"{room}-lux.lux"])
                if is_lit and lux > 0 and measured > 0 and abs(measured / lux - 1) > 0.1:
                    level[room] = round(min(1.0, max(0.01, level[room] * lux / measured)), 3)
                    world.act(lamp, "level", level[room])
                warmth = float(states[f"{room}-celsius.celsius"])
                heats = states[f"{heater}.on"] == "1"
                if abs(warmth - celsius) > BAND and heats != (warmth < celsius):
                    world.act(heater, "on", warmth < celsius)
            world.advance(CYCLE)
        world.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
