# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module against running servers and tools, which ctest puts into PATH."""

import contextlib
import inspect
import json
import math
import os
import pydoc
import subprocess
import sys
import tempfile
import threading
import unittest
import unittest.mock
from pathlib import Path

import ispace
from ispace import _message, filters, readings

SOURCE = Path(os.environ["ISPACE_SOURCE_DIR"])
DATA = SOURCE / "tests" / "data"
SCENES = SOURCE / "share" / "scenes"
SCHEMAS = SOURCE / "share" / "schemas"


class Lines(unittest.TestCase):
    def test_numbers(self):
        self.assertEqual(_message.number_of("12.300"), 12.3)
        self.assertEqual(_message.number_of("-"), math.inf)
        with self.assertRaises(ispace.ProtocolError):
            _message.number_of("1,5")
        self.assertEqual([_message.text_of(v) for v in (0.3, -90, 1e-9, 2.0)], ["0.3", "-90", "1e-09", "2"])
        with self.assertRaises(ispace.Error):
            _message.text_of(math.nan)

    def test_messages(self):
        message = _message.parse_message("SCAN l1 t=12.300 seq=123 r=1.5,-,2")
        self.assertEqual(message.words, ["SCAN", "l1"])
        self.assertEqual(message.fields.numbers("r"), [1.5, math.inf, 2])
        with self.assertRaisesRegex(ispace.ProtocolError, "has no `n`"):
            message.fields.integer("n")
        mark = _message.parse_message("EVENT mark t=1.500 text=the door = open")
        self.assertEqual(mark.fields["text"], "the door = open")
        change = _message.parse_message("EVENT change t=1.500 what=SET r1.speed=0.2 text=x")
        self.assertEqual(dict(change.fields), {"t": "1.500", "what": "SET r1.speed=0.2 text=x"})

    def test_readings(self):
        def read(kind, line, data=b""):
            message = _message.parse_message(line)
            message.data = message.data or data
            return kind.from_message(message)

        scan = read(readings.Scan, "SCAN l1 t=0 seq=1 angle_min=-90 angle_max=90 step=60 n=4 r=-,2.5,0.5,0.5")
        self.assertEqual((list(scan.ranges), scan.angle_max, scan.step), ([math.inf, 2.5, 0.5, 0.5], 90, 60))
        self.assertEqual(scan.nearest(), (0.5, 30))
        self.assertIs(type(scan.nearest().range), float)
        for values in ("n=2 r=-,-", "n=0 r="):
            alone = read(readings.Scan, f"SCAN l1 t=0 seq=1 angle_min=0 angle_max=0 step=0 {values}").nearest()
            self.assertEqual(alone.range, math.inf)
            self.assertTrue(math.isnan(alone.angle))
        head = "SCAN k t=0 seq=3 pose=1,2,3,90,-10,0 width=2 height=1 "
        mm = read(readings.Depths, head + "format=depth16 base64=3AUAAA==")
        m = read(readings.Depths, head + "format=depth32 bytes=8", b"\0\0\xc0\x3f\0\0\x80\x7f")
        for frame in (mm, m):
            self.assertEqual((frame.at(0, 0), frame.at(1, 0)), (1.5, math.inf))
        self.assertEqual(m.pose.heading, 90)
        with self.assertRaises(ispace.ProtocolError):
            read(readings.Depths, head + "format=depth16", b"ab")
        picture = read(readings.Picture, head + "format=rgb bytes=6", b"abcdef")
        if readings.numpy is not None:
            self.assertEqual(picture.pixels.shape, (1, 2, 3))
        cloud = read(readings.Cloud, "SCAN k t=0 seq=0 format=cloud", b"\0\0\x80\x3f" * 6)
        self.assertEqual([tuple(point) for point in cloud.points], [(1, 1, 1)] * 2)
        burst = read(readings.Burst, "SCAN u1 t=1 seq=2 tags=t1,t2 tof=0.012345,-")
        self.assertEqual(burst.times_of_flight, [("t1", 0.012345), ("t2", math.inf)])
        fix = read(readings.Fix, "SCAN t1 t=1 seq=2 heard=2 x=- y=- z=- residual=-")
        self.assertFalse(fix.solved)
        self.assertEqual(read(readings.Load, "SCAN m1 t=1 seq=2 n=2 on=h1,r1").on, ["h1", "r1"])
        gate = read(readings.Passages, "SCAN g1 t=1 seq=2 in=3 out=2 last=- way=- broken=0")
        self.assertEqual((gate.in_, gate.out, gate.last), (3, 2, ""))
        for reading in (scan, mm, picture, cloud, fix, gate):
            for name in vars(reading):  # those that a method assigns stand in help() by the class alone
                if not name.startswith("_") and name not in ispace.Reading.__dataclass_fields__:
                    self.assertIn(f"``{name}``", inspect.getdoc(type(reading)))

    def test_addresses(self):
        from ispace._connection import host_and_port

        self.assertEqual(host_and_port("[::1]:7001"), ("::1", 7001))
        self.assertEqual(host_and_port(("localhost", 7001)), ("localhost", 7001))
        for text in ("", "localhost", ":7001", "a:", "a:0", "a:65536", "a:7x"):
            with self.assertRaises(ispace.Error, msg=text):
                host_and_port(text)


