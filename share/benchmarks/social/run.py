# SPDX-License-Identifier: GPL-3.0-or-later
"""run.py [--build DIR] [--only SCENE]... [--planner NAME=COMMAND]... [-o DIR]: planners among people, in twenty scenes.

Runs each planner in each scene of scenes.json with several seeds, judges the records by `coverage --goal`, and writes
results.jsonl (a line for each run), results.csv, summary.md (means with 95 % intervals over the seeds, and ranks) and
prints the digest of results.jsonl: the same for the same version, scenes, planners and seeds. Python's standard library
is enough.

The baselines are goal, dwa and orca of social_planner; simrun, its GOTO, is a reference that knows all places. A planner is any program that drives the robot; in its COMMAND
{server} is HOST:PORT of simrun, {robot} the robot, {goal} X,Y (in a building STOREY/X,Y), {lift} LIFT=X,Y or "",
{ros} HOST:PORT of rosbridge (with --clock real). It leads the clock by STEP, ends at the goal with status 0, and with
status 3 if the run ended before:

    python3 run.py --planner 'mine=python3 mine.py {server} {robot} {goal}' --only frontal --seeds 3

Seed s of a scene moves each person's start by up to 15 cm and changes her speed by up to 15 %, and is the seed of simrun.
"""

import argparse
import concurrent.futures
import csv
import hashlib
import io
import json
import math
import os
import random
import re
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading

sys.dont_write_bytecode = True  # no compiled files beside the sources
HERE = os.path.dirname(os.path.abspath(__file__))
BASELINES = ("goal", "dwa", "orca")
REFERENCE = "simrun"  # social_planner has it, too
PLACE, PACE = 0.15, 0.15  # metres and share by which a seed changes people
REACH = 0.5
PATIENCE = 600  # seconds of wall time for one run

# Figures of the summary: key, words, whether more is better, digits.
FIGURES = (
    ("success", "goals reached", True, 3),
    ("spl", "SPL", True, 3),
    ("time", "time to goal, s (of those reached)", False, 1),
    ("path_ratio", "path / shortest way (of those reached)", False, 3),
    ("min_distance", "least distance to people, m", True, 3),
    ("intimate_time", "nearer than 0.45 m, s", False, 2),
    ("personal_time", "nearer than 1.2 m, s", False, 2),
    ("stops", "stops", False, 2),
    ("still_time", "time not moving, s", False, 2),
    ("jerk", "mean jerk, m/s³", False, 2),
    ("person_collisions", "collisions with people", False, 2),
    ("thing_collisions", "collisions with walls and things", False, 2),
    ("people_collisions", "collisions between people", False, 2),
)
ROW = ("success", "time", "duration", "path", "way", "path_ratio", "spl", "speed", "min_distance", "intimate",
       "intimate_time", "personal", "personal_time", "stops", "still_time", "jerk", "max_jerk", "person_collisions",
       "thing_collisions", "robot_collisions", "people_collisions")
# Student's t for 95 % with 1, 2, ... degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
           2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042)


class RunFailed(Exception):
    """A tool or a planner that failed, with its last words."""


def read_scenes():
    with open(os.path.join(HERE, "scenes.json"), encoding="utf-8") as file:
        return json.load(file)["scenes"]


def varied(text, scene, seed):
    """The records of a scene with the people of this seed."""
    draw = random.Random(f"{scene['name']} {scene['version']} {seed}")

    def within(most):
        return most * (2 * draw.random() - 1)

    def moved(match):
        x, y = float(match[1]) + within(PLACE), float(match[2]) + within(PLACE)
        return f" at={x:.3f},{y:.3f}"

    def paced(match):
        return f" speed={float(match[1]) * (1 + within(PACE)):.3f}"

    lines = []
    for line in text.splitlines():
        if line.startswith("human "):
            line = re.sub(r" at=([-0-9.]+),([-0-9.]+)", moved, line)
            line = re.sub(r" speed=([0-9.]+)", paced, line)
        lines.append(line)
    return "\n".join(lines) + "\n"


