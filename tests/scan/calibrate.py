#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenCV calibrates cameras by pictures of a chessboard, and finds the parameters of the records."""
from seen import *

SIZE = (640, 480)


def widest_error(camera, truth, project):
    """Greatest distance in pixels of two calibrations over the rays of a picture."""
    return np.abs(project(*camera) - project(*truth)).max()


def calibrate_pinhole():
    truth = (np.array([[520, 0, 322.5], [0, 515, 236.25], [0, 0, 1]]),
             np.array([-0.28, 0.09, 0.0008, -0.0006, -0.012]))
    model = "camera,pixels=640,480,fx=520,fy=515,cx=322.5,cy=236.25,coefficients=" + \
        ",".join(map(str, truth[1]))
    views = [find_board(p) for p in
             photos("room.env", model, board_poses(1.7, 2.4, 0.33, 0.2), "--samples", "9", name="pin")]
    seen = [v for v in views if v is not None]
    print(len(seen), "of", len(views), "boards found")
    if len(seen) < 12:
        sys.exit("FAILED: chessboards are not found")
    error, matrix, k, _, _ = cv2.calibrateCamera(
        [board_points()] * len(seen), [v.reshape(-1, 1, 2) for v in seen], SIZE, None, None)
    expect("pinhole: mean error of corners, pixels", error, 0.1)
    expect("pinhole: fx", abs(matrix[0, 0] / 520 - 1), 1e-3)
    expect("pinhole: fy", abs(matrix[1, 1] / 515 - 1), 1e-3)
    expect("pinhole: centre, of the width", np.hypot(matrix[0, 2] - 322.5, matrix[1, 2] - 236.25)
           / 640, 1e-3)
    # Rays that the camera has pixels for.
    grid = np.stack(np.meshgrid(np.linspace(5, 634, 40), np.linspace(5, 474, 30)), -1)
    end = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 1000, 1e-12)
    rays = cv2.undistortPointsIter(grid.reshape(-1, 1, 2), *truth, None, None, end).reshape(-1, 2)
    rays = np.hstack([rays, np.ones((len(rays), 1))])
    project = lambda m, d: cv2.projectPoints(rays, np.zeros(3), np.zeros(3), m, d)[0]
    expect("pinhole: distortion, of the width", widest_error((matrix, k.ravel()), truth, project)
           / 640, 1e-3)


def calibrate_fisheye():
    k = np.array([0.03, -0.012, 0.004, -0.001])
    truth = (np.array([[260, 0, 318.25], [0, 262, 241.5], [0, 0, 1]]), k)
    model = "camera,projection=fisheye,pixels=640,480,fx=260,fy=262,cx=318.25,cy=241.5," \
        "distortion=fisheye,coefficients=" + ",".join(map(str, k))
    views = [find_board(p) for p in
             photos("room.env", model, board_poses(0.9, 1.0, 0.5, 0.3), "--samples", "9", name="fish")]
    seen = [v for v in views if v is not None]
    print(len(seen), "of", len(views), "boards found")
    if len(seen) < 10:
        sys.exit("FAILED: chessboards are not found by a fisheye")
    matrix, d = np.eye(3), np.zeros((4, 1))
    error, matrix, d, _, _ = cv2.fisheye.calibrate(
        [board_points().reshape(1, -1, 3)] * len(seen), [v.reshape(1, -1, 2) for v in seen], SIZE,
        matrix, d, flags=cv2.fisheye.CALIB_RECOMPUTE_EXTRINSIC | cv2.fisheye.CALIB_FIX_SKEW)
    expect("fisheye: mean error of corners, pixels", error, 0.1)
    expect("fisheye: fx", abs(matrix[0, 0] / 260 - 1), 1e-3)
    expect("fisheye: fy", abs(matrix[1, 1] / 262 - 1), 1e-3)
    expect("fisheye: centre, of the width", np.hypot(matrix[0, 2] - 318.25, matrix[1, 2] - 241.5)
           / 640, 1e-3)
    angles = np.radians(np.linspace(1, 65, 30))
    around = np.linspace(0, 2 * np.pi, 36, endpoint=False)
    rays = np.array([[[np.tan(a) * np.cos(b), np.tan(a) * np.sin(b)]]
                     for a in angles for b in around])
    project = lambda m, c: cv2.fisheye.distortPoints(rays, m, c)
    expect("fisheye: distortion, of the width",
           widest_error((matrix, d.ravel()), truth, project) / 640, 1e-3)


write_board()
calibrate_pinhole()
calibrate_fisheye()