class Roles(unittest.TestCase):
    """square.env, 4 m by 4 m, with session.3dm, which waits for steps of 5 ms."""

    def setUp(self):
        self.run_ = ispace.simrun(DATA / "square.env", DATA / "session.3dm", clock="step", quiet=True)
        self.addCleanup(self.run_.close)
        self.world = self.run_.world()
        self.addCleanup(self.world.close)

    def test_robot(self):
        with self.run_.robot("r1") as robot:
            self.assertEqual(robot.info["model"], "pioneer-2dx")
            ahead = robot.forward(0.5)
            self.assertFalse(robot.ended(ahead))
            with self.assertRaises(ispace.Timeout):
                robot.wait(ahead, 0.01)
            self.world.advance(5)
            self.assertTrue(robot.ended(ahead))
            self.assertTrue(robot.wait(ahead).done)
            self.assertAlmostEqual(robot.status().pose.x, -0.5, delta=1e-3)
            turn, other = robot.left(90), robot.right(45)
            self.world.advance(5)
            self.assertEqual(robot.wait(turn).reason, "replaced")
            self.assertTrue(robot.wait(other).done)
            robot.speed(0.25)
            robot.rotspeed(-20)
            self.world.advance(2)
            status = robot.status()
            self.assertEqual((status.speed, status.rotspeed, status.stall), (0.25, -20, False))
            self.assertEqual((status.storey, status.passage), ("", ""))
            robot.stop()
            self.world.advance(2)
            self.assertEqual(robot.status().speed, 0)
            self.assertEqual(len(robot.scan("l2").ranges), 3)

    def test_refusals(self):
        with self.run_.robot("r1") as robot:
            with self.assertRaisesRegex(ispace.Refused, "held by another client") as caught:
                self.run_.robot("r1")
            self.assertEqual(caught.exception.code, 409)
            with self.assertRaises(ispace.Refused):
                robot.speed(50)
            with self.assertRaises(ispace.Error):
                robot.connection.ask("STATUS\nSTATUS")
            self.assertEqual(robot.status().time, 0)
        # Free as soon as close() returns.
        self.run_.robot("r1").close()
        with self.assertRaises(ispace.ConnectionFailed):
            robot.status()

    def test_laser(self):
        with self.run_.laser("l1") as laser:
            self.assertEqual((laser.rate, laser.range_min, laser.range_max), (10, 0, 5))
            binary = laser.scan()
            laser.binary(False)
            text = laser.scan()
            for a, b in zip(binary.ranges, text.ranges):
                self.assertAlmostEqual(a, b, delta=5.1e-4)
            self.assertEqual(text.angle(1), 0)
            self.assertAlmostEqual(text.nearest().range, min(binary.ranges), delta=5.1e-4)
            for binary in (True, False):
                laser.binary(binary)
                before = laser.scan().seq
                laser.stream(every=2)
                for i in range(3):
                    self.world.advance(0.2)
                    self.assertEqual(laser.next().seq, before + 2 * i + 2)
                laser.stop()
                with self.assertRaises(ispace.Timeout):
                    laser.next(0.02)

    def test_world(self):
        self.assertEqual((self.world.clock, self.world.dt, self.world.rate), ("step", 0.005, 1))
        self.assertEqual(self.world.list()["robots"], ["r1", "r2"])
        self.assertEqual(self.world.step(300), 300)
        self.assertEqual((self.world.time(), self.world.steps()), (1.5, 300))
        self.assertEqual(self.world.poses()["r2"], (1, 1, 180))
        with self.assertRaises(ispace.Timeout):
            self.world.step(100000, timeout=0.001)
        # The answer to STEP comes first, and is dropped.
        self.assertEqual(self.world._ask("TIME", 60).fields.integer("steps"), 100300)

    def test_shutdown(self):
        self.world.shutdown()
        self.assertEqual(self.run_.wait(60), 0)
        with self.assertRaises(ispace.ConnectionFailed):
            for _ in range(10):
                self.world.time()
        with self.assertRaisesRegex(ispace.ConnectionFailed, "is simrun running"):
            ispace.World(self.run_.address)


