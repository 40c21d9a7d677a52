# SPDX-License-Identifier: GPL-3.0-or-later
"""For tests of pictures by OpenCV: poses, scan, and expected positions."""
import atexit
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import cv2
    import numpy as np
except ImportError:
    print("SKIP: no python3-opencv")
    sys.exit(77)

os.environ["LC_ALL"] = "C"
folder = tempfile.mkdtemp(prefix="ispace-seen-")
atexit.register(shutil.rmtree, folder)
os.chdir(folder)

# OpenCV's optical frame (x right, y down, z forward) from the sensor's (x forward, y left, z up).
OPTICAL = np.array([[0.0, -1, 0], [0, 0, -1], [1, 0, 0]])


def look(eye, target, roll=0.0):
    """(eye, world_from_sensor) of a sensor that faces a target; roll in degrees, left side up."""
    forward = np.subtract(target, eye).astype(float)
    forward /= np.linalg.norm(forward)
    up = np.array([0.0, 0, 1]) if abs(forward[2]) < 0.99 else np.array([1.0, 0, 0])
    left = np.cross(up, forward)
    left /= np.linalg.norm(left)
    up = np.cross(forward, left)
    c, s = np.cos(np.radians(roll)), np.sin(np.radians(roll))
    return np.array(eye, float), np.stack([forward, c * left + s * up, c * up - s * left], axis=1)


def quaternion(matrix):
    rotation, _ = cv2.Rodrigues(matrix)
    angle = np.linalg.norm(rotation)
    axis = rotation.ravel() / angle if angle > 0 else np.zeros(3)
    return [*(np.sin(angle / 2) * axis), np.cos(angle / 2)]


def write_poses(name, poses):
    with open(name, "w", encoding="ascii") as out:
        for t, (eye, matrix) in enumerate(poses):
            print(t, *map(repr, map(float, [*eye, *quaternion(matrix)])), file=out)


def extrinsics(pose):
    """rvec, tvec of OpenCV."""
    eye, matrix = pose
    turn = OPTICAL @ matrix.T
    rvec, _ = cv2.Rodrigues(turn)
    return rvec, -turn @ eye


def run(*command, **more):
    subprocess.run(command, check=True, **more)


def linear(picture):
    """Light instead of sRGB: edges between pixels stay where they are."""
    s = picture / 255
    return np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4).astype(np.float32)


def photos(room, model, poses, *options, name="p"):
    """Grey pictures of a camera at poses."""
    write_poses(name + ".tum", poses)
    run("scan", "-q", room, "--model", model, "--poses", name + ".tum", "-o", name + "-%d.png",
        *options)
    return [cv2.imread(f"{name}-{i}.png", cv2.IMREAD_GRAYSCALE) for i in range(len(poses))]


def write(name, text):
    with open(name, "w", encoding="utf-8") as out:
        out.write(text)


def expect(what, value, limit):
    print(f"{what}: {value:.3g} (at most {limit:g})")
    if not value <= limit:
        sys.exit(f"FAILED {what}: {value} is above {limit}")


# A board on the floor: x to the right of its picture, y to its top, the middle at the origin.
COLUMNS, ROWS, SQUARE = 11, 8, 0.1  # inner corners


def write_board():
    cells = np.add.outer(np.arange(ROWS + 1), np.arange(COLUMNS + 1)) % 2
    squares = np.kron(np.where(cells, 190, 20), np.ones((40, 40)))
    cv2.imwrite("board.png", np.pad(squares, 40, constant_values=190).astype(np.uint8))
    size = f"{(COLUMNS + 3) * SQUARE},{(ROWS + 3) * SQUARE}"
    write("room.env", f"#env 1\nispace size=8,8 height=3.5\nfloor size={size} texture=board.png\n")


def board_points():
    """Inner corners, row by row from the top left of the picture."""
    x = (np.arange(COLUMNS) - (COLUMNS - 1) / 2) * SQUARE
    y = ((ROWS - 1) / 2 - np.arange(ROWS)) * SQUARE
    return np.array([[a, b, 0] for b in y for a in x], np.float32)


def aside(pose, left, up):
    """Turns a pose so that the point it faced is this far off the axis: tangents."""
    eye, matrix = pose
    forward = matrix @ [1, -left, -up]
    forward /= np.linalg.norm(forward)
    sideways = np.cross(matrix[:, 2], forward)
    sideways /= np.linalg.norm(sideways)
    return eye, np.stack([forward, sideways, np.cross(forward, sideways)], axis=1)


def board_poses(near, far, left, up):
    """Views of the whole board from all sides: tilted from near, and from afar in the corners and
    at the edges of the picture, off the axis by the tangents left and up."""
    random = np.random.default_rng(7)
    places = [(0, 0)] * 6 + [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if (a, b) != (0, 0)]
    poses = []
    for i, (a, b) in enumerate(places):
        around, down = 2.4 * i, np.radians(random.uniform(45, 60) if i < 6 else 75)
        eye = (near if i < 6 else far) * np.array(
            [np.cos(around) * np.cos(down), np.sin(around) * np.cos(down), np.sin(down)])
        poses.append(aside(look(eye, [0, 0, 0], random.uniform(-180, 180)), a * left, b * up))
    return poses


def corners(picture, guess, reach=4):
    """Refines corners to parts of a pixel, from points near them."""
    end = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 100, 1e-4)
    return cv2.cornerSubPix(linear(picture), guess.astype(np.float32).reshape(-1, 1, 2).copy(),
                            (reach, reach), (-1, -1), end).reshape(-1, 2)


def find_board(picture):
    """Finds the corners in the order of board_points, without initial positions; None if not found."""
    found, places = cv2.findChessboardCornersSB(picture, (COLUMNS, ROWS))
    if not found:
        return None
    places = corners(picture, places)
    # The same board turned by half: its upper left square is white, the lower right one black.
    def is_white(x, y):
        square = cv2.getPerspectiveTransform(
            np.float32([[0, 0], [COLUMNS - 1, 0], [0, ROWS - 1], [COLUMNS - 1, ROWS - 1]]),
            np.float32([places[0], places[COLUMNS - 1], places[-COLUMNS], places[-1]]))
        u, v = cv2.perspectiveTransform(np.float32([[[x, y]]]), square)[0, 0]
        return picture[int(round(v)), int(round(u))]
    if is_white(0.5, 0.5) < is_white(1.5, 0.5):
        return places
    return places[::-1]
