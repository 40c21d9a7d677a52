#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenCV finds ArUco markers in pictures, and by them where the camera was."""
from seen import *

# A board of markers in the white squares of a chessboard (ChArUco), 1000 pixels a metre, on both
# long sides of a barrier that stands across the x axis.
LENGTH, HEIGHT, FACE = 1.2, 0.9, 1.99
DICTIONARY = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_50)
IS_OLD = hasattr(cv2.aruco, "CharucoBoard_create")  # until OpenCV 4.6
if IS_OLD:
    BOARD = cv2.aruco.CharucoBoard_create(8, 6, 0.15, 0.11, DICTIONARY)
else:
    BOARD = cv2.aruco.CharucoBoard((8, 6), 0.15, 0.11, DICTIONARY)
    BOARD.setLegacyPattern(True)
K = np.array([[1640, 0, 639.5], [0, 1640, 479.5], [0, 0, 1.0]])

picture = BOARD.draw((1200, 900)) if IS_OLD else BOARD.generateImage((1200, 900))
cv2.imwrite("markers.png", np.where(picture > 127, 190, 20).astype(np.uint8))
write("room.env", "#env 1\nispace size=8,8 height=3\n"
      f"barrier at=2,0 heading=90 size={LENGTH},0.02,{HEIGHT} texture=markers.png\n")

poses = [look(eye, [2, 0, 0.45], roll) for eye, roll in
         [([0.2, 0.6, 1.1], 12), ([0.3, -0.9, 0.7], 20), ([0.6, 0.9, 0.3], -35), ([0.4, 0.1, 1.3], 70)]]
for pose, picture in zip(poses, photos("room.env", "camera,pixels=1280,960,fx=1640", poses,
                                       "--samples", "16")):
    if IS_OLD:
        quads, ids, _ = cv2.aruco.detectMarkers(picture, DICTIONARY)
    else:
        quads, ids, _ = cv2.aruco.ArucoDetector(DICTIONARY).detectMarkers(picture)
    if ids is None or len(ids) < 12:
        sys.exit(f"FAILED: {0 if ids is None else len(ids)} of 24 markers found")
    if IS_OLD:
        _, places, squares = cv2.aruco.interpolateCornersCharuco(quads, ids, picture, BOARD)
    else:
        places, squares, _, _ = cv2.aruco.CharucoDetector(BOARD).detectBoard(picture, None, None, quads, ids)
    print(len(ids), "markers,", len(squares), "corners")
    # The board's frame begins at its upper left corner: x to the right, y down.
    flat = (BOARD.chessboardCorners if IS_OLD else BOARD.getChessboardCorners())[squares.ravel()].astype(float)
    points = np.stack([np.full(len(flat), FACE), LENGTH / 2 - flat[:, 0], HEIGHT - flat[:, 1]], 1)
    places = corners(picture, places)
    _, rvec, tvec = cv2.solvePnP(points, places, K, None)
    rvec, tvec = cv2.solvePnPRefineLM(points, places, K, None, rvec, tvec)
    turn, _ = cv2.Rodrigues(rvec)
    expect("place of the camera, metres", np.linalg.norm(-turn.T @ tvec.ravel() - pose[0]), 1e-3)
    off, _ = cv2.Rodrigues(turn @ (OPTICAL @ pose[1].T).T)
    expect("turn of the camera, degrees", np.degrees(np.linalg.norm(off)), 0.01)
