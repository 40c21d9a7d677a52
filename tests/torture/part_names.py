# SPDX-License-Identifier: GPL-3.0-or-later
"""FIFOs, devices, links, folders and odd names for every file that the user or a file may name.

A tool rejects or handles each within five seconds, with bounded memory, and leaves files that are not regular
unchanged. It may read only a FIFO or an endless device that the user names without end, as `cat` does; TERM ends
that within a second.
"""
import os
import shlex
import shutil
import signal
import socket
import stat
import time

import lab as labs

LIMIT = 5        # seconds
MEMORY = 1 << 30
ENDLESS = ("fifo", "link to a fifo", "random")

# Operands; @ stands for the name, and the suffix behind it may decide the format.
IMPORTS = ("", ".env", ".yaml", ".glb", ".png", ".jpg", ".tiff", ".dxf", ".svg", ".ifc", ".obj", ".stl", ".ply", ".dae",
           ".world", ".sdf", ".pcd", ".las", ".map", ".json", ".3dm")
NAMED = [f"envc @{suffix} --to env -o new.env" for suffix in IMPORTS] + [
    "envc room.env --to env -o @", "envc room.env --to ros -o @.yaml", "envc room.env --to obj -o @.obj",
    "envc room.env -o new.glb -MD -MF @", "envc world.sdf --models @ --to env -o new.env", "envc best.3dm --to env -o @",
    "arrange @ PLACING -o new.3dm", "arrange room.env @ PLACING -o new.3dm", "arrange room.env PLACING -o @",
    "arrange room.env --sensor laser --places @ --strategy list -q -o new.3dm",
    "arrange room.env PLACING --trace @ -o new.3dm", "arrange room.env PLACING --curve @.csv -o new.3dm",
    "arrange room.env PLACING --export-mps @ -o new.3dm", "arrange --merge @ -q -o new.3dm",
    "arrange room.env PLACING --resume -o @", "arrange room.env PLACING --shard 1/2 -o @",
    "scan @", "scan room.env @", "scan room.env laser.3dm -o @", "scan room.env --poses @ --model laser --to csv",
    "scan --run @", "scan --merge @ -o new.jsonl", "scan room.env laser.3dm --frames 2 --resume -o @.csv",
    "coverage @ laser.3dm", "coverage room.env @", "coverage --batch @", "coverage room.env laser.3dm --compare @",
    "coverage room.env laser.3dm --run @", "coverage room.env laser.3dm --trace @ -o new.png",
    "coverage room.env laser.3dm --require 1% --junit @", "coverage room.env laser.3dm --report @.json",
    "coverage room.env laser.3dm --to png -o @",
    "simrun @ SERVED", "simrun room.env @ SERVED", "simrun room.env robots.3dm SERVED --script @",
    "simrun room.env robots.3dm SERVED --record @", "simrun --replay @ SERVED", "simrun --replay run --to png -o @",
    "simrun room.env SERVED --port-file @", "simrun room.env SERVED --token-file @",
    "simrun room.env robots.3dm SERVED --expect no~collision --junit @", "simrun room.env SERVED --load @",
]
SHORT = {"PLACING": "--sensor laser,range=1 --candidates 1,1,4 -q", "SERVED": "--clock fast --until 0.01"}

# Names in files: the file, its text, and the commands that read it.
SDF = '<sdf version="1.7"><world name="w"><include><uri>{}</uri></include></world></sdf>\n'
MESH = ('<sdf version="1.7"><model name="m"><link name="l"><collision name="c"><geometry><mesh><uri>{}</uri></mesh>'
        "</geometry></collision></link></model></sdf>\n")
GLTF = ('{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"{}","byteLength":36}}],"bufferViews":[{{"buffer":0,'
        '"byteLength":36}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],'
        '"max":[1,1,1]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"nodes":[{{"mesh":0}}],'
        '"scenes":[{{"nodes":[0]}}],"scene":0}}\n')