class Sensors(unittest.TestCase):
    """A sensor of each kind in square.env; r1 drives past them, h1 stands."""

    def setUp(self):
        self.run_ = ispace.simrun(DATA / "square.env", DATA / "sensing.3dm", clock="step", quiet=True)
        self.addCleanup(self.run_.close)

    def test_every_kind(self):
        at = self.run_.address
        with self.run_.world() as world, self.run_.robot("r1") as robot:
            with self.run_.sensor("l1") as sensor:
                self.assertEqual(sensor.info["kind"], "laser")
                self.assertEqual(sensor.scan().fields["n"], "3")
            with ispace.Ranger(at, "d1") as ranger, ispace.CloudSensor(at, "d1") as cloud:
                near = [ranger.scan().at(column, 1) for column in range(4)]
                self.assertTrue(all(0.5 < distance < 5 for distance in near), near)
                self.assertEqual(len(cloud.scan().points), 12)
                ranger.format("depth16")
                self.assertAlmostEqual(ranger.scan().at(1, 1), near[1], delta=1e-3)
                ranger.binary(False)
                self.assertAlmostEqual(ranger.scan().at(1, 1), near[1], delta=1e-3)
            with ispace.Ultrasound(at, "u1") as receiver, ispace.Tag(at, "t1") as tag:
                self.assertEqual([name for name, _ in receiver.scan().times_of_flight], ["t1", "t2"])
                fix = tag.scan()
                self.assertEqual((fix.heard, fix.solved), (4, True))
                self.assertAlmostEqual(fix.x, -1, delta=0.01)
            with ispace.Mat(at, "m1") as mat, ispace.Gate(at, "g1") as gate:
                self.assertEqual(mat.scan().on, [])
                self.assertEqual((gate.scan().last, gate.scan().way), ("", ""))
                robot.forward(1.5)
                world.advance(4)
                self.assertEqual(mat.scan().on, ["r1"])
                passed = gate.scan()
                self.assertEqual((passed.in_, passed.out, passed.last, passed.way), (1, 0, "r1", "in"))
                self.assertTrue(passed.broken)
            self.assertEqual(robot.reading("d2", ispace.Depths).width, 3)
            with self.assertRaisesRegex(ispace.Refused, "not on this robot"):
                robot.reading("c1", ispace.Picture)

    def test_radar(self):
        with self.run_.world() as world, self.run_.robot("r1") as robot:
            world.add("radar id=w1 at=1.8,0,0.11 heading=180")
            with ispace.Radar(self.run_.address, "w1") as radar:
                world.advance(0.1)
                self.assertEqual(radar.scan().movers, [])
                robot.speed(0.2)
                world.advance(2)
                (seen,) = radar.scan().movers
                self.assertAlmostEqual(seen.speed, -0.2, delta=0.002)
                self.assertAlmostEqual(seen.bearing, 0, delta=0.01)

    def test_smart_room(self):
        at = self.run_.address
        with self.run_.world() as world:
            for record in (
                "imu id=i1 on=r1",
                "cube id=k1 at=1.2,1.2 size=0.1,0.1,0.1 tag=key",
                "rfid id=f1 at=1.2,0.7,0.12 heading=90 range=1 fov=90,90",
                "lamp id=l9 at=0,0 on=yes lumens=3000",
                "lux id=x1 at=0,0,0.5 tilt=90",
                "speaker id=p9 at=1,0 height=1 on=yes volume=70",
                "microphone id=o1 at=-1,0,1 floor=0",
            ):
                world.add(record)
            world.advance(1)
            with ispace.Imu(at, "i1") as imu, ispace.Rfid(at, "f1") as rfid:
                self.assertEqual(imu.scan().rates, [0, 0, 0])
                self.assertAlmostEqual(imu.scan().accelerations[2], 9.81, delta=0.01)
                self.assertEqual(rfid.scan().tags, ["key"])
            with ispace.Lux(at, "x1") as lux, ispace.Microphone(at, "o1") as microphone:
                self.assertGreater(lux.scan().lux, 100)
                self.assertAlmostEqual(microphone.scan().level, 70 - 20 * math.log10(2), delta=0.05)

    def test_mote(self):
        with self.run_.world() as world:
            world.add("lamp id=l8 at=0,0 on=yes")
            world.add("mote id=n1 at=0,0,0.5 tilt=90 radio=2")
            world.add("mote id=n2 at=1,0,0.5")
            world.add("mote id=n3 at=-1.9,-1.9,0.5")
            world.advance(1)
            with ispace.Mote(self.run_.address, "n1") as mote:
                report = mote.scan()
                self.assertGreater(report.lux, 100)
                self.assertEqual(list(report.neighbours), ["n2"])
                self.assertAlmostEqual(report.neighbours["n2"], 20 * math.log10(2), delta=0.06)

    def test_thermometer(self):
        with self.run_.world() as world:
            world.add("zone id=z8 at=0,0 size=4,4 celsius=18")
            world.add("thermometer id=t8 at=0,0,1.5")
            world.add("heater id=h8 at=1,1 on=yes watts=24000")
            world.advance(600)
            with ispace.Thermometer(self.run_.address, "t8") as thermometer:
                steady, constant = 10 + 24000 / 24, 165e3 / 1.5
                celsius = steady + (18 - steady) * math.exp(-600 / constant)
                self.assertAlmostEqual(thermometer.scan().celsius, celsius, delta=0.15)

    def test_uwb(self):
        with self.run_.world() as world:
            world.add("cube id=k2 at=1.2,1.2 size=0.1,0.1,0.09 tag=key")
            world.add("human id=h6 at=-1,1 heading=0 tag=anna height=1.8")
            for i, place in enumerate(("1.9,1.9,1.8", "-1.9,1.9,1.9", "-1.9,-1.9,2", "1.9,-1.9,1.2")):
                world.add(f"uwb id=a{i} at={place}")
            world.advance(1)
            with ispace.Uwb(self.run_.address, "a0") as uwb:
                anna, key = uwb.scan().tags
                self.assertEqual((anna.tag, key.tag), ("anna", "key"))
                self.assertAlmostEqual(key.range, math.dist((1.9, 1.9, 1.8), (1.2, 1.2, 0.11)), delta=0.02)
                self.assertFalse(key.blocked)
                self.assertFalse(key.ambiguous)
                self.assertLess(math.dist(key.position, (1.2, 1.2, 0.11)), 0.02)
                self.assertEqual(uwb.info.number("loss"), 6)

    def test_pir_and_states(self):
        with self.run_.world() as world:
            world.add("pir id=s1 at=1.2,1.8,1.2 heading=-90 range=1.2 fov=50,60 hold=0.5")
            world.add("human id=h5 at=1,1")
            world.add("lamp id=lamp at=1,1 level=50%")
            with ispace.Pir(self.run_.address, "s1") as pir, ispace.Person(self.run_.address, "h5") as person:
                world.advance(1)
                self.assertFalse(pir.scan().motion)
                person.rotspeed(30)
                world.advance(0.5)
                self.assertFalse(pir.scan().motion)
                person.rotspeed(0)
                person.speed(0.5)
                world.advance(0.5)
                self.assertTrue(pir.scan().motion)
                self.assertEqual(world.states("s1"), {"s1.motion": "1"})
                person.stop()
                world.advance(3)
                self.assertFalse(pir.scan().motion)
            self.assertEqual(world.states("lamp"), {"lamp.on": "0", "lamp.level": "0.5", "lamp.color": "1,1,0.97"})
            world.act("lamp", "on", True)
            world.act("lamp", "level", "20%")
            self.assertEqual(world.states("lamp")["lamp.on"], "1")
            self.assertEqual(world.states("lamp")["lamp.level"], "0.2")
            with self.assertRaises(ispace.Refused):
                world.act("s1", "motion", True)

    def test_sonars_and_bumpers(self):
        with self.run_.world() as world:
            world.add("robot id=r5 at=1.5,-1.2 sonar=0.2,0,0;0,-0.2,-90 bumpers=-45,45;135,225")
            with self.run_.robot("r5") as robot:
                ahead, right = robot.sonar()
                self.assertEqual((ahead.place, right.place.heading), ((0.2, 0, 0), -90))
                self.assertAlmostEqual(ahead.range, 0.3, delta=0.005)
                self.assertEqual(robot.bumpers(), [False, False])
                robot.speed(0.3)
                world.advance(5)
                self.assertEqual(robot.bumpers(), [True, False])
                self.assertEqual(robot.rim(), [ispace.Bumper(-45, 45, True), ispace.Bumper(135, 225, False)])
            with self.run_.robot("r1") as robot:
                self.assertEqual(len(robot.sonar()), 16)
                self.assertEqual(len(robot.rim()), 10)
                self.assertEqual(robot.limits, ispace.Limits(0.5, 100, 1.6, 300, 0, 0.3, 100))
            with self.run_.person("h1") as person:
                self.assertEqual((person.limits.speed, person.limits.max_sidespeed), (1.2, 0.6))

    def test_odometry(self):
        with self.run_.world() as world, self.run_.robot("r1") as robot:
            robot.forward(0.5)
            world.advance(5)
            odometry = robot.odometry()
            self.assertAlmostEqual(odometry.pose.x, 0.5, delta=2e-3)
            self.assertEqual(odometry.speed, 0)

    def test_camera_streams(self):
        with self.run_.world() as world, self.run_.camera("c1") as camera:
            first = camera.scan()
            self.assertEqual((first.format, first.width, first.height), ("png", 8, 6))
            self.assertEqual(first.pose[3:5], (45, -20))
            camera.format("rgb")
            camera.stream()
            for i in range(1, 4):
                world.advance(0.2)
                picture = camera.next()
                self.assertEqual((picture.seq, len(picture.data)), (i, 8 * 6 * 3))
            camera.stop()
            with tempfile.TemporaryDirectory() as folder:
                first.save(Path(folder) / "first.png")
                self.assertEqual((Path(folder) / "first.png").read_bytes(), first.data)
            if readings.numpy is not None:
                self.assertEqual(picture.pixels.shape, (6, 8, 3))


