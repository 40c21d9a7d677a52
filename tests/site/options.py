# SPDX-License-Identifier: GPL-3.0-or-later
"""A row for each option of each tool: words with which a command of the tool runs on room.env.

A row that begins with ! stands alone; the others follow the tool's base command. An extension has the rows of its
options in lib/extensions/NAME/site_rows.py: OPTIONS and, where they need them, FILES and BEFORE as here.
"""
import pathlib
import runpy

from words import COARSE, Exempt, LASERS, MESH, OUT, PLAN, RECORD, RUN, SENSOR, TIMES

ROOM = """#env 1
ispace id=hall at=0,0 size=6,4 height=3 ceiling=yes
wall   id=part from=0.8,-2 to=0.8,0.4 height=2.2 thickness=0.1
door   id=entry wall=hall at=-3,1
door   id=exit wall=hall at=3,1.4 size=0.9
zone   id=desk_zone at=-1.8,-1 size=1.6,1.2
zone   id=far at=2,0 size=1.2,1.4
desk   id=desk at=-1.8,-1
cube   id=crate at=2,-1.2 size=0.5
lamp   id=lamp at=0,0
infra  id=bars at=0,1 size=3,1 height=2.6 rows=2 cols=3
floor_sensor id=feel at=-1.6,0.6 size=1,1 cell=0.25
"""
UPPER = "#env 1\nispace id=attic at=0,0 size=5,4 height=2.5 ceiling=yes\n"
LAYOUT = """#3dm 1
laser  id=l1 model=urg-04lx at=-2.7,-1.7 heading=45
laser  id=l2 model=urg-04lx at=2.7,1.7 heading=-135
camera id=c1 pixels=160,120 fov=90 range=8 at=-2.8,1.8,2.6 heading=-40 tilt=-30
pir    id=p1 at=2.8,1.8,2.3 heading=-135
robot  id=r1 model=pioneer-2dx at=-0.5,0.9 heading=0
laser  id=on_robot model=urg-04lx on=r1 at=0.1,0,0.2
human  id=ann at=-2,1.5 path=-2,1.5;2,1.4;-0.4,1.6 speed=0.8
"""


FILES = {
    "lay.3dm": LAYOUT,
    "fixed.3dm": "".join(line for line in LAYOUT.splitlines(True) if "r1" not in line),
    "other.3dm": LAYOUT.replace("heading=45", "heading=80"),
    "places.csv": "-2,0,0\n0,1,90\n2.5,-1,180\n1.5,1.5,200\n",
    "poses.tum": "0 -1 0.6 0 0 0 0 1\n0.5 -0.5 0.6 0 0 0 0.1 0.995\n1 0 0.6 0 0 0 0.2 0.98\n",
    "list": "room.env lay.3dm\nroom.env other.3dm\n",
    "arranged": "room.env\n",
    "drive.txt": "0 r1 FORWARD 0.3\n1 r1 STOP\n",
    "other.env": ROOM.replace("id=crate at=2,-1.2", "id=crate at=1.6,-1.4"),
}