FENCE = "fence path=-4,-4;4,-4;4,4;-4,4 closed=yes\n"
INSIDE = [
    ("in.3dm", "#3dm 1\nenvironment file={}\nlaser at=0,0\n", ["coverage in.3dm", "scan in.3dm", "simrun in.3dm SERVED"]),
    ("in.env", "#env 1\n" + FENCE + "mesh file={}\n", ["envc in.env --to env", "coverage in.env laser.3dm"]),
    ("in.env", "#env 1\n" + FENCE + "mesh file={}.obj\n", ["envc in.env --to glb -o new.glb"]),
    ("in.yaml", "- include: {}\n", ["envc in.yaml --to env"]),
    ("in.env", "#env 1\nstorey id=a file={}\nstorey id=b file=room.env z=3\n", ["envc in.env --info", "coverage in.env laser.3dm"]),
    ("in.yaml", "- storey: {{id: a, records: [include: {}]}}\n", ["envc in.yaml --check", "scan in.yaml laser.3dm"]),
    ("in.txt", "{} laser.3dm\nroom.env {}\n",
     ["coverage --batch in.txt", "scan --batch in.txt -o new/", "arrange --batch in.txt PLACING -o new/"]),
    ("in.yaml", "image: {}\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n",
     ["envc in.yaml --to env"]),
    ("in.world", SDF, ["envc in.world --to env"]),
    ("in.world", MESH, ["envc in.world --to env"]),
    ("in.gltf", GLTF, ["envc in.gltf --to env"]),
    ("in.obj", "mtllib {}\nv 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 3\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n",
     ["envc in.obj --to env"]),
    ("in.env", "#env 1\n" + FENCE + "camera at=1,1,1 calibration={}\n", ["scan in.env -o new/"]),
    ("in.env", "#env 1\n" + FENCE + "cube at=1,1 size=1 texture={}\n", ["scan in.env --view bird -o new.png"]),
]
RECORDED = ("info.csv", "robots.csv", "people.csv", "events.csv", "scene.env", "scans.jsonl", "odometry.csv",
            "sonars.csv", "bumpers.csv", "timing.csv")
REPLAYS = ("simrun --replay copy SERVED", "scan --run copy", "coverage room.env laser.3dm --run copy",
           "simrun --replay copy --to png -o new.png")


def make_kinds(folder):
    """{kind: function of a path that makes such a file there}"""

    def server(path):
        listener = socket.socket(socket.AF_UNIX)
        where = os.open(os.path.dirname(path), os.O_RDONLY)  # a path of a socket is short
        listener.bind(f"/proc/self/fd/{where}/{os.path.basename(path)}")
        os.close(where)
        listener.close()

    kinds = {"fifo": os.mkfifo, "folder": os.mkdir, "socket": server,
             "dangling link": lambda path: os.symlink("nowhere", path),
             "link in a circle": lambda path: os.symlink(os.path.basename(path), path),
             "link to a fifo": lambda path: (os.mkfifo(path + ".target"), os.symlink(path + ".target", path))}
    if os.geteuid() == 0:
        # Nodes of our own: a tool that replaced /dev/zero would harm the machine.
        for name, minor in (("zero", 5), ("null", 3), ("full", 7), ("random", 9)):
            kinds[name] = lambda path, minor=minor: os.mknod(path, 0o666 | stat.S_IFCHR, os.makedev(1, minor))
        try:
            kinds["zero"](os.path.join(folder, "try"))
            os.remove(os.path.join(folder, "try"))
            kinds["link to zero"] = lambda path: (kinds["zero"](path + ".target"), os.symlink(path + ".target", path))
        except OSError:
            kinds = {name: make for name, make in kinds.items() if name not in ("zero", "null", "full", "random")}
    return kinds