class Goto(unittest.TestCase):
    """A room alone."""

    def test_finds_its_way(self):
        with ispace.simrun(DATA / "square.env", DATA / "session.3dm", clock="step", quiet=True) as run, \
                run.world() as world, run.robot("r1") as robot:
            trip = robot.goto(-1, -1.5, heading=180, speed=0.4)
            world.advance(20)
            self.assertTrue(robot.wait(trip).done)
            x, y, heading = robot.status().pose
            self.assertAlmostEqual(x, -1, places=1)
            self.assertAlmostEqual(y, -1.5, places=1)
            self.assertAlmostEqual(abs(heading), 180, places=2)
            with self.assertRaises(ispace.Refused) as refused:
                robot.goto(9, 9)
            self.assertEqual(refused.exception.code, 409)


class Building(unittest.TestCase):
    """Two storeys with a lift and stairs."""

    def test_trips_and_lifts(self):
        with ispace.simrun(DATA / "tower.yaml", DATA / "tower.3dm", clock="step", quiet=True) as run, \
                run.world() as world, run.robot("ground/r1") as robot:
            trip = robot.goto(9, 6, heading=90, storey="upper")
            world.advance(75)
            self.assertTrue(robot.wait(trip).done)
            self.assertAlmostEqual(robot.status().pose[2], 90, places=2)
            self.assertEqual((robot.status().storey, robot.status().passage), ("upper", ""))
            world.call("l1", "ground")
            lift, = world.lifts()
            self.assertEqual((lift.storey, lift.height, lift.riders, lift.calls), ("upper", 3, [], ["ground"]))
            with self.assertRaises(ispace.Refused):
                robot.go_to("upper", -5, 6)
            ride = robot.ride("l1", "ground")
            world.advance(90)
            self.assertTrue(robot.wait(ride).done)
            self.assertEqual(world.list()["rooms"], ["ground", "upper", "l1", "s1"])


