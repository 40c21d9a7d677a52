#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Labels lie where OpenCV projects corners, depths are a ranger's, films hold the pictures."""
import csv
import hashlib

from seen import *

W, H = 320, 240
EYE, TARGET, ROLL = [-2.6, -1.2, 1.7], [0.6, 0.3, 0.5], 4
pose = look(EYE, TARGET, ROLL)
write("room.env", "#env 1\nispace id=room size=6,4 height=2.5\n"
      "cube id=crate at=1,0.3 size=0.8,0.6,0.7 heading=25\n")
K = np.array([[250, 0, 159.5], [0, 250, 119.5], [0, 0, 1.0]])
BENT = np.array([-0.2, 0.05, 0.001, -0.001, 0.0])
model = f"camera,pixels={W},{H},fx=250,coefficients=" + ",".join(map(str, BENT))
photos("room.env", model, [pose], "--samples", "1", "--layers", "labels,depth")
labels = cv2.imread("p-0-labels.png", cv2.IMREAD_UNCHANGED)
depths = cv2.imread("p-0-depth.png", cv2.IMREAD_UNCHANGED) / 1000
with open("p-0-labels.csv", encoding="utf-8") as file:
    table = {row["id"]: row for row in csv.DictReader(file)}
for label, count in zip(*np.unique(labels, return_counts=True)):
    row = next(r for r in table.values() if int(r["label"]) == label)
    if int(row["pixels"]) != count:
        sys.exit(f"FAILED: the table counts {row['pixels']} of {label}, there are {count}")
if table["crate"]["keyword"] != "cube":
    sys.exit("FAILED: the crate is no cube")


def project(points, bent=BENT):
    return cv2.projectPoints(np.array(points, float), *extrinsics(pose), K, bent)[0].reshape(-1, 2)


# The crate: the pixels within its corners and edges, up to a pixel at the rim.
c, s = np.cos(np.radians(25)), np.sin(np.radians(25))
box = np.array([[1 + c * x - s * y, 0.3 + s * x + c * y, z]
                for x in (-0.4, 0.4) for y in (-0.3, 0.3) for z in (0, 0.7)])
edges = [project(a + (b - a) * np.linspace(0, 1, 50)[:, None]) for a in box for b in box]
hull = cv2.convexHull(np.concatenate(edges).astype(np.float32))
signed = np.array([[cv2.pointPolygonTest(hull, (float(x), float(y)), True) for x in range(W)]
                   for y in range(H)])
mask = labels == int(table["crate"]["label"])
expect("pixels of the crate outside of its outline", float(signed[mask].min() < -1), 0)
expect("pixels within the outline that are no crate", float((signed[~mask] > 1).sum()), 0)

# The foot of the wall that is seen: above it wall, below it floor.
wall = int(table["room"]["label"])
seen = 0
for x, y in project([[3, t, 0] for t in np.linspace(-1.9, 1.9, 60)] +
                    [[t, 2, 0] for t in np.linspace(-1, 2.9, 60)]):
    if not (2 < x < W - 3 and 2 < y < H - 3) or signed[int(round(y)), int(round(x))] > -3:
        continue
    seen += 1
    above, below = labels[int(round(y - 1.5)), int(round(x))], labels[int(round(y + 1.5)),
                                                                     int(round(x))]
    if above != wall or below != 0:
        sys.exit(f"FAILED: at {x:.1f},{y:.1f} the foot of the wall has {above} above, {below} below")
print(seen, "places along the foot of the walls")
if seen < 30:
    sys.exit("FAILED: too few to prove anything")

# Corners of the room: depth along the axis.
forward = pose[1][:, 0]
for corner in [[3, 2, 0], [3, -2, 0]]:
    x, y = project([corner])[0]
    if 2 < x < W - 3 and 2 < y < H - 3:
        expect(f"depth of the corner {corner}, metres",
               abs(depths[int(round(y)), int(round(x))] - np.dot(corner - pose[0], forward)), 0.05)

# A ranger at the camera's pose measures the same depths.
write_poses("one.tum", [pose])
field = "fov=70,55 pixels=160,120 range=0,20".replace(" ", ",")
run("scan", "-q", "room.env", "--model", "ranger," + field, "--poses", "one.tum", "-o", "r-%d.png",
    "--no-color")
photos("room.env", "camera," + field, [pose], "--samples", "1", "--layers", "depth", name="c")
off = np.abs(cv2.imread("r-0.png", cv2.IMREAD_UNCHANGED).astype(int) -
             cv2.imread("c-0-depth.png", cv2.IMREAD_UNCHANGED))
expect("share of depths that are not the ranger's", float((off > 1).mean()), 1e-3)

# Films: the same pictures one behind another, for one thread or more, with noise.
poses = [look([-2, y, 1.5], [1, 0.3, 0.4]) for y in (-0.5, 0, 0.5)]
small = "camera,pixels=96,64,fov=70,rate=12.5"
photos("room.env", small, poses, "--noise", "--seed", "3", name="f")
still = [cv2.imread(f"f-{i}.png") for i in range(3)]
digests = set()
for threads in ("1", "2"):
    run("scan", "-q", "room.env", "--model", small, "--poses", "f.tum", "--noise", "--seed", "3",
        "-j", threads, "-o", "f.rgb")
    with open("f.rgb", "rb") as file:
        data = file.read()
    digests.add(hashlib.sha256(data).hexdigest())
raw = np.frombuffer(data, np.uint8).reshape(3, 64, 96, 3)
expect("rgb24 against png", float(np.abs(raw[..., ::-1].astype(int) - still).max()), 0)
expect("films of one thread and of two", len(digests), 1)
run("scan", "-q", "room.env", "--model", small, "--poses", "f.tum", "--noise", "--seed", "3",
    "-o", "f.y4m")
film = cv2.VideoCapture("f.y4m")  # by FFmpeg
if film.isOpened():
    expect("y4m: pictures a second", abs(film.get(cv2.CAP_PROP_FPS) - 12.5), 1e-6)
    for picture in still:
        ok, frame = film.read()
        if not ok:
            sys.exit("FAILED: FFmpeg does not read the film")
        expect("y4m by FFmpeg against png, of 255", float(np.abs(frame.astype(int) - picture).max()),
               5)
    if film.read()[0]:
        sys.exit("FAILED: the film goes on")
run(
    "scan", "-q", "room.env", "--model", small, "--poses", "f.tum", "--noise", "--seed", "3",
    "-o", "j-%d.jpg")
expect("jpeg against png, mean of 255",
       float(np.abs(cv2.imread("j-0.jpg").astype(int) - still[0]).mean()), 4)
