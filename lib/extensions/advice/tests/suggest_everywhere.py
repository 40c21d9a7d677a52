# SPDX-License-Identifier: GPL-3.0-or-later
"""suggest_everywhere.py scenes: applies suggestions in the scenes of the current folder.
suggest_everywhere.py ROOT K/N: applies them in each K-th of N maps below ROOT.

Runs five suggestions a scene as coverage prints them; coverage then reports the gain told.
"""

import json
import pathlib
import shlex
import subprocess
import sys

WITH_LAYOUT = ("barriers", "near-far", "ispace", "hall", "road")
SUFFIXES = {".yaml", ".map", ".dxf", ".svg", ".ifc", ".obj", ".world", ".pol"}
# Not rooms: a world without walls, and one whose models are in other packages.
NO_ROOMS = ("/empty_world.world", "_autorace_2020.world")


def fail(message):
    sys.exit(f"FAILED: {message}")


def run(*command):
    """Returns the output of a command as JSON, or as text."""
    words = [str(word) for word in command]
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        fail(f"status {done.returncode} of: {shlex.join(words)}")
    return json.loads(done.stdout) if "--json" in words else done.stdout


def covered(report):
    """Returns the covered share; of lasers that turn by cells."""
    share = report["coverage"]
    return share["grid"] if share["exact"] is None else share["exact"]


def told(scene):
    """Returns the suggestions in a scene; each gain is the difference of two coverages."""
    report = run("coverage", "-q", "--grid", 80, *scene, "--suggest", 5, "--json")
    area = report["indoor_area"]
    for one in report["suggestions"]:
        gain = (one["coverage"] - covered(report)) * area
        if abs(gain - one["gained"]) > 1e-9 * area + 1e-9:
            fail(f"{scene}: a gain is not the difference of two coverages: {one}")
    return report["suggestions"]


def apply_five(name, *scene):
    """Applies all suggestions, then suggests anew in the scene after the first of them, until five are applied."""
    count = 0
    for turn in range(1, 6):
        changed = []
        for one in told(scene):
            if subprocess.run(one["command"] + " -q", shell=True).returncode != 0:
                fail(f"{name}: no such change: {one['command']}")
            share = covered(run("coverage", "-q", "--grid", 80, "changed.env", "--json"))
            if abs(share - one["coverage"]) > 1e-9:
                fail(f"other coverage than told: {name}, {one['kind']}: {one['command']}")
            count += 1
            if not changed:
                changed.append(pathlib.Path("changed.env").replace(f"scene{turn}.env"))
        if count >= 5:
            break
        if not changed:
            fail(f"{name}: only {count} suggestions, none in round {turn}")
        scene = changed
    if count < 5:
        fail(f"{name}: only {count} suggestions")
    print(f"{name}: {count} suggestions", flush=True)


def arrange(room):
    """Writes layout.3dm: two scanners that see an eighth of the room's length, candidates half of it apart."""
    a, b, c, d = run("envc", room, "--info", "--json")["limits"]
    size = max(c - a, d - b)
    run("arrange", room, "--sensor", f"laser,range={size / 8},fov=180:2",
        "--candidates", f"{size / 16},{size / 16},4", "-q", "-o", "layout.3dm")


def in_scenes():
    rooms = sorted([*pathlib.Path().glob("*.env"), *pathlib.Path().glob("*.yaml")])
    for room in [*rooms, "house/ground.env", "house/upper.env"]:
        layout = pathlib.Path(room).with_suffix(".3dm")
        if layout.stem not in WITH_LAYOUT:
            arrange(room)
            layout = "layout.3dm"
        apply_five(room, room, layout)
    apply_five("walkers.3dm", "crowded.env", "walkers.3dm")
    apply_five("distributed.3dm", "ispace.env", "distributed.3dm")


def options_for(path):
    """Returns the options of envc that a map needs."""
    by_name = {
        "oodavid.svg": ["--width-is", "12m"],
        "shone.svg": ["--width-is", "12m"],
        "units_lie.dxf": ["--units", "m"],
        "ml3.dxf": ["--wall-layer", "Walls"],
        "room-y-up.obj": ["--slice-walls", "1.2"],
        "duplex.ifc": ["--storey", "level-1"],
        "fzk-haus.ifc": ["--storey", "Erdgeschoss"],
    }
    models = path.parent / "models"
    if path.suffix == ".world" and "turtlebot3_gazebo" in path.parts and models.exists() \
            and not (path.parent.parent / "models").exists():
        return ["--models", models]
    return by_name.get(path.name, [])


def in_maps(root, part):
    number, parts = (int(word) for word in part.split("/"))
    # Inputs in a folder `cases` are small and odd on purpose: some have no room.
    maps = sorted(path for path in root.rglob("*") if path.is_file() and "cases" not in path.relative_to(root).parts
                  and (path.suffix in SUFFIXES or path.suffix == ".json" and path.parent.name == "plans")
                  and not str(path).endswith(NO_ROOMS))
    if not maps:
        sys.exit(77)
    for path in maps[number - 1::parts]:
        room = path
        if options := options_for(path):
            room = "room.glb"
            run("envc", "-q", path, *options, "-o", room)
        arrange(room)
        apply_five(path.relative_to(root), room, "layout.3dm")


if sys.argv[1] == "scenes":
    in_scenes()
else:
    in_maps(pathlib.Path(sys.argv[1]), sys.argv[2])
