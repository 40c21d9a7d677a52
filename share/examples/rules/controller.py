#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls lamps and the heater of a flat: software under test, with a fault.

    controller.py 127.0.0.1:7001 [--mended]

A lamp is on while a motion sensor of its room detects people, and ten seconds longer. The heater is on while the kitchen
is in use. Its author forgot the window, at which a contact (k1) tells that it is open: --mended heeds it. Needs the
module ispace, and simrun with --clock step.
"""

import argparse
import sys

import ispace

LAMPS = {"s1": "kitchen-lamp", "s2": "room-lamp"}  # by motion sensor
STAYS = 10.0  # seconds without motion until a lamp goes off
CYCLE = 0.5  # seconds


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", help="of simrun, HOST:PORT")
    parser.add_argument("--mended", action="store_true", help="no heat while the window is open")
    options = parser.parse_args()
    host, port = options.address.rsplit(":", 1)
    with ispace.World((host, int(port))) as world:
        last = {sensor: -STAYS for sensor in LAMPS}  # motion
        on = {thing: False for thing in [*LAMPS.values(), "h1"]}

        def switch(thing: str, value: bool) -> None:
            if on[thing] != value:
                world.act(thing, "on", value)
                on[thing] = value

        while world.time() < 120:
            states = world.states()
            now = world.time()
            for sensor, lamp in LAMPS.items():
                if states[f"{sensor}.motion"] == "1":
                    last[sensor] = now
                switch(lamp, now - last[sensor] < STAYS)
            is_open = states["k1.open"] == "1"
            switch("h1", on["kitchen-lamp"] and not (options.mended and is_open))
            world.advance(CYCLE)
        world.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
