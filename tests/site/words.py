# SPDX-License-Identifier: GPL-3.0-or-later
"""Words that rows of options share: commands that write inputs, sensors, and reasons for which an option is exempt."""


class Exempt:
    """An option that this test cannot run, and why."""

    def __init__(self, why):
        self.why = why


OTHER_INPUT = Exempt("is about inputs that are no buildings")
PLAN = Exempt("is about plans and pictures, which are no buildings")
MESH = Exempt("is about meshes and clouds, which are no buildings")
TIMES = Exempt("says how fast or how far the work is")
PEER = Exempt("needs a peer; its own tests run it on rooms and buildings")

COARSE = "--cell 0.4 --candidates 1,1,4"
SENSOR = "--sensor dome-2.8-1080p:2"
LASERS = "--sensor laser,range=4:2"
OUT = "-o out.3dm"

RUN = "room.env lay.3dm --clock fast --until 1 --listen 127.0.0.1:0"
RECORD = f"simrun {RUN} --no-record-readings --record rec"
LOG = "scan room.env lay.3dm --select l1 --noise --frames 8 -o log.jsonl"
