# SPDX-License-Identifier: GPL-3.0-or-later
"""Drive the robots and people of simrun, read its sensors, and run the filters of ispace.

::

    import ispace

    with ispace.simrun("ispace.env", "ispace.3dm", clock="real:20") as run:
        with run.robot("r1") as robot, run.laser("l1") as laser:
            robot.wait(robot.forward(0.5))
            print(robot.status().pose, min(laser.scan().ranges))

    report = ispace.coverage("room.env", ispace.arrange("room.env", sensor="urg-04lx:3"))
    print(report.coverage.exact)

Robot and Person drive, LaserSensor, Camera and their kin read, World controls the clock, changes and events, Node is
a computer of a sensor network, Memory holds contents at places, Floor feels weights, Meter
reads plugs; each is a separate connection to a running simrun, by its address
``"127.0.0.1:7001"``. Units are those of the protocol: metres, degrees, simulated seconds; frames are right-handed and
headings counter-clockwise. Failures raise an Error with the server's text. Threads may share a connection: one waits
for a motion while another reads the odometry, and each gets its own answers; processes open one each. The standard
library is enough; arrays are numpy's if it is installed.

VectorEnv and Env are worlds for learners, which require numpy; check_vector_env checks such environments of any make.
"""

from typing import TYPE_CHECKING, Any

from ._connection import Address, Connection
from ._message import Fields, Message, Pose, Pose3
from ._version import __version__
from .bumpers import Bumpers, Impact
from .errors import (
    ConnectionFailed,
    Error,
    ProtocolError,
    Refused,
    RequirementMissed,
    Timeout,
    ToolError,
)
from .filters import CoverageReport, Figure, Layout, Object, Record, arrange, coverage, info, scan
from .floor import Floor, Pressure
from .heads import HeadReading, Heads
from .locks import LockReading, Locks
from .memory import Memory, Touch
from .meter import Meter, MeterReading
from .mote import Mote, MoteReport
from .movers import Bumper, End, Limits, Motion, Odometry, Person, Robot, Sonar, Status
from .node import Node, NodeMessage
from .pir import Pir, Presence
from .radar import Detection, Detections, Radar
from .radios import RadioMessage, Radios
from .readings import Beam, Burst, Cloud, Depths, Fix, Load, Passages, Picture, Reading, Scan
from .sensors import (
    Camera,
    CloudSensor,
    Gate,
    LaserSensor,
    Mat,
    Ranger,
    Sensor,
    Tag,
    Ultrasound,
)
from .server import Simrun, simrun
from .smart_room import (
    Illuminance,
    Imu,
    Inertia,
    Lux,
    Microphone,
    Rfid,
    SoundLevel,
    TagList,
)
from .thermometer import Temperature, Thermometer
from .uwb import TagRange, TagRanges, Uwb
from .world import Event, Lift, World

if TYPE_CHECKING:
    from .check import VectorEnvFaults as VectorEnvFaults
    from .check import check_vector_env as check_vector_env
    from .vector import AutoresetMode as AutoresetMode
    from .vector import Env as Env
    from .vector import VectorEnv as VectorEnv


def __getattr__(name: str) -> Any:
    """Imports the classes of learners when they are first asked for: these require numpy."""
    import importlib

    modules = {
        "AutoresetMode": "vector",
        "Env": "vector",
        "VectorEnv": "vector",
        "VectorEnvFaults": "check",
        "check_vector_env": "check",
    }
    if name not in modules:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f".{modules[name]}", __name__), name)
    globals()[name] = value
    return value


__all__ = [
    "Address",
    "Beam",
    "Bumper",
    "Bumpers",
    "Burst",
    "Camera",
    "Cloud",
    "CloudSensor",
    "Connection",
    "ConnectionFailed",
    "CoverageReport",
    "Depths",
    "Detection",
    "Detections",
    "End",
    "Error",
    "Event",
    "Fields",
    "Figure",
    "Fix",
    "Floor",
    "Gate",
    "HeadReading",
    "Heads",
    "Illuminance",
    "Impact",
    "Imu",
    "Inertia",
    "LaserSensor",
    "Layout",
    "Lift",
    "Limits",
    "Load",
    "LockReading",
    "Locks",
    "Lux",
    "Mat",
    "Memory",
    "Meter",
    "MeterReading",
    "Message",
    "Microphone",
    "Mote",
    "MoteReport",
    "Motion",
    "Node",
    "NodeMessage",
    "Object",
    "Odometry",
    "Passages",
    "Person",
    "Picture",
    "Pose",
    "Pose3",
    "ProtocolError",
    "Pir",
    "Presence",
    "Pressure",
    "Radar",
    "RadioMessage",
    "Radios",
    "Ranger",
    "Reading",
    "Record",
    "Refused",
    "RequirementMissed",
    "Rfid",
    "Robot",
    "Scan",
    "Sensor",
    "Simrun",
    "Sonar",
    "SoundLevel",
    "Status",
    "Tag",
    "TagList",
    "TagRange",
    "TagRanges",
    "Temperature",
    "Thermometer",
    "Timeout",
    "ToolError",
    "Touch",
    "Ultrasound",
    "Uwb",
    "World",
    "__version__",
    "arrange",
    "coverage",
    "info",
    "scan",
    "simrun",
]
