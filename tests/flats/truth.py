# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges the labels of a run by what its flat and its script say: computed from geometry and the ways of people here, by
the records of the programs under test alone. See check()."""

import bisect
import collections
import csv
import json
import math
import os

from flat import SECONDS, STEP

GRAVITY = 9.80665
SLACK = 0.35  # seconds within which a label follows: readings ten times a second, and changes a step later
# ispace-3dm(5): watts, and seconds of start and hold (empty: until it is switched off), and whether it goes on alone.
APPLIANCES = {
    "kettle": ((2200, 2200, 0), (165, 10), True),
    "oven": ((2500, 800, 0.8), (480, None), False),
    "fridge": ((400, 69, 1), (1, 900), True),
    "tv": ((90, 68, 0.4), (8, None), False),
    "display": ((0, 22, 0.3), (0, None), False),
    "plug_lamp": ((0, 8.5, 0), (0, None), False),
}


class Timeline:
    """The values of a state over time."""

    def __init__(self, first=None):
        self.times, self.values = [-1.0], [first]

    def add(self, time, value):
        self.times.append(time)
        self.values.append(value)

    def at(self, time):
        return self.values[bisect.bisect_right(self.times, time + 1e-6) - 1]

    def within(self, begin, end):
        """All values that it has in this time."""
        first = bisect.bisect_right(self.times, begin + 1e-6) - 1
        last = bisect.bisect_right(self.times, end + 1e-6)
        return set(self.values[max(0, first):last])

    def changes(self):
        return list(zip(self.times[1:], self.values[1:]))


class Record:
    """The files of a record."""

    def __init__(self, folder, before):
        def rows(name):
            with open(os.path.join(folder, name), newline="", encoding="utf-8") as file:
                return list(csv.DictReader(file))

        self.states = collections.defaultdict(Timeline)
        for key, value in before.items():
            self.states[key] = Timeline(value)
        for row in rows("states.csv"):
            self.states[f"{row['id']}.{row['state']}"].add(float(row["t"]), row["value"])
        self.ways = collections.defaultdict(list)  # id -> poses, one a step
        for name in ("people.csv", "robots.csv"):
            for row in rows(name):
                still = all(float(row.get(key) or 0) == 0 for key in ("speed", "rotspeed_deg", "sidespeed"))
                self.ways[row["id"]].append((float(row["x"]), float(row["y"]), math.radians(float(row["heading_deg"])), still))
        self.rests = {}  # id -> seconds without motion until each step
        for name, way in self.ways.items():
            rests, last = [], None
            for pose in way:
                moved = last is None or not pose[3] or not last[3] or pose[:2] != last[:2]
                rests.append(0.0 if moved else rests[-1] + STEP)
                last = pose
            self.rests[name] = rests
        self.deeds = rows("activities.csv")
        self.events = rows("events.csv")
        self.readings = collections.defaultdict(list)
        with open(os.path.join(folder, "scans.jsonl"), encoding="utf-8") as file:
            for line in file:
                if line.startswith(('{"sensor":"on-', '{"sensor":"hand-', '{"sensor":"u')):
                    reading = json.loads(line)
                    self.readings[reading["sensor"]].append(reading)

    def pose(self, name, time):
        way = self.ways[name]
        return way[min(len(way) - 1, max(0, round(time / STEP)))]


def crosses(a, b, wall):
    (x1, y1), (x2, y2) = wall

    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side((x1, y1), (x2, y2), a) * side((x1, y1), (x2, y2), b) < 0 and side(a, b, (x1, y1)) * side(a, b, (x2, y2)) < 0


class Judge:
    """Collects what is false, and how often each kind of label was looked at."""

    def __init__(self, flat, record, heard):
        self.flat, self.record, self.heard = flat, record, heard
        self.false, self.looked = [], collections.Counter()
        self.deeds = collections.defaultdict(list)  # person -> (begin, end, words, done)
        for row in record.deeds:
            words = row["action"].split()
            self.deeds[row["id"]].append((float(row["begin"]), float(row["end"]), words, row["done"] == "1"))
        ended = {(row["id"], float(row["begin"]), row["action"]) for row in record.deeds}
        for row in record.events:  # those that are under way at the end
            if row["kind"] == "activity" and row["value"] == "1" and (row["id"], float(row["t"]), row["text"]) not in ended:
                self.deeds[row["id"]].append((float(row["t"]), SECONDS + 2 * SLACK, row["text"].split(), False))

    def say(self, kind, is_true, text):
        self.looked[kind] += 1
        if not is_true:
            self.false.append(f"{kind}: {text}")

    def posture(self, person, time):
        return self.record.states[f"{person}.posture"].at(time) or "stand"

    # -- people --

    def postures(self):
        """Each change of a posture is what the person does then, and what it does changes it."""
        for person in self.flat.people:
            changes = self.record.states[f"{person}.posture"].changes()
            for time, value in changes:
                doing = [words for begin, end, words, _ in self.deeds[person] if begin - STEP <= time <= end + SLACK]
                verbs = {words[0] for words in doing}
                wanted = {"sit": {"sits"}, "lie": {"lies"}, "fallen": {"falls"}, "stand": {"sits", "lies", "stands", "falls"}}
                self.say("posture", verbs & wanted[value], f"{person} {value} at {time} while {doing}")
            for begin, end, words, done in self.deeds[person]:
                if not done:
                    continue
                if words[0] in ("sits", "lies"):
                    value = words[0].rstrip("s")
                    lasts = float(words[3].rstrip("s"))
                    middle = end - lasts / 2
                    self.say("posture", self.posture(person, middle) == value, f"{person} {words} at {middle}")
                    x, y = self.record.pose(person, middle)[:2]
                    thing = self.flat.things[words[2]]
                    self.say("on a thing", thing.within(x, y, 0.01), f"{person} {words} at {x},{y}")
                    after = self.record.states[f"{person}.posture"].within(end - STEP, end + SLACK)
                    self.say("posture", after & {"stand", "fallen"}, f"{person} after {words}")
                if words[0] in ("falls", "stands"):
                    value = {"falls": "fallen", "stands": "stand"}[words[0]]
                    self.say(
                        "posture",
                        value in self.record.states[f"{person}.posture"].within(begin, end + SLACK),
                        f"{person} {words}",
                    )
            # One that does not stand does not walk.
            for step, ((x1, y1, *_), (x2, y2, *_)) in enumerate(zip(self.record.ways[person], self.record.ways[person][1:])):
                values = self.record.states[f"{person}.posture"].within((step - 1) * STEP, (step + 2) * STEP)
                if values <= {"sit", "lie", "fallen"} and len(values) == 1:
                    self.say("rest", (x1, y1) == (x2, y2), f"{person} moves at {step * STEP:.1f} while {values}")

    def pointing(self):
        """Arms point to the middle of things: yaw and heading give their direction."""
        for person in self.flat.people:
            for begin, end, words, done in self.deeds[person]:
                if words[0] != "points" or not done:
                    continue
                lasts = float(words[3].rstrip("s"))
                time = end - lasts / 2
                arms = [self.record.states[f"{person}.{arm}"].at(time) for arm in ("left_arm", "right_arm")]
                raised = [arm for arm in arms if arm and not arm.endswith(",-90")]
                self.say("arm", raised, f"{person} {words} at {time}: {arms}")
                target = self.flat.zones.get(words[2]) or self.flat.things.get(words[2])
                if not raised or target is None or words[2] in self.flat.loads:
                    continue
                x, y, heading, _ = self.record.pose(person, time)
                away = math.hypot(target.x - x, target.y - y)
                if away < 1:
                    continue
                side = 1 if arms[0] in raised else -1
                shoulder = (x - side * 0.2 * math.sin(heading), y + side * 0.2 * math.cos(heading))
                yaws = [heading + math.radians(float(arm.split(",")[0])) for arm in raised]
                wanted = math.atan2(target.y - shoulder[1], target.x - shoulder[0])
                off = min(abs(math.remainder(yaw - wanted, math.tau)) for yaw in yaws)
                self.say(
                    "arm",
                    off < math.radians(8),
                    f"{person} {words} at {time}: {math.degrees(off):.1f} degrees off",
                )

    def walls(self):
        """People and robots pass walls through open doors alone, and locked doors open to those with a tag."""
        for name, way in self.record.ways.items():
            for step, ((x1, y1, *_), (x2, y2, *_)) in enumerate(zip(way, way[1:])):
                if (x1, y1) == (x2, y2):
                    continue
                for wall in self.flat.walls:
                    if not crosses((x1, y1), (x2, y2), wall):
                        continue
                    time = (step + 1) * STEP
                    door = self.door_at(wall, (x1, y1), (x2, y2))
                    self.say("wall", door, f"{name} through {wall} at {time:.1f}: {x1},{y1} to {x2},{y2}")
                    if door:
                        is_open = self.record.states[f"{door}.open"].within(time - 2 * STEP, time)
                        self.say("door", "1" in is_open, f"{name} through shut {door} at {time:.1f}")

    def door_at(self, wall, a, b):
        if wall[0][1] != wall[1][1]:
            return None
        y = wall[0][1]
        x = a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1])
        for name, door in self.flat.doors.items():
            if abs(door["y"] - y) < 1e-6 and abs(door["x"] - x) < 0.45:
                return name
        return None

    def locks(self):
        """Whenever a locked door opens, a person with its tag, or one that forces it, is at it."""
        for name, door in self.flat.doors.items():
            states = {state: self.record.states[f"{name}.{state}"] for state in ("open", "locked", "forced")}
            if door["access"] is None:
                self.say("lock", not states["locked"].changes(), f"{name} without a lock: {states['locked'].changes()}")
                continue
            for time, value in states["locked"].changes():
                near = []
                for person, of in self.flat.people.items():
                    x, y = self.record.pose(person, time)[:2]
                    away = math.hypot(x - door["x"], y - door["y"])
                    verbs = [w[0] for b, e, w, _ in self.deeds[person] if b - STEP <= time <= e + SLACK]
                    may = of["tag"] in door["access"]
                    if (may and (away < 1.5 or {"opens", "unlocks", "closes"} & set(verbs))) or "forces" in verbs:
                        near.append(person)
                if value == "0":
                    self.say("lock", near, f"{name} unlocks at {time}, nobody may: {near}")
                self.say(
                    "lock",
                    value == "0" or states["open"].at(time + STEP) == "0",
                    f"{name} locked while open at {time}",
                )
            for time, value in states["forced"].changes():
                forces = [p for p, d in self.deeds.items() for b, e, w, _ in d if w == ["forces", name] and b - STEP <= time <= e + SLACK]
                self.say("forced", value == "1" and forces, f"{name} forced={value} at {time}")

    def loads(self):
        """A thing that a person holds is at its hand; others stay where they were."""
        for load in self.flat.loads:
            holders = []
            for person in self.flat.people:
                timeline = self.record.states[f"{person}.holds"]
                for time, value in timeline.changes():
                    end = next((t for t, v in timeline.changes() if t > time), SECONDS + 1)
                    if value == load:
                        holders.append((time, end, person))
            for person in self.flat.people:
                for begin, end, words, done in self.deeds[person]:
                    if words[0] == "carries" and words[1] == load and done:
                        held = [h for h in holders if h[2] == person and h[0] <= end + SLACK and h[1] >= begin - SLACK]
                        self.say("holds", held, f"{person} {words} until {end}: {holders}")
            before = None
            for reading in self.record.readings[f"on-{load}"]:
                time, (x, y, z) = reading["t"], reading["pose"][:3]
                by = [h for h in holders if h[0] + STEP < time < h[1] - 2 * STEP]
                near = [h for h in holders if h[0] - 3 * STEP < time < h[1] + 3 * STEP]
                self.say("holds", len(by) < 2, f"{load} at {time} in hands of {by}")
                if by:
                    px, py, heading, _ = self.record.pose(by[0][2], time)
                    height = self.flat.people[by[0][2]]["height"]
                    ahead = (x - px) * math.cos(heading) + (y - py) * math.sin(heading)
                    aside = (y - py) * math.cos(heading) - (x - px) * math.sin(heading)
                    rests = self.posture(by[0][2], time) != "stand"
                    # 0.6 m of 1.7 m at 35 degrees below level from the right shoulder.
                    is_there = abs(ahead - 0.289 * height) < 0.02 * height and -0.2 * height < aside < -0.05 * height
                    arm = self.record.states[f"{by[0][2]}.right_arm"].within(time - 2 * STEP, time + 2 * STEP)
                    rests = rests or any(pose and not pose.endswith(",-90") for pose in arm)  # or points with it
                    self.say(
                        "carried",
                        rests or is_there,
                        f"{load} at {time}: {ahead:.2f} ahead, {aside:.2f} aside of {by[0][2]}",
                    )
                    self.say("carried", rests or 0.5 * height < z < 0.9 * height, f"{load} at {time}: {z:.2f} high")
                    before = None
                elif near:
                    before = None
                else:
                    self.say(
                        "left alone",
                        before in (None, (x, y, z)),
                        f"{load} moved at {time} from {before} to {x},{y},{z}",
                    )
                    before = (x, y, z)
            for person in self.flat.people:
                for begin, end, words, done in self.deeds[person]:
                    if words[0] != "carries" or words[1] != load or not done or end > SECONDS - 3:
                        continue
                    # The second part of the deed, which sets it down.
                    if not any(person == h[2] and abs(h[1] - end) < SLACK for h in holders):
                        continue
                    after = next((r for r in self.record.readings[f"on-{load}"] if r["t"] > end + SLACK), None)
                    if after is None or any(h[0] - SLACK < after["t"] < h[1] + SLACK for h in holders):
                        continue
                    x, y, z = after["pose"][:3]
                    if words[3] in self.flat.zones:
                        zone = self.flat.zones[words[3]]
                        self.say("set down", zone.distance(x, y) < 0.6, f"{load} of {words} at {x},{y},{z}")
                    else:
                        thing = self.flat.things[words[3]]
                        self.say("set down", thing.within(x, y) and z > thing.top, f"{load} of {words} at {x},{y},{z}")

    def tags(self):
        """UWB ranges of carried things are those to the hand."""
        at_times = {load: {round(r["t"], 3): r for r in self.record.readings[f"on-{load}"]} for load in self.flat.loads}
        for anchor, place in self.flat.uwbs.items():
            for reading in self.record.readings[anchor]:
                for tag in reading["tags"]:
                    name = tag["tag"]
                    time = reading["t"]
                    if not name.startswith("t") or name[1:] not in self.flat.loads:
                        continue
                    load = name[1:]
                    near = at_times[load].get(round(time, 3))
                    if near is None:
                        continue
                    away = math.dist(near["pose"][:3], place)
                    self.say(
                        "uwb",
                        abs(away - tag["range"]) < 0.25,
                        f"{anchor} at {time}: {name} is {tag['range']} away, not {away:.3f}",
                    )

    # -- what feels --

    def still_since(self, name, time):
        rests = self.record.rests[name]
        return rests[min(len(rests) - 1, round(time / STEP))]

    def on_seat(self, person, thing, time):
        """Whether a person is on a thing: true or false, or empty where it is not sure."""
        if len(self.record.states[f"{person}.posture"].within(time - SLACK, time + 2 * STEP)) > 1:
            return None
        x, y = self.record.pose(person, time)[:2]
        posture, still = self.posture(person, time), self.still_since(person, time)
        if posture in ("sit", "lie"):
            if not thing.within(x, y, 0.01):
                return False if not thing.within(x, y, 0.03) else None
            return True if still > 2 + SLACK else None if still > 2 - SLACK else False
        known = self.flat.people[person]["postured"] or any(t <= time for t, _ in self.record.states[f"{person}.posture"].changes())
        if posture == "fallen" or known:
            return False
        # Without a posture, one that stands beside it counts.
        away = thing.distance(x, y)
        if away > 0.62 or still < 2 - SLACK:
            return False
        return None

    def seats(self):
        """A seat is occupied while a person is on it."""
        for sensor, name in self.flat.seats.items():
            thing = self.flat.things[name]
            if name in self.flat.chairs:
                thing = type(thing)(thing.x, thing.y, 0.5, 0.5, thing.top)
            for step in range(5, round(SECONDS / STEP), 5):
                time = step * STEP
                on = {person: self.on_seat(person, thing, time) for person in self.flat.people}
                if None in on.values():
                    continue
                wanted = any(on.values())
                found = self.record.states[f"{sensor}.occupied"].within(time - STEP, time + STEP)
                self.say(
                    "seat" if wanted else "empty seat",
                    ("1" if wanted else "0") in found,
                    f"{sensor} {found} at {time:.1f}: {on}",
                )
                if wanted:
                    kg = sum(self.flat.people[person]["kg"] for person in on if on[person])
                    weight = float(self.record.states[f"{sensor}.weight"].at(time))
                    self.say("seat", abs(weight - kg) <= 0.51, f"{sensor} weighs {weight} at {time:.1f}, not {kg}")

    def floors(self):
        """Cells of a floor add up to its weight, and that is of the people and robots on it."""
        for reading in self.heard.floors:
            floor, time = self.flat.floors[reading.sensor], reading.time
            total = sum(reading.cells.values())
            self.say(
                "cells",
                abs(total - reading.weight * GRAVITY) <= 0.06 * len(reading.cells) + 0.06,
                f"{reading.sensor} at {time}: {total} N",
            )
            state = self.record.states[f"{reading.sensor}.weight"].within(time - STEP, time + STEP)
            self.say(
                "weight",
                str(round(reading.weight)) in state or abs(reading.weight % 1 - 0.5) < 0.02,
                f"{reading.sensor} {state} at {time}: {reading.weight}",
            )
            low = high = 0.0
            movers = {**self.flat.people, **self.flat.robots}
            for name, of in movers.items():
                x, y = self.record.pose(name, time)[:2]
                posture = self.posture(name, time) if name in self.flat.people else "stand"
                reach = 0.45 if posture == "stand" else 0.3 if posture == "sit" else of["height"]
                edge = min(floor.length / 2 - abs(x - floor.x), floor.width / 2 - abs(y - floor.y))
                if edge < -reach:
                    continue
                high += of["kg"]
                away = [self.on_seat(name, self.flat.things[thing], time) for thing in self.flat.seats.values()] if name in self.flat.people else []
                if edge > reach and not any(on is not False for on in away):
                    low += of["kg"]
                elif any(on is True for on in away):
                    high -= of["kg"]
            spare = 0.05 if floor.threshold == 0 else 0.05 + 5 * 40 / GRAVITY
            self.say(
                "floor",
                low - spare <= reading.weight <= high + 0.05,
                f"{reading.sensor} weighs {reading.weight} at {time}, not {low} to {high}",
            )
            if low == high > 0:
                self.looked["floor exactly"] += 1

    # -- things with power --

    def uses(self, name):
        """The times at which people use an appliance, empty where that is not sure."""
        uses = []
        for person, deeds in self.deeds.items():
            for begin, end, words, done in deeds:
                if words[0] != "uses" or words[1] != name:
                    continue
                if not done:
                    return None
                uses.append((end - float(words[2].rstrip("s")), end))
        return sorted(uses)

    def power(self):
        """Appliances take the power of their catalogue while people use them, plugs measure it, and meters its integral."""
        ends = {}
        for name, kind in self.flat.appliances.items():
            (start, hold, standby), (start_for, hold_for), goes_on = APPLIANCES[kind]
            plug = next((plug for plug, of in self.flat.plugs.items() if of == name), None)
            cut = next((when for when, who, state, _ in self.flat.acts if who == plug and state == "on"), math.inf)
            ends[name] = cut
            uses = self.uses(name)
            first = self.heard.before.get(f"{name}.on") == "1"
            if uses is None:
                continue
            phases = [(0.0, 0.0 if first else None)]
            if goes_on:
                on_until = -1.0
                for begin, _ in uses:
                    if first or begin < on_until:
                        continue
                    phases.append((begin, begin))
                    if hold_for and start_for + hold_for < SECONDS:
                        on_until = begin + start_for + hold_for
                        phases.append((on_until, None))
                    else:
                        on_until = math.inf
            else:
                if any(0 <= begin - end < SLACK for begin, _ in uses for _, end in uses):
                    continue  # from hand to hand: it may stay on
                events = sorted([(b, 1) for b, _ in uses] + [(e, -1) for _, e in uses])
                users, since = 0, None
                for time, step in events:
                    users += step
                    if users == 1 and step > 0 and since is None:
                        since = time
                        phases.append((time, since))
                    if users == 0:
                        since = None
                        phases.append((time, None))
            for step in range(4, round(SECONDS / STEP), 11):
                time = step * STEP
                if abs(time - cut) < SLACK or any(abs(time - t) < SLACK for t, _ in phases):
                    continue
                since = [s for t, s in phases if t <= time][-1]
                if time > cut:
                    watts = 0.0
                elif since is None:
                    watts = standby
                elif abs(time - since - start_for) < SLACK:
                    continue
                else:
                    watts = start if time - since < start_for else hold
                found = self.record.states[f"{name}.power"].at(time)
                self.say(
                    "power",
                    found is not None and float(found) == watts,
                    f"{name} takes {found} W at {time:.1f}, not {watts}: on {uses}, cut at {cut}",
                )
        for reading in self.heard.meters:
            own, of = self.record.states[f"{reading.plug}.power"], self.record.states[f"{self.flat.plugs[reading.plug]}.power"]
            integral = 0.0
            for step in range(round(SECONDS / STEP)):
                integral += float(of.at(step * STEP + STEP / 2)) * STEP / 3.6e6
            most = max(float(value) for value in of.values if value is not None)
            self.say(
                "meter",
                abs(integral - reading.energy) <= 3 * STEP * most / 3.6e6 + 2e-6,
                f"{reading.plug} has {reading.energy} kWh, not {integral}",
            )
            counted = float(self.record.states[f"{reading.plug}.energy"].at(SECONDS))
            self.say(
                "meter",
                abs(counted - reading.energy) <= 0.001 + 1e-6,
                f"{reading.plug} shows {counted} kWh of {reading.energy}",
            )
            for time, value in own.changes():
                self.say(
                    "plug",
                    value in of.within(time - SLACK, time + STEP),
                    f"{reading.plug} measures {value} W at {time}",
                )

    # -- contents in the air --

    def volumes(self):
        """Hands touch a volume while they are in it, by where the person is."""
        inside = collections.defaultdict(list)  # volume -> (time, distance from its surface, tag)
        heard = collections.defaultdict(list)
        for tag, (person, offset) in self.flat.hands.items():
            for reading in self.record.readings[tag]:
                time = reading["t"]
                if reading.get("position") is None:
                    continue
                place = reading["position"]
                if self.record.states[f"{person}.posture"].within(time - 2 * STEP, time + 2 * STEP) <= {"stand", None}:
                    x, y, heading, _ = self.record.pose(person, time)
                    c, s = math.cos(heading), math.sin(heading)
                    true = (x + c * offset[0] - s * offset[1], y + s * offset[0] + c * offset[1], offset[2])
                    self.say(
                        "hand",
                        math.dist(true, reading["pose"][:3]) < 1e-3,
                        f"{tag} at {time}: {reading['pose'][:3]}, not {true}",
                    )
                    self.say(
                        "heard",
                        math.dist(true, place) < 0.02,
                        f"{tag} is heard at {place} at {time}, not at {true}",
                    )
                heard[tag].append((time, place))
        for load in self.flat.loads:
            for reading in self.record.readings[f"on-{load}"]:
                if reading.get("position") is not None:
                    heard[f"on-{load}"].append((reading["t"], reading["position"]))
        for name, (middle, size) in self.flat.volumes.items():
            reach = 0.01 + (max(size) if isinstance(size, tuple) else size)
            for tag, places in heard.items():
                if all(math.dist(place, middle) > reach for _, place in places):
                    continue
                for time, place in places:
                    away = [abs(a - b) for a, b in zip(place, middle)]
                    if isinstance(size, tuple):
                        off = max(a - b / 2 for a, b in zip(away, size))
                    else:
                        off = math.hypot(*away) - size
                    inside[name].append((time, off, tag))
        for name in self.flat.volumes:
            touched = self.record.states[f"{name}.touched"]
            times = collections.defaultdict(list)
            for time, off, tag in inside[name]:
                times[tag].append((time, off))
            for step in range(5, round(SECONDS / STEP), 3):
                time = step * STEP
                surely, maybe = False, False
                for tag, readings in times.items():
                    at = bisect.bisect_right(readings, (time + 1e-6, math.inf))
                    now = [(t, off) for t, off in readings[max(0, at - 6):at] if time - t < 0.3 + 2 * STEP]
                    surely = surely or any(off < -0.005 and STEP / 2 < time - t < 0.3 - STEP / 2 for t, off in now)
                    maybe = maybe or any(off < 0.005 for _, off in now)
                found = touched.at(time) in ("1", "yes")
                if surely or not maybe:
                    self.say(
                        "touched" if surely else "untouched",
                        found == surely,
                        f"{name} {touched.at(time)} at {time:.1f}",
                    )

    # -- robots --

    def robots(self):
        for robot in self.flat.robots:
            for time, pan, lasts in self.heard.turns:
                if any(who == "neck" and time - 3 * STEP < when < time + lasts + 1 for when, who, *_ in self.flat.acts) or time + lasts + 1 > SECONDS:
                    continue
                before, after = (float(self.record.states["neck.pan"].at(t) or 0) for t in (time, time + lasts + SLACK))
                self.say("head", abs(after - pan) < 0.01, f"neck at {after} after a turn to {pan} at {time}")
                self.say(
                    "head",
                    abs(abs(pan - before) / 60 - lasts) < 0.11,
                    f"neck takes {lasts} from {before} to {pan}",
                )
            for time, name, received in self.heard.sent:
                other = "rover" if name == "base" else "base"
                sender, receiver = (self.radio_at(who, time - STEP) for who in (name, other))
                away = math.dist(sender, receiver)
                lines = [crosses(sender, receiver, wall) for wall in self.flat.walls]
                near = [self.off(sender, receiver, (door["x"] + d, door["y"])) for door in self.flat.doors.values() for d in (-0.45, 0, 0.45)]
                met = sorted(self.share(sender, receiver, wall) * away for wall, is_met in zip(self.flat.walls, lines) if is_met)
                # Surfaces within half a metre of the way are those of one thick wall.
                if any(b - a < 0.6 for a, b in zip(met, met[1:])):
                    continue
                margin = 20 * math.log10(self.flat.radios[name]["range"] / away) - 6 * sum(lines)
                if abs(margin) < 0.5 or min(near) < 0.6:
                    continue
                self.say(
                    "radio",
                    received == (margin > 0),
                    f"{other} hears {received} of {name} at {time}, margin {margin:.2f}",
                )
            for bumper, (of, stiffness) in self.flat.bumpers.items():
                for time, value in self.record.states[f"{bumper}.force"].changes():
                    if float(value) == 0:
                        continue
                    x, y = self.record.pose(of, time)[:2]
                    kg = self.flat.robots[of]["kg"]
                    self.say("bumper", float(value) <= 2.2 * math.sqrt(stiffness * kg), f"{bumper} {value} N at {time}")
                    walls = [abs(y), abs(y - 1.8), abs(x), abs(x - self.flat.length)]
                    others = [math.dist((x, y), self.record.pose(person, time)[:2]) for person in self.flat.people]
                    loads = [
                        math.dist((x, y), reading["pose"][:2])  # of one that lies on the floor
                        for load in self.flat.loads
                        for reading in self.record.readings[f"on-{load}"]
                        if abs(reading["t"] - time) < SLACK and reading["pose"][2] < 0.3
                    ]
                    lying = any(self.posture(p, time) != "stand" and away < 2 for p, away in zip(self.flat.people, others))
                    self.say(
                        "bumper",
                        min(walls) < 0.3 or min(others) < 0.6 or lying or min(loads, default=1) < 0.4,
                        f"{bumper} {value} N at {time} in free air",
                    )
        for when, who, state, value in self.flat.acts:
            later = [t for t, w, s, _ in self.flat.acts if (w, s) == (who, state) and when < t <= when + SLACK]
            turned = who == "neck" and any(when - 6 < t <= when + SLACK for t, *_ in self.heard.turns)
            if later or turned:
                continue
            found = self.record.states[f"{who}.{state}"].within(when, when + SLACK)
            wanted = {"yes": "1", "no": "0"}.get(value, str(value))
            self.say("script", wanted in found, f"{who}.{state} is {found} at {when}, not {wanted}")

    def radio_at(self, name, time):
        of = self.flat.radios[name]
        if "at" in of:
            return of["at"]
        x, y = self.record.pose(of["on"], time)[:2]
        return (x, y, 0.4)

    @staticmethod
    def share(a, b, wall):
        """Where a line meets a wall, as a share of its length."""
        (x1, y1), (x2, y2) = wall
        nx, ny = y2 - y1, x1 - x2
        return ((x1 - a[0]) * nx + (y1 - a[1]) * ny) / ((b[0] - a[0]) * nx + (b[1] - a[1]) * ny)

    @staticmethod
    def off(a, b, p):
        """Distance of a point from a line, on the floor."""
        length = math.hypot(b[0] - a[0], b[1] - a[1])
        share = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length**2 if length else 0
        share = min(1, max(0, share))
        return math.hypot(p[0] - a[0] - share * (b[0] - a[0]), p[1] - a[1] - share * (b[1] - a[1]))

    def ends(self):
        """What programs are told at the end is what the record has last."""
        for key, value in self.heard.after.items():
            self.say(
                "end",
                self.record.states[key].at(SECONDS) == value,
                f"{key} is {value} at the end, and {self.record.states[key].at(SECONDS)} in states.csv",
            )


def check(flat, folder, heard):
    """Returns the labels that are false, and how many were looked at, by kind."""
    judge = Judge(flat, Record(folder, heard.before), heard)
    for look in (judge.postures, judge.pointing, judge.walls, judge.locks, judge.loads, judge.tags, judge.seats, judge.floors,
                 judge.power, judge.volumes, judge.robots, judge.ends):
        look()
    return judge.false, judge.looked