def write_scene(scene, seed, folder):
    """Writes the scene of a seed; returns the operands of simrun."""
    kind = "layout" if "layout" in scene else "file"
    source = os.path.join(HERE, scene[kind])
    with open(source, encoding="utf-8") as file:
        text = varied(file.read(), scene, seed)
    target = os.path.join(folder, os.path.basename(source))
    with open(target, "w", encoding="utf-8") as file:
        file.write(text)
    return [target] if kind == "file" else [os.path.join(HERE, scene["file"]), target]


def write_rooms(scenes, seeds, folder):
    """Writes rooms NAME-SEED.env and task.yaml for simrun --vector; leaves out buildings and scripts."""
    os.makedirs(folder, exist_ok=True)
    limit = max(scene["limit"] for scene in scenes)
    for scene in scenes:
        if "layout" in scene or "script" in scene:
            continue
        with open(os.path.join(HERE, scene["file"]), encoding="utf-8") as file:
            text = file.read()
        for seed in range(1, seeds + 1):
            write(folder, f"{scene['name']}-{seed}.env", varied(text, scene, seed))
    write(folder, "task.yaml", "# The scenes of the social benchmark as worlds for learning.\n"
          f"starts: scene\ngoal: {{zone: goal, radius: {REACH}}}\ntruncations:\n"
          f"  - {{signal: steps, above: {10 * limit - 1}}}\n")


def last_line(text):
    lines = text.strip().splitlines()
    return lines[-1] if lines else "no message"


class Bench:
    def __init__(self, args):
        self.args = args
        self.tools = os.path.join(args.build, "bin") if os.path.isdir(args.build) else ""
        self.baseline = os.path.join(args.build, "examples", "social_planner") if self.tools else "social_planner"

    def tool(self, name):
        return os.path.join(self.tools, name) if self.tools else name

    def run(self, planner, command, scene, seed):
        """One run: a row of results."""
        folder = os.path.join(self.args.output, "runs", f"{planner}-{scene['name']}-{seed}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        record = os.path.join(folder, "run")
        words = [self.tool("simrun"), *write_scene(scene, seed, folder), "-q", "--any-environment", "--dt", "0.05",
                 "--until", str(scene["limit"]), "--seed", str(seed), "--record", record, "--record-every", "0.1",
                 "--clock", self.args.clock, "--listen", "127.0.0.1:0"]
        if "script" in scene:
            words += ["--script", os.path.join(HERE, scene["script"])]
        if self.args.clock.startswith("real"):
            words += ["--rosbridge", "127.0.0.1:0"]
        words += shlex.split(self.args.simrun)
        with tempfile.TemporaryFile("w+") as said:
            server = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=said, text=True)
            guard = threading.Timer(PATIENCE, server.kill)
            guard.start()
            try:
                line = server.stdout.readline()
                if not line:
                    said.seek(0)
                    raise RunFailed(f"{scene['name']}: {last_line(said.read())}")
                self.drive(command, scene, json.loads(line), server)
            finally:
                server.terminate()
                server.wait()
                server.stdout.close()
                guard.cancel()
        figures = self.judge(scene, record)
        if not self.args.keep:
            shutil.rmtree(folder)
        row = {"planner": planner, "scene": scene["name"], "version": scene["version"], "seed": seed}
        for key in ROW:
            value = figures[key]
            row[key] = round(value, 4) + 0.0 if isinstance(value, float) else value
        return row

    def drive(self, command, scene, ports, server):
        """Starts the planner and waits for its end."""
        place = {"{server}": ports["listen"], "{robot}": scene["robot"], "{goal}": scene["goal"],
                 "{lift}": scene.get("lift", ""), "{ros}": ports.get("rosbridge", "").removeprefix("ws://")}
        words = []
        for word in shlex.split(command):
            for key, value in place.items():
                word = word.replace(key, value)
            if word:
                words.append(word)
        with tempfile.TemporaryFile("w+") as said:
            program = subprocess.Popen(words, stdout=said, stderr=said, stdin=subprocess.DEVNULL)
            # One that does not notice the end of the run is ended.
            watch = threading.Thread(target=self.end_after, args=(server, program), daemon=True)
            watch.start()
            status = program.wait()
            said.seek(0)
            if status not in (0, 3) and server.poll() is None:
                raise RunFailed(f"{scene['name']}: `{words[0]}` ends with status {status}: {last_line(said.read())}")

    @staticmethod
    def end_after(server, program):
        server.wait()
        try:
            program.wait(5)
        except subprocess.TimeoutExpired:
            program.kill()

    def judge(self, scene, record):
        words = [self.tool("coverage"), "--run", record, "--goal", scene["goal"], "--robot", scene["robot"], "--reach",
                 str(REACH), "--json", "-q"]
        if "way" in scene:
            words += ["--way", str(scene["way"])]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RunFailed(f"{scene['name']}: {last_line(done.stderr)}")
        return json.loads(done.stdout)


