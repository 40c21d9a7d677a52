# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import PEER

FILES = {
    "robot.3dm": "#3dm 1\nrobot id=r1 model=pioneer-2dx at=-0.5,0.9\nlaser id=l model=urg-04lx on=r1 at=0.1,0,0.2\n",
    "task.yaml": "step: 0.1\n",
}
OPTIONS = {
    "simrun": {
        "--vector": "!room.env robot.3dm --vector 2 --shm ispace-one-room-{own}",
        "--shm": PEER,
        "--task": "!room.env robot.3dm --vector 2 --shm ispace-one-room-{own} --task task.yaml",
        "--people": "!room.env robot.3dm --vector 2 --shm ispace-one-room-{own} --people 1",
        "--room": "!room.env robot.3dm --vector 2 --shm ispace-one-room-{own} --room other.env",
        "--autoreset": "!room.env robot.3dm --vector 2 --shm ispace-one-room-{own} --autoreset same_step",
    },
}
