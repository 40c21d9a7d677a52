# SPDX-License-Identifier: GPL-3.0-or-later
"""Random flats in which people live a few minutes: rooms, doors with locks, curtains, appliances with plugs, floors, beds and
chairs that feel, volumes, robots with heads, LEDs, bumpers and radios, a projector, and a script of what people do."""

import math
import random

HALL = 1.8  # width of the hall, along x between the rooms
SECONDS = 120.0
STEP = 0.1


class Rect:
    """A box seen from above, along the axes, and its top."""

    def __init__(self, x, y, length, width, top=0.0):
        self.x, self.y, self.length, self.width, self.top = x, y, length, width, top

    def distance(self, x, y):
        return math.hypot(max(0.0, abs(x - self.x) - self.length / 2), max(0.0, abs(y - self.y) - self.width / 2))

    def within(self, x, y, margin=1e-6):
        return abs(x - self.x) <= self.length / 2 + margin and abs(y - self.y) <= self.width / 2 + margin


def n(value):
    """A number of a record, in whole millimetres."""
    return f"{round(value, 3) + 0.0:g}"


class Flat:
    """What is in a flat, as its records say it, and its texts."""

    def __init__(self, seed):
        self.seed = seed
        self.random = random.Random(seed)
        self.env, self.layout, self.script = ["#env 1"], ["#3dm 1", "environment file=flat.env"], []
        self.walls = []  # ((x, y), (x, y))
        self.doors = {}  # id -> dict(x, y, access, locked, open); all lie along x, 0.9 m wide
        self.zones, self.things = {}, {}  # id -> Rect
        self.seats = {}  # id of the sensor -> id of the thing
        self.chairs, self.beds, self.sofas = [], [], []
        self.people = {}  # id -> dict(height, kg, tag, postured)
        self.robots = {}  # id -> dict(radius, kg)
        self.loads = []  # things to carry
        self.appliances, self.plugs = {}, {}  # id -> kind; id -> appliance
        self.floors = {}  # id -> Rect, with threshold
        self.hands = {}  # ultrasonic tag -> (person, offset)
        self.volumes = {}  # id -> (point, radius or size)
        self.curtains, self.lights = [], []
        self.radios = {}  # id -> dict(at or on, range)
        self.heads, self.leds, self.bumpers, self.projectors = {}, {}, {}, {}
        self.uwbs = {}  # id -> point
        self.acts = []  # (time, id, state, value) of the script
        self.make()

    def chance(self, share):
        return self.random.random() < share

    def between(self, low, high):
        return low + (high - low) * self.random.random()

    def pick(self, things):
        things = list(things)
        return things[int(self.random.random() * len(things))]

    # -- the room --

    def make(self):
        columns = 2 + int(self.chance(0.5))
        widths = [round(self.between(3.6, 4.6), 2) for _ in range(columns)]
        north, south = (round(self.between(3.6, 4.4), 2) for _ in range(2))
        length = sum(widths)
        self.length = length
        outline = [(0, -south), (length, -south), (length, HALL + north), (0, HALL + north)]
        path = ";".join(f"{n(x)},{n(y)}" for x, y in outline)
        self.env.append(f"fence id=outside path={path} closed=yes height=2.5")
        self.walls += [(outline[i], outline[(i + 1) % 4]) for i in range(4)]
        for name, y in (("south", 0.0), ("north", HALL)):
            self.env.append(f"fence id={name} path=0,{n(y)};{n(length)},{n(y)} height=2.5")
            self.walls.append(((0, y), (length, y)))
        self.env.append(f"inside at={n(length / 2)},{n(HALL / 2)}")
        self.zones["hall"] = Rect(length / 2, HALL / 2, length, HALL)
        self.env.append(f"zone id=hall at={n(length / 2)},{n(HALL / 2)} size={n(length)},{n(HALL)}")
        self.make_people()
        kinds = ["bedroom", "living", "kitchen", "study", "bedroom", "living"]
        if self.chance(0.5):
            kinds[:4] = ["kitchen", "bedroom", "study", "living"]
        x, rooms = 0.0, []
        for column, width in enumerate(widths):
            for side, depth in ((-1, south), (1, north)):
                if side < 0 and column > 0:
                    self.wall(f"s{column}", (x, -south), (x, 0))
                if side > 0 and column > 0:
                    self.wall(f"n{column}", (x, HALL), (x, HALL + north))
                rooms.append((x + width / 2, side, width, depth))
            x += width
        for number, room in enumerate(rooms):
            self.make_room(number, kinds[number], *room)
        if self.chance(0.6):
            self.make_robot()
        self.place_people()
        self.make_script()
        self.env += self.late

    def wall(self, name, a, b):
        self.env.append(f"fence id={name} path={n(a[0])},{n(a[1])};{n(b[0])},{n(b[1])} height=2.5")
        self.walls.append((a, b))

    def thing(self, name, record, x, y, length, width, top, extra=""):
        self.things[name] = Rect(x, y, length, width, top)
        self.env.append(f"{record} id={name} at={n(x)},{n(y)} size={n(length)},{n(width)},{n(top)}{extra}")

    def make_room(self, number, kind, middle, side, width, depth):
        """A room with its door in the wall to the hall; (u, v) from the middle of that wall into the room."""
        base = 0.0 if side < 0 else HALL

        def at(u, v):
            return round(middle + u, 3), round(base + side * v, 3)

        name = f"{kind}{number}"
        x, y = at(0, depth / 2)
        self.zones[name] = Rect(x, y, width, depth)
        self.env.append(f"inside at={n(x)},{n(y)}")
        self.env.append(f"zone id={name} at={n(x)},{n(y)} size={n(width)},{n(depth)} celsius=19")
        dx = round(middle + self.between(-0.5, 0.5), 2)
        door = {"x": dx, "y": base, "access": None, "locked": False, "open": self.chance(0.5)}
        keys = ""
        if self.chance(0.45):
            tags = [person["tag"] for person in self.people.values()]
            door["access"] = [tag for tag in tags if self.chance(0.6)] or tags[:1]
            door["locked"] = self.chance(0.8)
            door["open"] = False
            keys = f" access={','.join(door['access'])}" + (" locked=yes" if door["locked"] else "")
        elif door["open"]:
            keys = " open=yes"
        if kind == "kitchen":  # all may cook
            door.update(access=None, locked=False, open=True)
            keys = " open=yes"
        self.doors[f"d{number}"] = door
        self.env.append(f"door id=d{number} at={n(dx)},{n(base)}{keys}")
        if self.chance(0.5):
            self.make_floor(f"floor{number}", *at(0, depth / 2), width - 0.1, depth - 0.1)
        furnish = {"bedroom": self.bedroom, "living": self.living, "kitchen": self.kitchen, "study": self.study}[kind]
        furnish(number, at, side, width, depth)
        if self.chance(0.5):
            self.make_volumes(number, at, width, depth)
        if self.chance(0.4):
            ux, uy = at(-width / 2 + 0.1, depth - 0.1)
            self.uwbs[f"u{number}"] = (ux, uy, 2.3)
            self.layout.append(f"uwb id=u{number} at={n(ux)},{n(uy)},2.3 rate=2")

    def make_floor(self, name, x, y, length, width):
        self.floors[name] = Rect(x, y, length, width)
        self.floors[name].threshold = threshold = 5 if self.chance(0.3) else 0
        cell = self.pick([0.2, 0.25, 0.5])
        self.layout.append(
            f"floor_sensor id={name} at={n(x)},{n(y)} size={n(length)},{n(width)} cell={cell} threshold={threshold}"
        )

    def seat(self, thing):
        if self.chance(0.8):
            self.seats[f"{thing}-seat"] = thing
            self.layout.append(f"seat_sensor id={thing}-seat of={thing}")

    def appliance(self, name, kind, x, y, extra=""):
        self.appliances[name] = kind
        self.layout.append(f"appliance id={name} kind={kind} at={n(x)},{n(y)}{extra}")
        if self.chance(0.8):
            self.plugs[f"{name}-plug"] = name
            self.layout.append(f"plug id={name}-plug of={name} count=0.001")

    def bedroom(self, number, at, side, width, depth):
        top, wide = round(self.between(0.4, 0.6), 2), 1.0
        self.thing(f"bed{number}", "cube", *at(-width / 2 + 1.1, depth - 0.6), 2.0, wide, top)
        self.beds.append(f"bed{number}")
        self.seat(f"bed{number}")
        self.lamp(number, *at(0, depth / 2))

    def living(self, number, at, side, width, depth):
        self.thing(f"sofa{number}", "cube", *at(-width / 2 + 1.1, depth - 0.5), 2.0, 0.8, round(self.between(0.38, 0.5), 2))
        self.sofas.append(f"sofa{number}")
        self.seat(f"sofa{number}")
        self.thing(f"board{number}", "cube", *at(width / 2 - 0.25, depth / 2), 0.4, 1.0, 0.5)
        self.appliance(f"tv{number}", "tv", *at(width / 2 - 0.25, depth / 2))
        cx, cy = at(0, depth - 0.04)
        if self.chance(0.6):
            self.env.append(f"curtain id=curtain{number} from={n(cx - 0.6)},{n(cy)} to={n(cx + 0.6)},{n(cy)}")
            self.curtains.append(f"curtain{number}")
        self.lamp(number, *at(0, depth / 2))

    def kitchen(self, number, at, side, width, depth):
        tx, ty = at(width / 2 - 0.9, depth - 0.6)
        self.thing(f"table{number}", "cube", tx, ty, 1.4, 0.7, 0.75)
        for i in range(1 + int(self.chance(0.6))):
            # Near the edge that one reaches.
            lx, ly = tx - 0.5 + 0.5 * i, ty - side * 0.2
            size, height = round(self.between(0.06, 0.16), 3), round(self.between(0.08, 0.2), 3)
            record = self.pick(["cylinder", "cube"])
            load = f"{'cup' if record == 'cylinder' else 'box'}{number}{i}"
            shape = f"size={n(size)},{n(size)} height={n(height)}" if record == "cylinder" else f"size={n(size)},{n(size)},{n(height)}"
            self.late.append(f"{record} id={load} at={n(lx)},{n(ly)},0.75 {shape} tag=t{load}")
            self.things[load] = Rect(lx, ly, size, size, 0.75)
            self.loads.append(load)
            self.layout.append(f"tag id=on-{load} on={load} at=0,0,0 rate=5")
        self.thing(f"counter{number}", "cube", *at(-width / 2 + 0.3, depth / 2), 0.5, 1.6, 0.9)
        self.appliance(f"kettle{number}", "kettle", *at(-width / 2 + 0.3, depth / 2))
        self.appliance(f"oven{number}", "oven", *at(-width / 2 + 0.3, depth / 2 + 0.6))
        self.appliance(f"fridge{number}", "fridge", *at(-width / 2 + 0.3, depth / 2 - 0.6), " on=yes" if self.chance(0.7) else "")

    def study(self, number, at, side, width, depth):
        cx, cy = at(self.between(-0.6, 0.2), depth - 1.1)
        heading = self.pick([0, 90, 180, -90])
        self.things[f"chair{number}"] = Rect(cx, cy, 0.45, 0.45, 0.45)
        self.env.append(f"chair id=chair{number} at={n(cx)},{n(cy)} heading={heading}")
        self.chairs.append(f"chair{number}")
        self.seat(f"chair{number}")
        self.thing(f"desk{number}", "cube", *at(width / 2 - 0.4, depth - 0.8), 0.7, 1.2, 0.74)
        self.appliance(f"display{number}", "display", *at(width / 2 - 0.4, depth - 0.8))
        self.appliance(f"light{number}", "plug_lamp", *at(width / 2 - 0.4, depth - 1.2))
        if self.chance(0.5):
            px, py = at(-width / 2 + 0.2, 0.3)
            self.layout.append(f"projector id=projector{number} at={n(px)},{n(py)} height=2.2 heading={45 * side}")
            self.projectors[f"projector{number}"] = None

    def lamp(self, number, x, y):
        self.env.append(f"lamp id=lamp{number} at={n(x)},{n(y)}")
        self.lights.append(f"lamp{number}")
        if self.chance(0.5):
            self.layout.append(f"lux id=lux{number} at={n(x + 0.3)},{n(y)},0.9 tilt=90 rate=1")

    def make_volumes(self, number, at, width, depth):
        """A ball and a box where people go, under receivers in the corners of the ceiling."""
        for i, (u, v) in enumerate(((-1, 0.2), (1, 0.2), (-1, 1), (1, 1))):
            rx, ry = at(u * (width / 2 - 0.15), v * depth - 0.15)
            height = 2.3 + 0.05 * (i % 3)
            self.layout.append(f"ultrasound id=e{number}{i} at={n(rx)},{n(ry)},{n(height)} tilt=-90 range=9 fov=170 rate=1")
        vx, vy = at(self.between(-0.6, 0.6), self.between(0.8, 1.6))
        radius = round(self.between(0.3, 0.6), 2)
        self.volumes[f"ball{number}"] = ((vx, vy, 1.2), radius)
        self.layout.append(f"volume id=ball{number} at={n(vx)},{n(vy)},1.2 radius={n(radius)} content=news")
        vx, vy = at(self.between(-0.6, 0.6), self.between(1.4, 2.2))
        size = (round(self.between(0.6, 1.2), 2), round(self.between(0.6, 1.2), 2), 1.0)
        self.volumes[f"box{number}"] = ((vx, vy, 1.2), size)
        self.layout.append(f"volume id=box{number} at={n(vx)},{n(vy)},1.2 size={','.join(map(n, size))} content=mail")

    # -- people and robots --

    def make_people(self):
        self.late = []
        for i in range(2 + int(self.random.random() * 3)):
            height = round(self.between(1.5, 1.95), 2)
            self.people[f"p{i}"] = {"height": height, "kg": 23 * height**2, "tag": str(40 + i), "postured": self.chance(0.4)}

    def place_people(self):
        for i, (name, person) in enumerate(self.people.items()):
            x, y = 0.5 + i * 0.8, HALL / 2 + (0.35 if i % 2 else -0.35)
            keys = f"height={person['height']} tag={person['tag']}"
            if person["postured"]:
                keys += " posture=stand"
            if self.chance(0.3):
                keys += f" prefers=light:{int(self.between(100, 500))};temp:{n(round(self.between(18, 23), 1))}"
            self.layout.append(f"human id={name} at={n(x)},{n(y)} heading={int(self.between(-180, 180))} {keys}")
            if self.chance(0.4):
                person["kg"] = round(self.between(40, 110), 1)
                self.layout.append(f"load id=load-{name} of={name} kg={n(person['kg'])}")
            if self.chance(0.7):
                offset = (round(self.between(0.1, 0.4), 2), round(self.between(-0.2, 0.2), 2), 1.2)
                self.hands[f"hand-{name}"] = (name, offset)
                self.layout.append(f"tag id=hand-{name} on={name} at={','.join(map(n, offset))} rate=10")

    def make_robot(self):
        x, y = self.length - 0.6, HALL / 2
        radius, kg = 0.2, round(self.between(5, 30), 1)
        self.robots["r0"] = {"radius": radius, "kg": kg}
        self.layout.append(f"robot id=r0 at={n(x)},{n(y)} heading=180 radius={radius} mass={n(kg)}")
        self.layout.append(f"load id=load-r0 of=r0 kg={n(kg)}")
        self.layout.append("head id=neck on=r0 at=0,0,0.4 pan_range=-170,170 tilt_range=-30,60 speed=60")
        self.layout.append("laser id=eye on=neck at=0,0,0.05 range=4 beams=9 rate=1")
        self.layout.append("led id=busy of=r0 at=0,0,0.3")
        stiffness = self.pick([5000, 20000])
        self.bumpers["b0"] = ("r0", stiffness)
        self.layout.append(f"bumper id=b0 of=r0 stiffness={stiffness}")
        self.radios["rover"] = {"on": "r0", "range": round(self.between(4, 12), 1)}
        self.layout.append(f"radio id=rover on=r0 at=0,0,0.4 range={n(self.radios['rover']['range'])}")
        zone = self.zones[self.pick(name for name in self.zones if name != "hall")]
        bx, by = round(zone.x, 2), round(zone.y, 2)
        self.radios["base"] = {"at": (bx, by, 2.0), "range": round(self.between(4, 12), 1)}
        self.layout.append(f"radio id=base at={n(bx)},{n(by)},2 range={n(self.radios['base']['range'])}")
        speed = round(self.between(0.2, 0.6), 2)
        for i in range(3):
            start = round(5 + 38 * i + self.between(0, 10), 1)
            self.script.append((start, f"{start} r0 SPEED {speed if i % 2 == 0 else -speed}"))
            stop = round(start + self.between(4, 20), 1)
            self.script.append((stop, f"{stop} r0 SPEED 0"))
            for name, state, value in (("neck", "pan", int(self.between(-170, 170))), ("busy", "on", self.pick(["yes", "no"]))):
                when = round(start + self.between(1, 30), 1)
                self.acts.append((when, name, state, value))

    def make_script(self):
        for projector in self.projectors:
            self.acts.append((round(self.between(1, 60), 1), projector, "pan", int(self.between(-60, 60))))
        for plug in self.plugs:
            if self.chance(0.15):
                when = round(self.between(50, 110), 1)
                self.acts.append((when, plug, "on", "no"))
        for when, name, state, value in self.acts:
            self.script.append((when, f"{when} {name} ACT {state}={value}"))
        self.script.sort()
        self.script = [line for _, line in self.script]
        for name in self.people:
            deeds = [self.deed(name) for _ in range(7)]
            self.script.append(f"at 00:00:{int(self.between(1, 8)):02} {name} {'; '.join(deeds)}")
            if self.chance(0.5):
                when = int(self.between(15, 95))
                self.script.append(f"at 00:{when // 60:02}:{when % 60:02} {name} falls")
                when += int(self.between(5, 12))
                self.script.append(f"at 00:{when // 60:02}:{when % 60:02} {name} stands")

    def deed(self, name):
        targets = [*self.zones, *self.appliances, *self.beds, *self.chairs, *[p for p in self.people if p != name]]
        choices = [
            (3, lambda: f"goes {self.pick(self.zones)}"),
            (4, lambda: f"uses {self.pick(self.appliances)} {int(self.between(3, 25))}s"),
            (1, lambda: f"points at {self.pick(targets)} {int(self.between(1, 4))}s"),
            (1, lambda: f"reaches {self.pick(self.appliances)} {int(self.between(1, 4))}s"),
            (1, lambda: f"stays {int(self.between(1, 6))}s"),
            (1, lambda: f"{self.pick(['opens', 'closes'])} {self.pick(self.doors)}"),
        ]
        seats = self.chairs + self.sofas + self.beds
        if seats:
            choices.append((4, lambda: f"sits on {self.pick(seats)} {int(self.between(4, 15))}s"))
        if self.beds + self.sofas:
            choices.append((3, lambda: f"lies on {self.pick(self.beds + self.sofas)} {int(self.between(4, 15))}s"))
        if self.loads:
            goals = [*self.zones, *(thing for thing in self.things if thing.startswith(("table", "board", "desk")))]
            choices.append((3, lambda: f"carries {self.pick(self.loads)} to {self.pick(goals)}"))
        if self.curtains:
            choices.append((1, lambda: f"{self.pick(['opens', 'closes'])} {self.pick(self.curtains)}"))
        locks = [door for door, of in self.doors.items() if of["access"]]
        if locks:
            choices.append((1, lambda: f"{self.pick(['locks', 'unlocks', 'locks', 'unlocks', 'forces'])} {self.pick(locks)}"))
        if self.lights:
            choices.append((1, lambda: f"switches {self.pick(self.lights)} {self.pick(['on', 'off'])}"))
        at = self.random.random() * sum(weight for weight, _ in choices)
        for weight, make in choices:
            at -= weight
            if at < 0:
                return make()
        return "stays 1s"

    def write(self, folder):
        for file, lines in (("flat.env", self.env), ("flat.3dm", self.layout), ("day.txt", self.script)):
            with open(f"{folder}/{file}", "w", encoding="utf-8") as out:
                out.write("\n".join(lines) + "\n")