class LivingWorld(unittest.TestCase):
    """square.env with sensing.3dm: r1 at (-1, 0) faces h1 at (0.9, 0.5)."""

    def setUp(self):
        self.run_ = ispace.simrun(DATA / "square.env", DATA / "sensing.3dm", clock="step", quiet=True)
        self.addCleanup(self.run_.close)
        self.world = self.run_.world()
        self.addCleanup(self.world.close)

    def test_person_and_paths(self):
        with self.run_.person("h1") as person, self.run_.robot("r1") as robot:
            self.assertEqual(person.info["height"], "1.7")
            walk = person.path([(0.9, -1)])
            ride = robot.path([(-1, 0), (-1, 1), (0, 1)], speed=0.4, pause=0.5)
            self.assertAlmostEqual(ride.length, 2, delta=1e-6)
            self.world.advance(30)
            self.assertTrue(person.wait(walk).done)
            self.assertTrue(robot.wait(ride).done)
            poses = self.world.poses()
            self.assertLess(math.dist(poses["r1"][:2], (0, 1)), 0.01)
            self.assertLess(math.dist(poses["h1"][:2], (0.9, -1)), 0.01)
            person.sidespeed(0.2)
            self.world.advance(1)
            self.assertNotEqual(person.status().pose, poses["h1"])

    def test_changes(self):
        with self.run_.robot("r1") as robot:
            self.assertEqual(self.world.add("cube id=box at=0,0 size=0.5,0.5,1"), "box")
            with self.assertWarnsRegex(UserWarning, r"^human far stands outside the room at \(50.0, 50.0\)$"):
                self.assertEqual(self.world.add("human id=far at=50,50"), "far")
            self.world.remove("far")
            blocked = robot.forward(1.5)
            self.world.advance(10)
            self.assertEqual(robot.wait(blocked).reason, "stall")
            self.world.remove("box")
            with self.assertRaises(ispace.Refused):
                self.world.remove("box")
            self.world.set("r1", "speed", "0.1")
            robot.forward(0.3)
            self.world.advance(2)
            self.assertEqual(robot.status().speed, 0.1)
            self.world.reset()
            self.assertEqual(robot.status().pose, (-1, 0, 0))
        self.world.load(DATA / "square.env", DATA / "session.3dm")
        self.assertEqual(self.world.list()["robots"], ["r1", "r2"])

    def test_events(self):
        self.world.follow("collision", "mark")
        self.world.mark("the robot = off")
        with self.run_.robot("r1") as robot:
            robot.forward(5)
            self.world.advance(10)
        first, second = list(self.world.events(timeout=0.05))[:2]
        self.assertEqual((first.kind, first.fields["text"]), ("mark", "the robot = off"))
        self.assertEqual((second.kind, second.fields["into"]), ("collision", "h1"))
        self.world.unfollow()
        self.world.mark("nobody hears this")
        self.assertIsNone(self.world.next_event(0.05))

    def test_token(self):
        with tempfile.NamedTemporaryFile("w") as file:
            file.write("a-secret-of-this-test\n")
            file.flush()
            run = ispace.simrun(DATA / "square.env", clock="step", token_file=file.name)
        with run:
            with run.world() as stranger, self.assertRaises(ispace.Refused) as caught:
                stranger.reset()
            self.assertEqual(caught.exception.code, 401)
            with ispace.World(run.address, token="a-secret-of-this-test") as friend:
                friend.reset()