class Field:
    def __init__(self, lab):
        self.lab, self.folder = lab, lab.inputs("inputs")
        for name, text in (("laser.3dm", "#3dm 1\nlaser id=l1 at=0,0\n"), ("world.sdf", SDF.format("model://m"))):
            self.write(name, text)
        for argv in (["simrun", "room.env", "robots.3dm", "--clock", "fast", "--until", "0.1", "--record", "run"],):
            lab.run(argv, self.folder)
        self.kept = set(os.listdir(self.folder))
        self.kinds = make_kinds(self.folder)

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def clear(self):
        for name in set(os.listdir(self.folder)) - self.kept:
            path = os.path.join(self.folder, name)
            shutil.rmtree(path) if os.path.isdir(path) and not os.path.islink(path) else os.remove(path)

    def attempt(self, command, kind, path, named_by_user):
        for word, text in SHORT.items():
            command = command.replace(word, text)
        path = os.path.join(self.folder, path)
        if kind in ENDLESS and named_by_user:
            self.wait_for(command, kind)
            return
        before = os.lstat(path)
        argv = [word.replace("~", " ") for word in command.split()]
        limit = labs.allowed(LIMIT)
        result = self.lab.run(argv, self.folder, limit)
        self.lab.count("names")
        broken = judge(argv[0], result, limit)
        if not broken and not same_file(path, before):
            broken = f"the {kind} was replaced"
        if broken:
            self.lab.violated(f"{command} where {os.path.basename(path)} is a {kind}: {broken}")

    def wait_for(self, command, kind):
        """Either rejects it, or reads on until TERM."""
        process = self.lab.start([word.replace("~", " ") for word in command.split()], self.folder)
        self.lab.count("names")
        try:
            process.wait(0.2)
            status = process.returncode
            if status not in (0, 1, 2, 3):
                self.lab.violated(f"{command} where special is a {kind}: status {status}")
        except Exception:  # TimeoutExpired
            self.lab.count("waits")
            begin = time.monotonic()
            process.send_signal(signal.SIGTERM)
            timeout = labs.patience(1)
            while process.poll() is None and time.monotonic() < begin + timeout:
                time.sleep(0.005)
            if process.poll() is None:
                self.lab.violated(f"{command} where special is a {kind}: TERM does not end the wait within {timeout:.0f} s")
                labs.kill_session(process.pid)
                process.wait()


def judge(tool, result, limit):
    if result.status is None:
        return f"still at it after {limit:.0f} s"
    if result.status not in (0, 1, 2, 3):
        return f"status {result.status}: {result.said()}"
    if result.rss > MEMORY:
        return f"{result.rss / labs.MIB:.0f} MiB of memory"
    if result.status in (1, 2):
        lines = result.said().splitlines()
        if not lines or any(not line.startswith(tool + ": ") for line in lines):
            return f"status {result.status}, said {result.said()!r}"
        if "bad_alloc" in result.said() or "std::" in result.said():
            return result.said()
    return ""


def same_file(path, before):
    """Whether the entry is of the kind it was; a tool may fill a folder."""
    try:
        return stat.S_IFMT(os.lstat(path).st_mode) == stat.S_IFMT(before.st_mode)
    except FileNotFoundError:
        return False


def cases(field):
    """(prepare, command, kind, path, named by the user), in the order of the lists."""
    for kind, make in field.kinds.items():
        for command in NAMED:
            word = next((word for word in command.split() if "@" in word), "@")
            name = word.replace("@", "special")
            yield (lambda make=make, name=name: make(os.path.join(field.folder, name)),
                   command.replace("@", "special"), kind, name, True)
        for file, text, commands in INSIDE:
            for command in commands:
                name = "special.obj" if "{}.obj" in text else "special"

                def prepare(make=make, name=name, file=file, text=text):
                    make(os.path.join(field.folder, name))
                    field.write(file, text.format("special", "special"))

                yield prepare, command, kind, name, False
        for file in RECORDED:
            for command in REPLAYS:

                def replace(make=make, file=file):
                    shutil.copytree(os.path.join(field.folder, "run"), os.path.join(field.folder, "copy"))
                    path = os.path.join(field.folder, "copy", file)
                    if os.path.exists(path):
                        os.remove(path)
                    make(path)

                yield replace, command, kind, os.path.join("copy", file), False


def run(lab):
    field = Field(lab)
    tried = list(cases(field))
    lab.random.shuffle(tried)
    for done, (prepare, command, kind, path, named_by_user) in enumerate(tried):
        if lab.left() <= 0:
            lab.say(f"time for {done} of {len(tried)} cases")
            break
        field.clear()
        prepare()
        field.attempt(command, kind, path, named_by_user)
