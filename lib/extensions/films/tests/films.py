#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Films of a record, opened by OpenCV (FFmpeg, libpng): the same pictures in all three formats."""
import os
import subprocess
import sys
import tempfile

try:
    import cv2
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

DATA = os.path.join(os.environ["ISPACE_SOURCE_DIR"], "tests", "data")
FPS, SECONDS = 8, 3


def check(holds, what):
    if not holds:
        sys.exit(f"FAILED: {what}")


def simrun(*arguments):
    subprocess.run(["simrun", *arguments], stdout=subprocess.DEVNULL, check=True)


def film(name):
    """Its pictures, and how many it shows a second."""
    video = cv2.VideoCapture(name)
    check(video.isOpened(), f"{name} cannot be opened")
    pictures = []
    while True:
        there, picture = video.read()
        if not there:
            return pictures, video.get(cv2.CAP_PROP_FPS)
        pictures.append(picture.astype(int))


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open("drive.txt", "w", encoding="ascii") as script:
        script.write("0 r1 SPEED 0.5\n1 r2 FORWARD 0.5\n")
    simrun(os.path.join(DATA, "square.env"), os.path.join(DATA, "session.3dm"), "--clock", "fast",
           "--until", str(SECONDS), "--script", "drive.txt", "--record", "run")
    for name in ("run.gif", "run.y4m", "run-%04d.png"):
        simrun("--replay", "run", "-o", name, "--fps", str(FPS), "--width", "400")
    pictures, _ = film("run-%04d.png")
    gif, gif_rate = film("run.gif")
    y4m, y4m_rate = film("run.y4m")
count = FPS * SECONDS + 1
check(len(pictures) == len(gif) == len(y4m) == count,
      f"{len(pictures)} PNGs, {len(gif)} and {len(y4m)} pictures, wanted {count}")
# A GIF has whole hundredths of a second, here 12 and 13 in turn; FFmpeg 7 takes the first.
check(abs(gif_rate - FPS) < 0.5 and abs(y4m_rate - FPS) < 0.01, f"{gif_rate}, {y4m_rate} a second")
check((pictures[0] != pictures[-1]).any(), "nobody moves")
for k, (true, of_gif, of_y4m) in enumerate(zip(pictures, gif, y4m)):
    check(true.shape == of_gif.shape == of_y4m.shape, f"picture {k}: {of_gif.shape}")
    # Of a GIF flat colours are right, and shades between them nearly so.
    same = (true == of_gif).all(axis=2).mean()
    check(same > 0.97, f"picture {k} of the GIF: only {same:.1%} of its pixels are right")
    check(np.abs(true - of_gif).max() < 40, f"picture {k} of the GIF has a wrong colour")
    off = np.abs(true - of_y4m).mean()
    check(off < 4, f"picture {k} of the YUV4MPEG2 is {off:.1f} off")