@contextlib.contextmanager
def recorded():
    """The record of a run of 2 s in which r1 drives ahead."""
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / "run"
        script = Path(folder) / "script.txt"
        script.write_text("0 r1 SPEED 0.3\n", encoding="ascii")
        scene = (DATA / "square.env", DATA / "sensing.3dm")
        with ispace.simrun(*scene, clock="fast", until=2, script=script, record=record, quiet=True) as run:
            if run.wait(60) != 0:
                raise AssertionError(run.messages)
        yield record


class Replays(unittest.TestCase):
    def test_a_replay_is_taken_to_a_time(self):
        with recorded() as record, ispace.simrun(replay=record, hold=True, clock="step") as run:
            with run.world() as world, run.robot("r1") as robot:
                self.assertEqual(world.end(), 2)
                self.assertEqual(world.seek(1.503), 1.5)
                there = robot.status()
                self.assertEqual(there.time, 1.5)
                self.assertEqual(world.seek(0), 0)
                self.assertEqual(robot.status().pose, (-1, 0, 0))
                world.advance(1.5)
                self.assertEqual(robot.status(), there)
                self.assertEqual(world.seek(99), 2)
                with self.assertRaises(ispace.Refused):
                    world.seek(-1)
        with ispace.simrun(DATA / "square.env", clock="step", quiet=True) as run, run.world() as world:
            self.assertEqual(world.end(), math.inf)
            with self.assertRaisesRegex(ispace.Refused, "only a replay"):
                world.seek(1)


class Threads(unittest.TestCase):
    """Several threads share a connection, and none gets the answer to the question of another."""

    def setUp(self):
        self.run_ = ispace.simrun(DATA / "square.env", DATA / "session.3dm", clock="step", quiet=True)
        self.addCleanup(self.run_.close)
        self.world = self.run_.world()
        self.addCleanup(self.world.close)

    def together(self, *tasks):
        failures = []

        def guarded(task):
            try:
                task()
            except BaseException as error:
                failures.append(error)

        threads = [threading.Thread(target=guarded, args=[task]) for task in tasks]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
            self.assertFalse(thread.is_alive())
        self.assertEqual(failures, [])

    def test_each_gets_its_own_answer(self):
        with self.run_.robot("r1") as robot:
            motion = robot.forward(0.3)
            self.world.advance(4)
            self.assertTrue(robot.wait(motion, 5).done)
            status, odometry, sonar = robot.status(), robot.odometry(), robot.sonar()

            def ask(question, answer):
                for _ in range(200):
                    self.assertEqual(question(), answer)

            self.together(
                lambda: ask(robot.status, status),
                lambda: ask(robot.odometry, odometry),
                lambda: ask(robot.odometry, odometry),
                lambda: ask(robot.sonar, sonar),
            )

    def test_one_waits_for_a_motion_while_others_ask(self):
        with self.run_.robot("r1") as robot:
            first = robot.forward(0.2)
            ends = []

            def drive():
                while robot.status().time < 8:
                    self.world.advance(0.1)

            def follow_up():
                ends.append(robot.wait(first, 60))
                ends.append(robot.wait(robot.left(20), 60))

            def look():
                for _ in range(300):
                    robot.ended(first)  # leaves the end to the thread that waits for it, and reads in its stead
                    self.assertEqual(robot.odometry().pose.y, 0)

            self.together(follow_up, drive, look)
            self.assertEqual([end.done for end in ends], [True, True])

    def test_a_late_answer_is_that_of_its_own_question(self):
        with self.run_.world() as world, self.run_.robot("r1") as robot:
            world.connection.ask("TIME")
            late = 0
            for _ in range(2000):  # on an idle machine many answers are in time
                try:
                    robot.connection.ask("STATUS", 0)
                except ispace.Timeout:
                    late += 1
                self.assertEqual(robot.odometry().pose, (0, 0, 0))
                if late == 20:
                    break
            self.assertGreater(late, 0)

    def test_closing_ends_the_wait_of_another(self):
        robot = self.run_.robot("r1")
        motion = robot.forward(1)

        def wait():
            with self.assertRaises(ispace.ConnectionFailed):
                robot.wait(motion)

        self.together(wait, robot.close)