BASES = {
    "envc": "room.env",
    "arrange": f"room.env {COARSE} --optimize greedy",
    "scan": "room.env lay.3dm",
    "coverage": "room.env lay.3dm --cell 0.2",
    "simrun": RUN,
}
BEFORE = {
    ("arrange", "--fixed"): "",
    ("arrange", "--merge"): f"arrange room.env {COARSE} --sensor laser:2 --optimize greedy --shard 1/2 -o a.part"
    f" && arrange room.env {COARSE} --sensor laser:2 --optimize greedy --shard 2/2 -o b.part",
    ("scan", "--merge"): "scan room.env lay.3dm --select l* --frames 4 --shard 1/2 --to jsonl -o a.part"
    " && scan room.env lay.3dm --select l* --frames 4 --shard 2/2 --to jsonl -o b.part",
    ("scan", "--run"): f"simrun {RUN} --record rec --record-frames 1",
    ("coverage", "--trace"): f"arrange room.env {COARSE} --sensor laser:1 --trace trace.csv -o out.3dm",
    ("simrun", "--replay"): RECORD,
    ("simrun", "--from"): RECORD,
    ("simrun", "--hold"): RECORD,
    ("simrun", "-MD"): RECORD,
    ("simrun", "-MF"): RECORD,
    ("simrun", "-o"): RECORD,
    ("simrun", "--output"): RECORD,
}
# A building of one storey keeps what it says of its storey: envc does not make these of it.
KEPT = {("envc", "--info"), ("envc", "--json"), ("envc", "--width"), ("envc", "--report")}
# Files that hold the command, the digest of what was read, or the time that it took.
OWN = {"out.part", "known", "timing.csv"}
# Exit status that is not 0: requirements that are not met.
STATUS = {("coverage", "--require"): 3, ("coverage", "--junit"): 3}

COMMON = {
    "-h": "!-h",
    "--help": "!--help",
    "-V": "!-V",
    "--version": "!--version",
    "-v": TIMES,
    "--verbose": TIMES,
    "--progress": TIMES,
    "--storey": Exempt("is what the forms of the room differ in"),
}
CHOICES = {
    "-q": "-q",
    "--quiet": "--quiet",
    "--no-progress": "--no-progress",
    "--unconfined": "--unconfined",
    "--same-environment": "--same-environment",
    "--any-environment": "--any-environment",
    "--include-files": "--include-files folder",
    "--max-work": "--max-work 100000",
    "--errors": "--errors json",
    "--seed": "--seed 7",
    "-j": "-j 1",
    "--threads": "--threads 2",
}


def with_words(words):
    return {option: f"{row} {words}" for option, row in CHOICES.items()}


