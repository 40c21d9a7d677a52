# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of layouts, rooms, buildings and options through the tools: a row for each kind of record or option, a command
for each way to read it. A row is a function of a count that returns the records of a room, those of a layout,
words to add to the command, and where it has them further files by name.
"""
import math

# Things beside each other meet: each adds a part that others share. A list may take a little more than its share.
STEEPEST = 1.3
# A list of 32 kB is some 1000 records: more than a building has sensors.
SMALLEST, MOST_BYTES, LONG_BYTES = 2_000, 32_000, 256_000
WIDTH, DEPTH = 40.0, 30.0
CAMERA, TABLE = "camera at={x},{y},2.4 tilt=-40 range=6 pixels=64,48", "table at={x},{y} size=0.3,0.3"
LASERS = "laser at=-3,-3 range=8\nlaser at=4,4 heading=90 range=8\n"


def spread(count):
    """Points in rows across the floor, apart from its walls."""
    columns = max(1, math.ceil(math.sqrt(count * WIDTH / DEPTH)))
    rows = max(1, math.ceil(count / columns))
    for i in range(count):
        yield (round(-WIDTH / 2 + WIDTH * (i % columns + 0.5) / columns, 3),
               round(-DEPTH / 2 + DEPTH * (i // columns + 0.5) / rows, 3))


def records(text, count):
    return "".join(text.format(x=x, y=y, right=round(x + 0.1, 3), above=round(y + 0.1, 3), i=i) + "\n"
                   for i, (x, y) in enumerate(spread(count)))


def each(text):
    """A row of records alike in a layout: text with the place and the number of each."""
    return lambda count: ("", records(text, count), [])


def of_room(text, layout=LASERS):
    """The same in the room, with two lasers."""
    return lambda count: (records(text, count), layout, [])


def heard(sensor, tag):
    """Every second record a receiver, the others what it hears."""
    def row(count):
        places = enumerate(spread(count))
        return "", "".join((tag if i % 2 else sensor).format(x=x, y=y, i=i) + "\n" for i, (x, y) in places), []
    return row


def watched(count):
    """Cameras and tables side by side, on a floor that grows with them: each sees the same number."""
    wide = math.sqrt(7 * count)  # 14 m2 for a camera and a table
    places = [(round(x * wide / WIDTH, 3), round(y * wide / DEPTH, 3)) for x, y in spread(count)]
    return (f"ispace size={wide:.3f},{wide:.3f}\n", "".join((TABLE if i % 2 else CAMERA).format(x=x, y=y) + "\n"
                                                          for i, (x, y) in enumerate(places)), [])


def crowded(count):
    """The same on one floor: each camera sees more and more, up to the work that exact areas may take."""
    return *heard(CAMERA, TABLE)(count)[:2], ["--max-work", "40000"]


def zoned(row):
    """The same in a zone around all."""
    return lambda count: ("zone id=all at=0,0 size=39,29\n", *row(count)[1:])


def star(count):
    """Walls from one point."""
    turns = [2.399963 * i for i in range(count)]
    return ("".join(f"wall from=0,0 to={14 * math.cos(t):.3f},{14 * math.sin(t):.3f}\n" for t in turns),
            "laser at=-17,-12 range=8\n", [])


def star_with(*words):
    """The same for these options."""
    return lambda count: (*star(count)[:2], list(words))


def of_options(word, text):
    """Options of a command, one for each zone of the room."""
    def row(count):
        zones = records("zone id=z{i} at={x},{y} size=0.2,0.2", count)
        return zones, LASERS, [part for i in range(count) for part in (word, text.format(i=i))]
    return row


def storeys(count):
    """A building of a room again and again, with a flight of stairs from each to the next."""
    floors = [f"storey id=s{i} file=floor.env z={3 * i} height=3\n" for i in range(count)]
    flights = [f"stairs id=t{i} storeys=s{i},s{i + 1} at=3,1 heading=0 size=1.2,4\n" for i in range(len(floors) - 1)]
    return "".join(floors + flights), "laser id=s0/a at=0,0,0.2 range=8\nlaser id=s1/a at=1,1,0.2 range=8\n", []


def lifts(count):
    """Lifts of two storeys."""
    return ("storey id=s0 file=floor.env height=3\nstorey id=s1 file=floor.env z=3 height=3\n" +
            records("lift id=l{i} storeys=s0,s1 at={x},{y} size=0.4,0.4 door=0.3", count),
            "laser id=s0/a at=0,0,0.2 range=8\nlaser id=s1/a at=1,1,0.2 range=8\n", [])


def stairs(count):
    """Flights of two storeys."""
    return ("storey id=s0 file=floor.env height=3\nstorey id=s1 file=floor.env z=3 height=3\n" +
            records("stairs storeys=s0,s1 at={x},{y} heading=0 size=0.2,0.4", count),
            "laser id=s0/a at=0,0,0.2 range=8\nlaser id=s1/a at=1,1,0.2 range=8\n", [])


def shafts(count):
    """Openings between two storeys."""
    return ("storey id=s0 file=floor.env height=3\nstorey id=s1 file=floor.env z=3 height=3\n" +
            records("shaft storeys=s0,s1 path={x},{y};{right},{y};{right},{above}", count),
            "laser id=s0/a at=0,0,0.2 range=8\nlaser id=s1/a at=1,1,0.2 range=8\n", [])


def of_one_wall(text):
    """Openings in one long wall."""
    return lambda count: ("wall id=w from=-19,0 to=19,0\n" + "".join(
        text.format(offset=round(0.3 + 37.4 * (i + 0.5) / count, 3), size=round(10 / count, 4)) + "\n" for i in range(count)),
                          LASERS, [])


def path(count):
    """A person with a long way."""
    return "", LASERS + "human id=h at=-19,-14 path=" + ";".join(f"{x},{y}" for x, y in spread(count)) + "\n", []


def mounted(count):
    """Sensors on one robot."""
    return "", LASERS + "robot id=r at=5,5\n" + "laser on=r at=0,0,0.2 range=3\n" * count, []


def pending(count):
    """Sensors that are to be placed."""
    return "", "laser model=urg-04lx\n" * count, []


def recorded(movers, moments=3, tracks=0):
    """A record of people side by side, and as many moments of tracks near them."""
    people = ["t,id,x,y,heading_deg,speed,rotspeed_deg,phase,sidespeed,stall"]
    told = ["t,track,x,y,kind"]
    for k in range(moments):
        for i, (x, y) in enumerate(spread(movers)):
            people.append(f"{0.1 * k:g},h{i},{x + 0.01 * k:.3f},{y},0,0.1,0,0,0,0")
        for i, (x, y) in enumerate(spread(tracks)):
            told.append(f"{0.1 * k:g},t{i},{x + 0.02:.3f},{y},person")
    files = {"run/people.csv": "\n".join([*people, ""]), "run/scene.env": f"#env 1\nispace size={WIDTH:g},{DEPTH:g}\n",
             "run/robots.csv": "t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall\n"}
    return {**files, "tracks.csv": "\n".join([*told, ""])} if tracks else files


def of_people(count):
    return LASERS + "".join(f"human id=h{i} at={x},{y} height=0.6\n" for i, (x, y) in enumerate(spread(count)))


def run_of(count):
    """A record of people."""
    return "", of_people(count), ["--run", "{folder}/run"], recorded(count)


def long_run(count):
    """A record of ten people for a long time."""
    return "", of_people(10), ["--run", "{folder}/run"], recorded(10, count)


def judged(count):
    """Tracks of many people at once."""
    return "", LASERS, ["--run", "{folder}/run", "--tracks", "{folder}/tracks.csv"], recorded(count, 3, count)


def judged_at_length(count):
    """Tracks of ten people for a long time."""
    return "", LASERS, ["--run", "{folder}/run", "--tracks", "{folder}/tracks.csv"], recorded(10, count, 10)


def judged_false(count):
    """Tracks of nobody beside ten people, each told once."""
    files = recorded(10, 3)
    files["tracks.csv"] = "t,track,x,y,kind\n" + "".join(
        f"{0.1 * (i % 3):g},t{i},{x},{y},person\n" for i, (x, y) in enumerate(spread(count)))
    return "", LASERS, ["--run", "{folder}/run", "--tracks", "{folder}/tracks.csv"], files


def nodes(count):
    """Nodes with a laser each."""
    places = list(enumerate(spread(count)))
    return "", ("".join(f"laser id=l{i} at={x},{y} range=3\n" for i, (x, y) in places) +
                "".join(f"node id=n{i} sensors=l{i} delay=20ms,5ms loss=1%\n" for i, _ in places)), []


def wide_node(count):
    """A node with many lasers."""
    places = list(enumerate(spread(count)))
    return "", ("".join(f"laser id=l{i} at={x},{y} range=3\n" for i, (x, y) in places) +
                "node id=n sensors=" + ",".join(f"l{i}" for i, _ in places) + "\n"), []


ROWS = {
    "walls": of_room("wall from={x},{y} to={x},{above}"),
    "star": star,
    "star_crowds": star_with("--crowd", "20"),
    "things": of_room("cube at={x},{y} size=0.2"),
    "zones": of_room("zone id=z{i} at={x},{y} size=0.2,0.2"),
    "doors": of_room("wall id=w{i} from={x},{y} to={right},{y}\ndoor wall=w{i} offset=0.02 size=0.04"),
    "lamps": of_room("lamp at={x},{y}"),
    "lux": heard("lux at={x},{y},1", "lamp at={x},{y}"),
    "lasers": each("laser at={x},{y} range=3"),
    "far_lasers": each("laser at={x},{y} heading={i} range=30"),
    "rangers": each("ranger at={x},{y},1 tilt=-30 range=3"),
    "cameras": each("camera at={x},{y},2.4 tilt=-40 range=4 pixels=64,48"),
    "ultrasound": heard("ultrasound at={x},{y},2.4 range=6", "tag at={x},{y},1"),
    "uwb": heard("uwb at={x},{y},2", "cube at={x},{y} size=0.1 tag=T{i}"),
    "near_uwb": heard("uwb at={x},{y},2 range=4", "cube at={x},{y} size=0.1 tag=T{i}"),
    "rfid": heard("rfid at={x},{y},1", "cube at={x},{y} size=0.1 tag=T{i}"),
    "motes": each("mote at={x},{y},1"),
    "pir": each("pir at={x},{y},2.2"),
    "radars": each("radar at={x},{y},1.5"),
    "microphones": heard("microphone at={x},{y},1", "speaker at={x},{y}"),
    "thermometers": zoned(heard("thermometer at={x},{y},1", "heater at={x},{y}")),
    "people": each("human at={x},{y} height=0.6"),  # side by side in long lists, too
    "robots": each("robot at={x},{y} radius=0.05"),
    "storeys": storeys,
    "lifts": lifts,
    "stairs": stairs,
    "shafts": shafts,
    "wall_doors": of_one_wall("door wall=w offset={offset} size={size}"),
    "wall_windows": of_one_wall("window wall=w offset={offset} size={size}"),
    "pillars": of_room("pillar at={x},{y} size=0.2,0.2"),
    "cylinders": of_room("cylinder at={x},{y} size=0.2,0.2,1"),
    "mats": each("mat at={x},{y} size=0.2,0.2"),
    "gates": each("gate at={x},{y} width=0.2"),
    "tags": each("tag at={x},{y},1"),
    "path": path,
    "walkers": each("human at={x},{y} height=0.6 walk=wander"),
    "mounted": mounted,
    "sweeping": each("laser at={x},{y},1 range=3 sweep=tilt sweep_span=40 sweep_step=10"),
    "worn_tags": heard("uwb at={x},{y},2", "human at={x},{y} height=0.6 tag=T{i}"),
    "read_tags": heard("rfid at={x},{y},1", "human at={x},{y} height=0.6 tag=T{i}"),
    "furnished": heard("laser at={x},{y} range=6", "cube at={x},{y} size=0.3"),
    "watched": watched,
    "crowded": crowded,
    "pir_people": heard("pir at={x},{y},2.2", "human at={x},{y} height=0.6"),
    "pending": pending,
    "nodes": nodes,
    "wide_node": wide_node,
    "run": run_of,
    "long_run": long_run,
    "judged": judged,
    "judged_at_length": judged_at_length,
    "judged_false": judged_false,
    "requirements": of_options("--require", "zone:z{i}=1%"),
    "privacy": of_options("--privacy", "z{i}"),
    "rules": of_options("--keep-out", "z{i}"),
    "weights": of_options("--weight", "z{i}=2"),
}
WITH_FLOOR = ("storeys", "lifts", "stairs", "shafts", "watched")  # rooms that state their own
# Rows of options go to the command that has them.
ONLY = {"requirements": ("coverage", "suggest"), "privacy": ("coverage", "arrange"), "rules": ("arrange",),
        "weights": ("arrange",), "star_crowds": ("arrange",), "pending": ("place",),
        "run": ("coverage",), "long_run": ("coverage",), "judged": ("coverage",), "judged_at_length": ("coverage",),
        "judged_false": ("coverage",), "crowded": ("coverage", "suggest", "report")}

# Words of the command; {room} and {layout} are the files, {out} is a file to write.
COMMANDS = {
    "coverage": ["coverage", "{room}", "{layout}"],
    "suggest": ["coverage", "{room}", "{layout}", "--suggest", "3", "--time-limit", "2s"],
    "report": ["coverage", "{room}", "{layout}", "--report", "{out}.html"],
    "arrange": ["arrange", "{room}", "--sensor", "laser,range=8:1", "--strategy", "grid", "--optimize", "greedy", "-o",
                "{out}.3dm"],
    "place": ["arrange", "{room}", "{layout}", "--strategy", "grid", "--optimize", "greedy", "-o", "{out}.3dm"],
    "scan": ["scan", "{room}", "{layout}", "-o", "{out}.jsonl"],
    "simrun": ["simrun", "{room}", "{layout}", "--clock", "fast", "--until", "1"],
    "check": ["envc", "--check", "{room}", "{layout}"],
}
NOT_SCANNED = ("people", "robots", "walkers", "mats", "gates", "tags")  # without a sensor there is nothing to scan
EVERYWHERE = [way for way in COMMANDS if way != "place"]
FAMILIES = {f"{way}_of_{row}": (row, way) for row in ROWS for way in COMMANDS
            if way in ONLY.get(row, EVERYWHERE) and not (way == "scan" and row in NOT_SCANNED)}


# Pages of long layouts, whose memory has a separate bound: bytes of the layout, and of the memory.
LONG_PAGES, MOST_MEMORY = 92_000, 300e6
PAGES = ("report_of_lasers", "report_of_pir", "report_of_radars", "report_of_cameras", "report_of_rangers",
         "report_of_uwb")


def steepest(family):
    del family
    return STEEPEST


def memory_bound(family):
    """(bytes of the input, bytes of the memory), or None."""
    return (LONG_PAGES, MOST_MEMORY) if family in PAGES else None


def is_refused(family):
    """Each list is short and right: all tools accept it."""
    del family
    return False


def files(family, size):
    """The files of a family at a size in bytes, the operand first."""
    row, _ = FAMILIES[family]
    each_of = 100
    room, layout, words, *more = ROWS[row](each_of)
    bytes_ = len(room + layout + " ".join(words) + "".join(text for files in more for text in files.values()))
    room, layout, words, *more = ROWS[row](max(1, size * each_of // bytes_))
    floor = f"#env 1\nispace size={WIDTH:g},{DEPTH:g}\n"
    named = {"floor.env": floor, "layout.3dm": "#3dm 1\n" + layout, "words": "\n".join(words),
             **{name: text for files in more for name, text in files.items()}}
    return {"room.env": "#env 1\n" + room if row in WITH_FLOOR else floor + room, **named}


def command(tools, family, operand):
    """The command that reads such a file; tools is their folder."""
    folder = operand.rsplit("/", 1)[0]
    tool, *words = COMMANDS[FAMILIES[family][1]]
    with open(f"{folder}/words", encoding="utf-8") as more:
        words = [*words, *more.read().split()]
    return [f"{tools}/{tool}", *(word.format(room=operand, layout=f"{folder}/layout.3dm", out=f"{folder}/out", folder=folder)
                                 for word in words)]