def mean_and_interval(rows, key):
    """The mean over seeds of the means over scenes, and half of its 95 % interval; None without values."""
    seeds = {}
    for row in rows:
        if row[key] is not None:
            seeds.setdefault(row["seed"], []).append(float(row[key]))
    means = [math.fsum(values) / len(values) for values in seeds.values()]
    if not means:
        return None
    mean = math.fsum(means) / len(means)
    if len(means) < 2:
        return mean, math.inf
    t = STUDENT[min(len(means) - 2, len(STUDENT) - 1)]
    return mean, t * statistics.stdev(means) / math.sqrt(len(means))


def rank(own, others, more_is_better):
    """1 and the number of others whose intervals lie wholly on the better side."""
    mean, half = own
    if more_is_better:
        return 1 + sum(other - wide > mean + half for other, wide in others)
    return 1 + sum(other + wide < mean - half for other, wide in others)


def summary(rows, planners, scenes, digest):
    """Tables in Markdown."""
    by_planner = {name: [row for row in rows if row["planner"] == name] for name in planners}
    seeds = len({row["seed"] for row in rows})
    out = io.StringIO()
    out.write(f"Means over {len(scenes)} scenes, ± half of the 95 % interval over {seeds} seeds; in brackets the rank: 1 "
              "and the number\nof planners whose interval lies wholly on the better side. There is no score over all "
              "figures.\n\n")
    out.write("| figure | " + " | ".join(planners) + " |\n|---" * 1 + "|---" * len(planners) + "|\n")
    for key, words, more_is_better, digits in FIGURES:
        found = {name: mean_and_interval(by_planner[name], key) for name in planners}
        cells = []
        for name in planners:
            if found[name] is None:
                cells.append("-")
                continue
            mean, half = found[name]
            others = [value for other, value in found.items() if other != name and value is not None]
            interval = f" ± {half:.{digits}f}" if math.isfinite(half) else ""
            cells.append(f"{mean:.{digits}f}{interval} ({rank(found[name], others, more_is_better)})")
        out.write(f"| {words} | " + " | ".join(cells) + " |\n")
    out.write("\nBy scene: goals reached; mean time, s; least distance to people, m; collisions with people and things in "
              "all runs.\n\n")
    out.write("| scene | " + " | ".join(planners) + " |\n|---" + "|---" * len(planners) + "|\n")
    for scene in scenes:
        cells = []
        for name in planners:
            runs = [row for row in by_planner[name] if row["scene"] == scene["name"]]
            times = [row["time"] for row in runs if row["time"] is not None]
            near = [row["min_distance"] for row in runs if row["min_distance"] is not None]
            hits = sum(row["person_collisions"] + row["thing_collisions"] for row in runs)
            time = f"{math.fsum(times) / len(times):.1f}" if times else "-"
            least = f"{min(near):.2f}" if near else "-"
            cells.append(f"{sum(row['success'] for row in runs)}/{len(runs)}; {time}; {least}; {hits}")
        out.write(f"| {scene['name']} | " + " | ".join(cells) + " |\n")
    out.write(f"\nDigest of results.jsonl: {digest}\n")
    return out.getvalue()


def write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8", newline="") as file:
        file.write(text)