class Complete(unittest.TestCase):
    def test_each_public_entry_is_documented(self):
        silent = []
        for name in ispace.__all__:
            entry = getattr(ispace, name)
            if not inspect.isclass(entry):
                continue
            for key in (key for key in dir(entry) if not key.startswith("_")):
                value = inspect.getattr_static(entry, key)  # also of base classes that have no public name
                value = getattr(value, "__func__", value)
                if (inspect.isfunction(value) or isinstance(value, property)) and not inspect.getdoc(value):
                    silent.append(f"{name}.{key}")
        self.assertEqual(silent, [])

    def test_help_tells_what_a_program_gets(self):
        text = pydoc.render_doc(ispace.Scan, renderer=pydoc.plaintext)
        for told in ("ranges\n", "infinity: no return", "nearest(self)", "range_min", "angle_min\n"):
            self.assertIn(told, text)
        self.assertLessEqual({"ranges", "nearest", "angle_min", "angle_max", "step"}, set(dir(ispace.Scan)))
        self.assertLessEqual({"range_min", "range_max", "rate"}, set(dir(ispace.LaserSensor)))
        self.assertIn("End(done=False, reason=", inspect.getdoc(ispace.Robot.wait))
        self.assertIn("unreached", inspect.getdoc(ispace.Robot.goto))
        for told in ("another client holds", "no way"):
            self.assertIn(told, inspect.getdoc(ispace.Refused))
        self.assertIn("Threads may share a connection", inspect.getdoc(ispace))

    def test_records_are_those_of_the_world(self):
        with ispace.simrun(DATA / "square.env", DATA / "session.3dm", clock="step") as run:
            with ispace.World(run.address) as world:
                records = world.records()
                self.assertTrue(any(" id=r1" in record for record in records), records)
                added = world.add("zone at=1,1 size=0.2,0.2")
                self.assertEqual(len(world.records()), len(records) + 1)
                self.assertTrue(any(f" id={added} " in record for record in world.records()))

    def test_both_clients_have_every_request(self):
        client = SOURCE / "lib" / "client"
        sources = {
            "C++": "".join(path.read_text(encoding="utf-8") for path in (client / "ispace_client").glob("*.h")),
            "Python": "".join(path.read_text(encoding="utf-8") for path in (client / "python").glob("ispace/*.py")),
        }
        with recorded() as record, ispace.simrun(replay=record, hold=True, clock="step") as run:
            for role in ("", "ROBOT r1", "PERSON h1", "LASER l1", "SENSOR c1", "WORLD"):
                connection = ispace.Connection(run.address)
                if role:
                    connection.ask(role)
                requests = connection.ask("HELP").line.removeprefix("OK HELP ").split(" | ")
                self.assertGreater(len(requests), 2)
                for verb in (request.split()[0] for request in requests):
                    for language, text in sources.items():
                        if verb != "HELP":
                            self.assertRegex(text, rf"\"{verb}\b", f"{role}: {verb} in {language}")
                connection.close()


class Server(unittest.TestCase):
    def test_stops_only_its_own(self):
        with ispace.simrun(DATA / "square.env", DATA / "session.3dm") as one:
            with ispace.simrun(DATA / "square.env", DATA / "session.3dm") as two:
                self.assertNotEqual(one.address, two.address)
                os.kill(two.pid, 0)
            self.assertEqual((two.status, two.pid), (0, None))
            with one.world() as world:
                self.assertGreaterEqual(world.time(), 0)
        self.assertEqual(one.status, 0)

    def test_a_loop_over_readings_ends_the_stream(self):
        with ispace.simrun(DATA / "square.env", DATA / "session.3dm", clock="real:20", q=True) as run:
            with run.laser("l1") as laser:
                seen = []
                for scan in laser.readings(every=2):
                    seen.append(scan.seq)
                    if len(seen) == 3:
                        break
                self.assertEqual([seq % 2 for seq in seen], [0, 0, 0])
                with self.assertRaises(ispace.Timeout):
                    laser.next(0.1)

    def test_ends_with_an_exception(self):
        with self.assertRaises(KeyError):
            with ispace.simrun(DATA / "square.env") as run:
                raise KeyError
        self.assertEqual(run.status, 0)

    def test_says_why_it_cannot_begin(self):
        with self.assertRaisesRegex(ispace.ToolError, "missing.env.*No such file") as caught:
            ispace.simrun("missing.env")
        self.assertEqual(caught.exception.status, 1)
        with self.assertRaises(ispace.ToolError) as caught:
            ispace.simrun(DATA / "square.env", clock="sidereal")
        self.assertEqual(caught.exception.status, 2)

    def test_ends_by_itself(self):
        run = ispace.simrun(DATA / "square.env", DATA / "session.3dm", clock="fast", until=2)
        self.assertEqual(run.wait(60), 0)