OPTIONS = {
    "envc": with_words("--to geojson") | {
        "--to": "--to geojson",
        "--slice": "--slice 1 --to svg",
        "--resolution": "--to ros --resolution 0.1 -o out.yaml",
        "--width": "--width 300 --to png -o out.png",
        "--zone": "--zone door:*,1 --to geojson",
        "--info": "--info",
        "--json": "--info --json",
        "--report": "--report page.html",
        "--check": "--check",
        "--suggest": "--check --suggest",
        "--add": "--add 'cube id=more at=1,1 size=0.3' --to geojson",
        "--fence": "--fence '1,1;1.5,1;1.5,1.5' --to geojson",
        "--set": "--set desk.at=-1.5,-1 --to geojson",
        "--move": "--move crate:0.1,0 --to geojson",
        "--forward": "--forward crate:0.1 --to geojson",
        "--rotate": "--rotate crate:30 --to geojson",
        "--tilt": "--tilt c1:5 lay.3dm --to geojson",
        "--delete": "--delete crate --to geojson",
        "--closed": "--fence '1,1;1.5,1;1.5,1.5' --closed --to geojson",
        "--inside": PLAN,
        "--rooms": PLAN,
        "--close-gaps": PLAN,
        "--reachable": PLAN,
        "--origin": PLAN,
        "--wall-height": PLAN,
        "--wall-thickness": PLAN,
        "--snap": PLAN,
        "--simplify": PLAN,
        "--clean": PLAN,
        "--unknown": PLAN,
        "--units": PLAN,
        "--width-is": PLAN,
        "--slice-walls": MESH,
        "--wall-layer": PLAN,
        "--door-layer": PLAN,
        "--window-layer": PLAN,
        "-MD": "-MD -o out.obj",
        "-MF": "-MD -MF rule -o out.obj",
        "-o": "-o out.obj",
        "--output": "--output out.obj",
    },
    "arrange": with_words(f"{LASERS} {OUT}") | {
        "--sensor": f"{SENSOR} {LASERS}",
        "--batch": "!--batch arranged --cell 0.4 --candidates 1,1,4 --sensor laser:1 -o jobs/",
        "--fixed": f"lay.3dm --fixed l1 {OUT}",
        "--effort": f"!room.env --cell 0.4 --effort low {LASERS}",
        "--strategy": f"!room.env --cell 0.4 --strategy grid {LASERS}",
        "--candidates": f"!room.env --cell 0.4 --candidates 1,1,2 {LASERS}",
        "-X": f"!room.env --cell 0.4 --strategy grid -X 3 -Y 2 --deg 4 {LASERS}",
        "-Y": f"!room.env --cell 0.4 --strategy grid -X 2 -Y 3 --deg 4 {LASERS}",
        "--r1": f"!room.env --cell 0.4 --strategy random --r1 20 {LASERS}",
        "--r2": f"!room.env --cell 0.4 --strategy random --r1 20 --r2 10 {LASERS}",
        "--scope": f"!room.env --cell 0.4 --strategy random --r1 20 --scope 1 {LASERS}",
        "--dist": f"!room.env --cell 0.4 --strategy wall --dist 0.3 {LASERS}",
        "--times": f"!room.env --cell 0.4 --strategy wall --times 12 {LASERS}",
        "--places": f"!room.env --cell 0.4 --strategy list --places places.csv {LASERS}",
        "--deg": f"!room.env --cell 0.4 --strategy grid --deg 3 {LASERS}",
        "--mount": f"--mount ceiling {SENSOR}",
        "--z": f"--z 0.3,0.8 {LASERS}",
        "--tilt": f"--tilt=-20,-40 {SENSOR}",
        "--clearance": f"--clearance 0.3 {LASERS}",
        "--keep-out": f"--keep-out desk_zone {LASERS}",
        "--keep-in": f"--keep-in far {LASERS}",
        "--objective": f"--objective path:desk_zone,far {LASERS}",
        "--zone": f"--zone '*/door:*,1.2' {LASERS}",
        "--weight": f"--weight far=3 {LASERS}",
        "--redundancy": f"--redundancy 2 {LASERS}",
        "--connected": f"!room.env {COARSE} --connected {LASERS}",
        "--target": "--target 60% --sensor laser,range=4",
        "--proof": "!room.env --cell 0.4 --sensor laser:1 --proof poses --time-limit 1min",
        "--budget": "--budget 2 --sensor laser,cost=1",
        "--plane": f"--plane 1 {SENSOR}",
        "--density": f"--density identify {SENSOR}",
        "--grid": f"!room.env --grid 20 --candidates 1,1,4 {LASERS}",
        "--cell": f"!room.env --cell 0.5 --candidates 1,1,4 {LASERS}",
        "--reso": f"--reso 2 {LASERS}",
        "--judge": f"!room.env --cell 0.4 --strategy grid --judge no {LASERS}",
        "--optimize": f"!room.env {COARSE} --optimize exact {LASERS}",
        "--starts": f"!room.env {COARSE} --optimize swap --starts 3 {LASERS}",
        "--gap": f"!room.env {COARSE} --optimize exact --gap 5% {LASERS}",
        "--time-limit": f"--time-limit 10min {LASERS}",
        "--refine": f"!room.env {COARSE} --refine --sensor laser:1",
        "--max-memory": f"--max-memory 100MB {LASERS}",
        "--curve": f"--curve curve.csv {LASERS}",
        "--alternatives": f"!room.env {COARSE} --alternatives 2 {LASERS} {OUT}",
        "--heat": f"--heat heat.svg {LASERS}",
        "--trace": f"--trace trace.csv {LASERS}",
        "--report": f"--report page.html {LASERS}",
        "--export-mps": f"--export-mps model.mps {LASERS}",
        "--shard": f"--shard 1/2 {LASERS} -o out.part",
        "--merge": "!!--merge -o out.3dm a.part b.part",
        "--resume": f"--resume {LASERS} {OUT}",
        "--cache": "!--batch arranged --cell 0.4 --candidates 1,1,4 --sensor laser:1 --cache known -o jobs/",
        "--share": f"!room.env {COARSE} --optimize exact --share tree --shard 1/2 {LASERS} -o out.part",
        "--checkpoint-interval": f"--resume --checkpoint-interval 10s {LASERS} {OUT}",
        "-MD": f"-MD {LASERS} {OUT}",
        "-MF": f"-MD -MF rule {LASERS} {OUT}",
        "-o": f"{OUT} {LASERS}",
        "--output": f"--output out.3dm {LASERS}",
    },
    "scan": with_words("--to csv --select l*") | {
        "--batch": "!--batch list --to csv --select l1 -o jobs/",
        "--to": "--to pcd --select l1",
        "--select": "--select l*",
        "--frames": "--frames 3 --to csv --select l*",
        "--noise": "--noise --to csv --select l*",
        "--no-noise": "--no-noise --to csv --select l*",
        "--poses": "!room.env --poses poses.tum --model urg-04lx --to csv",
        "--model": "!room.env --poses poses.tum --model laser,range=2 --to csv",
        "--motion": "!room.env --poses poses.tum --motion --model urg-04lx --to csv",
        "--coordinates": "--select l1 --to ply --coordinates sensor",
        "--encoding": "--select l1 --to ply --encoding ascii",
        "--compression": "--select l1 --to mcap --compression zstd -o out.mcap",
        "--las-version": "--to las --las-version 1.3 --select l1 -o out.las",
        "--depth-scale": "!room.env --poses poses.tum --model ranger,fov=60,pixels=60,40 --to png --depth-scale 500 -o pictures/",
        "--color": "!room.env --poses poses.tum --model ranger,fov=60,pixels=60,40 --to png --color -o pictures/",
        "--no-color": "!room.env --poses poses.tum --model ranger,fov=60,pixels=60,40 --to png --no-color -o pictures/",
        "--spectrum": "!room.env --poses poses.tum --model ranger,fov=60,pixels=60,40 --to png --color --spectrum 1,4 -o pictures/",
        "--size": "--select l1 --size 300 -o out.png",
        "--temperature": "--temperature 15 --to csv --select l*",
        "--samples": "--select c1 --samples 2 -o out.png",
        "--light": "--select c1 --light lamps -o out.png",
        "--exposure": "--select c1 --exposure 1 -o out.png",
        "--sensor-bodies": "--select c1 --sensor-bodies -o out.png",
        "--no-sensor-bodies": "--select c1 --no-sensor-bodies -o out.png",
        "--layers": "--select c1 --layers labels,depth -o out.png",
        "--run": "!room.env lay.3dm --run rec --to jsonl --select l*",
        "--shard": "--select l* --frames 4 --shard 1/2 --to jsonl -o out.part",
        "--merge": "!!--merge -o out.jsonl a.part b.part",
        "--resume": "--select l* --frames 4 --resume -o out.jsonl",
        "--list-models": "!--list-models",
        "-MD": "--select l* -MD -o out.jsonl",
        "-MF": "--select l* -MD -MF rule -o out.jsonl",
        "-o": "--select l1 -o out.csv",
        "--output": "--select l1 --output out.csv",
    },
    "coverage": with_words("--json") | {
        "--json": "--json",
        "--report": "--report page.html",
        "--batch": "!--batch list",
        "--shard": "!--batch list --shard 1/2",
        "--resume": "!--batch list --resume -o out.jsonl",
        "--cache": "!--batch list --cache known",
        "--grid": "!room.env lay.3dm --grid 20",
        "--cell": "!room.env lay.3dm --cell 0.3",
        "--grid-of": "--grid-of beams",
        "--height": "--height 0.5",
        "--plane": "--plane 1",
        "--density": "--density identify",
        "--parallax": "--parallax 30,2",
        "--zone": "--zone '*/door:*,1.2'",
        "--require": "--require 99%",
        "--junit": "--junit verdicts.xml --require 99%",
        "--compare": "--compare other.3dm",
        "--to": "--to svg -o out",
        "--width": "-o out.png --width 300",
        "--color": "-o out.svg --color sensor",
        "--fans": "-o out.svg --fans beams",
        "--speeds": "--to nav2-speed --speeds 0.2,1 -o out.yaml",
        "--trace": "--trace trace.csv -o out.svg",
        "-MD": "-MD -o out.svg",
        "-MF": "-MD -MF rule -o out.svg",
        "-o": "-o out.csv",
        "--output": "--output out.geojson",
    },
    "simrun": with_words("--record out") | {
        "--zone": "--zone rect:-3,1,0,2 --expect 'no collision'",
        "--clock": "!room.env lay.3dm --clock fast --until 0.5 --listen 127.0.0.1:0",
        "--dt": "--dt 10ms --record out",
        "--until": "!room.env lay.3dm --clock fast --until 0.5 --listen 127.0.0.1:0 --record out",
        "--noise": "--noise --record out",
        "--script": "--script drive.txt --record out",
        "--record": "--record out",
        "--report": "--record out --report run.html",
        "--record-readings": "--record out --record-readings",
        "--no-record-readings": "--record out --no-record-readings",
        "--record-frames": "--record out --record-readings --record-frames 2",
        "--record-sonars": "--record out --record-readings --record-sonars 2",
        "--record-limit": "--record out --record-limit 10MB",
        "--record-every": "--record out --record-every 0.1s",
        "--record-columns": "--record out --record-columns t,id,x,y",
        "--record-compression": "--record out --record-readings --record-compression none",
        "--replay": "!room.env lay.3dm --replay rec --clock fast --listen 127.0.0.1:0",
        "--from": "!room.env lay.3dm --replay rec --from 0.5 --clock fast --listen 127.0.0.1:0",
        "--hold": Exempt("serves until it is ended"),
        "--junit": "--expect 'no collision' --junit verdicts.xml",
        "--listen": "!room.env lay.3dm --clock fast --until 0.5 --listen 127.0.0.1:0",
        "--allow": "--scip l1=127.0.0.1:0 --allow 127.0.0.0/8",
        "--port-file": Exempt("writes a port that the system gives"),
        "--max-clients": "--max-clients 3",
        "--token-file": "--token-file places.csv",
        "--watchdog": "--watchdog 1s",
        "--wait-for-readers": "--wait-for-readers",
        "--load": "--load .",
        "--changes": "--changes",
        "--no-changes": "--no-changes",
        "--shutdown": "--shutdown",
        "--no-shutdown": "--no-shutdown",
        "-MD": "!room.env lay.3dm --replay rec -MD -o out.svg",
        "-MF": "!room.env lay.3dm --replay rec -MD -MF rule -o out.svg",
        "-o": "!room.env lay.3dm --replay rec -o out.svg",
        "--output": "!room.env lay.3dm --replay rec --output out.svg",
    },
}

EXTENSIONS = pathlib.Path(__file__).resolve().parent.parent.parent / "lib/extensions"
# Options that an extension offers, and that have their row here.
MISPLACED = [
    (*line.split(), path.parent.name)
    for path in sorted(EXTENSIONS.glob("*/offers.txt"))
    for line in path.read_text().splitlines()
    if line.split()[0] in OPTIONS and line.split()[1] in OPTIONS[line.split()[0]]
]
for path in sorted(EXTENSIONS.glob("*/site_rows.py")):
    rows = runpy.run_path(str(path))
    FILES |= rows.get("FILES", {})
    BEFORE |= rows.get("BEFORE", {})
    for tool, lines in rows["OPTIONS"].items():
        OPTIONS[tool] |= lines