def table(rows):
    out = io.StringIO()
    writer = csv.DictWriter(out, ["planner", "scene", "version", "seed", *ROW], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def arguments():
    parser = argparse.ArgumentParser(description="planners among people, in twenty scenes")
    parser.add_argument("--build", default="build", help="the build whose programs run; without such a folder, those "
                        "of the PATH")
    parser.add_argument("-o", "--output", default="build/social", help="folder of the results")
    parser.add_argument("--only", action="append", default=[], metavar="SCENE", help="only this scene (repeatable)")
    parser.add_argument("--planner", action="append", default=[], metavar="NAME=COMMAND",
                        help="a further planner (repeatable)")
    parser.add_argument("--baselines", default=",".join(BASELINES), metavar="LIST",
                        help="of goal, dwa, orca and simrun, or none (default: the first three)")
    parser.add_argument("--seeds", type=int, default=5, help="runs of each planner in each scene (default 5)")
    parser.add_argument("--clock", default="step", help="of simrun: step, or real[:RATE] for planners that cannot lead "
                        "the clock, with topics of ROS; such results differ from run to run")
    parser.add_argument("--simrun", default="", metavar="OPTIONS", help="further options of simrun, such as '--ros2 7' "
                        "for nodes of ROS 2")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at a time")
    parser.add_argument("--keep", action="store_true", help="keep scenes and records below runs/")
    parser.add_argument("--write", metavar="DIR", help="write the rooms of the seeds and task.yaml for simrun --vector, "
                        "and exit")
    parser.add_argument("--list", action="store_true", help="list the scenes and exit")
    return parser.parse_args()


def main():
    args = arguments()
    scenes = read_scenes()
    if args.list:
        for scene in scenes:
            print(f"{scene['name']:20} {scene['version']}  {scene['limit']:3} s  {scene['asks']}")
        return 0
    names = [scene["name"] for scene in scenes]
    for name in args.only:
        if name not in names:
            print(f"run.py: no scene {name}; there are {', '.join(names)}", file=sys.stderr)
            return 2
    scenes = [scene for scene in scenes if not args.only or scene["name"] in args.only]
    if args.write:
        write_rooms(scenes, args.seeds, args.write)
        return 0
    bench = Bench(args)
    planners = {}
    for name in [] if args.baselines == "none" else args.baselines.split(","):
        if name not in (*BASELINES, REFERENCE):
            print(f"run.py: no baseline {name}; there are {', '.join(BASELINES)} and {REFERENCE}", file=sys.stderr)
            return 2
        planners[name] = f"{shlex.quote(bench.baseline)} {name} {{server}} {{robot}} {{goal}} {{lift}}"
    for text in args.planner:
        name, equals, command = text.partition("=")
        if not equals or not re.fullmatch(r"[A-Za-z0-9_.-]+", name) or not command.strip() or name in planners:
            print(f"run.py: --planner wants a new NAME=COMMAND, found `{text}`", file=sys.stderr)
            return 2
        planners[name] = command
    if not planners or args.seeds < 1:
        print("run.py: no planner, or no seed, to run", file=sys.stderr)
        return 2
    os.makedirs(args.output, exist_ok=True)
    jobs = [(name, command, scene, seed) for name, command in planners.items() for scene in scenes
            for seed in range(1, args.seeds + 1)]
    try:
        with concurrent.futures.ThreadPoolExecutor(max(1, args.jobs)) as pool:
            rows = list(pool.map(lambda job: bench.run(*job), jobs))
    except (RunFailed, OSError) as error:
        hint = ""
        if isinstance(error, FileNotFoundError):
            hint = f" (--build names a build; social_planner is made by `cmake -S {HERE} -B planners` and `cmake --build`)"
        print(f"run.py: {error}{hint}", file=sys.stderr)
        return 1
    lines = "".join(json.dumps(row) + "\n" for row in rows)
    digest = "sha256:" + hashlib.sha256(lines.encode()).hexdigest()
    write(args.output, "results.jsonl", lines)
    write(args.output, "results.csv", table(rows))
    text = summary(rows, list(planners), scenes, digest)
    write(args.output, "summary.md", text)
    sys.stdout.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