class Filters(unittest.TestCase):
    def test_arrange_and_coverage(self):
        layout = ispace.arrange(SCENES / "l-room.env", sensor="urg-04lx:2", strategy="grid", X=4, Y=4)
        self.assertEqual([record.keyword for record in layout.records if "id" in record.keys], ["laser"] * 2)
        report = ispace.coverage(SCENES / "l-room.env", layout)
        share = float(layout.result["coverage"].rstrip("%")) / 100
        self.assertAlmostEqual(report.coverage.grid, share, delta=0.02)
        self.assertIsInstance(report.coverage, ispace.Figure)
        schema = json.loads((SCHEMAS / "coverage.json").read_text(encoding="utf-8"))
        self.assertEqual(set(ispace.CoverageReport.__annotations__), set(schema["required"] + schema["anyOf"][0]["required"]))
        self.assertEqual([sensor.id for sensor in report.sensors], ["laser1", "laser2"])
        with self.assertRaises(AttributeError):
            report.nothing
        with self.assertRaisesRegex(ispace.RequirementMissed, "below the required 99%") as caught:
            ispace.coverage(SCENES / "l-room.env", layout, require=["10%", "99%"])
        self.assertEqual(caught.exception.product.coverage, report.coverage)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "two.3dm"
            layout.save(path)
            self.assertEqual(ispace.coverage(SCENES / "l-room.env", path).coverage, report.coverage)

    def test_info(self):
        report = ispace.info(SCENES / "l-room.env")
        self.assertEqual((report.indoor_area, report.counts.fence), (28, 1))
        with self.assertRaisesRegex(ispace.ToolError, "missing.env"):
            ispace.info("missing.env")

    def test_scan(self):
        scans = ispace.scan(SCENES / "ispace.env", SCENES / "ispace.3dm", select="l2", frames=2)
        self.assertEqual([(scan.sensor, scan.frame) for scan in scans], [("l2", 0), ("l2", 1)])
        self.assertEqual(len(scans[0].ranges), 181)

    def test_options(self):
        self.assertEqual(
            filters.arguments_of({"grid_of": "beams", "progress": False, "o": "x", "json": True, "no": None, "set": [1, "b"]}),
            ["--grid-of", "beams", "--no-progress", "-o", "x", "--json", "--set", "1", "--set", "b"],
        )

    def test_records_with_quotes(self):
        layout = ispace.Layout('#3dm 1\nlaser id=l1 name="in the corner" at=1,2\n')
        self.assertEqual(layout.records[0].keys, {"id": "l1", "name": "in the corner", "at": "1,2"})

    def test_missing_tool(self):
        saved = os.environ.get("ISPACE_BIN")
        os.environ["ISPACE_BIN"] = "/nonexistent"
        try:
            with self.assertRaisesRegex(ispace.ToolError, "coverage is not in /nonexistent"):
                ispace.coverage("room.env")
        finally:
            del os.environ["ISPACE_BIN"]
            if saved is not None:
                os.environ["ISPACE_BIN"] = saved

    def test_tools_kept_apart_are_preferred(self):
        with tempfile.TemporaryDirectory() as prefix:
            for name in ["bin/ispace", "bin/scan", "lib/ispace/bin/scan"]:
                file = Path(prefix, name)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.touch(0o755)
            with unittest.mock.patch.dict(os.environ, {"PATH": prefix + "/bin"}):
                os.environ.pop("ISPACE_BIN", None)
                self.assertTrue(os.path.samefile(filters.tool("scan"), Path(prefix, "lib/ispace/bin/scan")))
                Path(prefix, "lib/ispace/bin/scan").unlink()
                self.assertTrue(os.path.samefile(filters.tool("scan"), Path(prefix, "bin/scan")))


class Package(unittest.TestCase):
    def test_version_is_that_of_the_project(self):
        text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
        self.assertIn(f"project(ispace VERSION {ispace.__version__} ", text)

    def test_works_without_numpy(self):
        code = "import sys; sys.modules['numpy'] = None; import unittest; sys.argv[1:] = ['Lines', 'Roles.test_laser'];"
        code += f"sys.path.insert(0, {str(Path(__file__).parent)!r}); unittest.main('python_test')"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_everything_public_is_documented_and_exported(self):
        for name in ispace.__all__:
            thing = getattr(ispace, name)
            if isinstance(thing, type) or callable(thing):
                self.assertTrue(getattr(thing, "__doc__", None) or name == "Address", name)


if __name__ == "__main__":
    unittest.main()
