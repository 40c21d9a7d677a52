#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenCV's undistorted pictures equal those of a straight camera; camera_info reads back."""
from seen import *

SIZE, FOCAL = (640, 480), 330
K = np.array([[FOCAL, 0, 319.5], [0, FOCAL, 239.5], [0, 0, 1.0]])
BENT = np.array([-0.25, 0.07, 0.001, -0.0015, -0.01])
OMNI = 720
PIXELS = "camera,pixels=640,480"


def agree(what, picture, straight):
    off = np.linalg.norm(find_board(picture) - find_board(straight), axis=1)
    expect(f"{what}: corners, pixels", off.max(), 1)


write_board()
pose = look([0.3, -0.2, 1.4], [0.03, 0.02, 0], 15)
more = ["--samples", "9"]
straight, = photos("room.env", f"{PIXELS},fx={FOCAL}", [pose], *more)

bent, = photos("room.env", f"{PIXELS},fx={FOCAL},coefficients=" + ",".join(map(str, BENT)), [pose],
               *more, name="bent")
if np.abs(find_board(bent) - find_board(straight)).max() < 5:
    sys.exit("FAILED: the lens bends nothing")
agree("plumb_bob, undistort", cv2.undistort(bent, K, BENT), straight)

# A full circle, without a mirror: equidistant. Half of the picture is 95 degrees.
focal = OMNI / 2 / np.radians(95)
wide = np.array([[focal, 0, (OMNI - 1) / 2], [0, focal, (OMNI - 1) / 2], [0, 0, 1]])
omni, = photos("room.env", f"camera,projection=omni,fov=190,pixels={OMNI},{OMNI}", [pose], *more,
               name="omni")
maps = cv2.fisheye.initUndistortRectifyMap(wide, np.zeros(4), np.eye(3), K, SIZE, cv2.CV_32FC1)
agree("omni, remap", cv2.remap(omni, *maps, cv2.INTER_CUBIC), straight)

# Under a parabola.
focal = 360.0
wide[0, 0] = wide[1, 1] = focal
mirror, = photos("room.env", f"camera,projection=omni,mirror=1,fx={focal},pixels={OMNI},{OMNI}",
                 [pose], *more, name="mirror")
maps = cv2.omnidir.initUndistortRectifyMap(
    wide, np.zeros((1, 4)), np.array([1.0]), np.eye(3), K, SIZE, cv2.CV_32FC1,
    cv2.omnidir.RECTIFY_PERSPECTIVE)
agree("mirror, remap", cv2.remap(mirror, *maps, cv2.INTER_CUBIC), straight)

# Calibrations that are written are read: the same camera sees the same, byte by byte.
for name in ["bent", "omni", "mirror"]:
    again = "again-" + name
    photos("room.env", f"camera,calibration={name}-0.yaml", [pose], *more, name=again)
    if name == "omni":  # the record limits the circle, which no calibration does
        continue
    with open(name + "-0.png", "rb") as a, open(again + "-0.png", "rb") as b:
        if a.read() != b.read():
            sys.exit(f"FAILED: {name}-0.yaml is another camera")
