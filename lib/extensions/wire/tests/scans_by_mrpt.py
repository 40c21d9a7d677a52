# SPDX-License-Identifier: GPL-3.0-or-later
"""MRPT's rawlog-grabber records scans of simulated Hokuyos and a SICK as of real ones: its ranges are those of `scan`
at the same poses, to the millimetre of SCIP and CoLa."""
import json
import math
import pathlib
import subprocess
import time

from device_run import SCENES, Run, check, need, scratch

LAYOUT = """#3dm 1
laser id=urg model=urg-04lx at=0.3,-0.2 heading=40
laser id=utm model=utm-30lx at=-1,0.5 heading=-100
laser id=lms model=lms100 at=1,0 heading=80
"""
INI = """[global]
rawlog_prefix = {name}
time_between_launches = 10
use_sensoryframes = 0
GRABBER_PERIOD_MS = 100

[LASER]
driver = {driver}
process_rate = {rate}
sensorLabel = {name}
IP_DIR = {host}
PORT_DIR = {port}
ip_address = {host}
TCP_port = {port}
maxRange = 20
pose_x = 0
pose_y = 0
pose_z = 0
pose_yaw = 0
pose_pitch = 0
pose_roll = 0
"""
RATES = {"urg": 10, "utm": 40, "lms": 25}
# Seconds: it takes 16 to begin with a SICK, whatever that says, and then asks for each scan. A busy machine
# gets more.
PATIENCE = (20, 60, 180)
LEAST = 10  # scans


def grab(name, address):
    pathlib.Path(name + ".ini").write_text(INI.format(
        name=name, driver="CLMS100Eth" if name == "lms" else "CHokuyoURG",
        rate=25 if name == "lms" else 200, host=address[0], port=address[1]))
    # It ends when its standard input does.
    return subprocess.Popen(["rawlog-grabber", name + ".ini"], stdin=subprocess.PIPE,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def recorded(name):
    """The scans of its rawlog, as rows of text with three decimals."""
    (log,) = pathlib.Path().glob(name + "_*.rawlog")
    subprocess.run(["rawlog-edit", "-q", "--export-2d-scans-txt", "-i", log], check=True,
                   stdout=subprocess.DEVNULL)
    tables = list(pathlib.Path().glob(name + "_*.txt"))  # one file, or no file without scans
    lines = [line for table in tables for line in table.read_text().splitlines()]
    rows = [line.split() for line in lines if not line.startswith("%")]
    return [(float(row[0]), row[1:]) for row in rows]


def computed():
    """The scans of `scan`, in whole millimetres; None is no return."""
    text = subprocess.run(["scan", SCENES / "ispace.env", "lasers.3dm"], check=True, text=True,
                          capture_output=True).stdout
    scans = {}
    for line in text.splitlines()[1:]:
        scan = json.loads(line)
        scans[scan["sensor"]] = [None if r is None else math.floor(r * 1000 + 0.5)
                                 for r in scan["ranges"]]
    return scans


def compare(name, scans, expected):
    returns = sum(mm is not None for mm in expected)
    check(returns > len(expected) / 2, f"{name}: a scan without walls")
    for _, row in scans:
        ranges, valid = row[:len(expected)], row[len(expected):]
        check(len(valid) == len(expected), f"{name}: {len(row)} columns, not {2 * len(expected)}")
        for beam, (mm, found, is_valid) in enumerate(zip(expected, ranges, valid)):
            wanted = "none" if mm is None else f"{mm / 1000:.3f}"
            # A SICK's number for no return is 0, which MRPT takes for a range.
            got = found if float(is_valid) and found != "0.000" else "none"
            check(got == wanted, f"{name}: beam {beam} is {got}, and {wanted} by scan")
    print(f"{name}: {len(scans)} scans of {len(expected)} beams, {returns} returns, "
          f"a scan each {1000 * period(scans):.1f} ms: as scan has them, to the millimetre")


def period(scans):
    return (scans[-1][0] - scans[0][0]) / (len(scans) - 1)


def keeps_time(name, scans):
    # Scans of a SICK come when they are asked for.
    return len(scans) >= LEAST and (name == "lms" or abs(period(scans) * RATES[name] - 1) < 0.2)


def grab_all(patience):
    """The scans of each sensor that are recorded within that many seconds."""
    for old in pathlib.Path().glob("*_*.*"):
        old.unlink()
    with Run(SCENES / "ispace.env", "lasers.3dm", "--scip", "urg=0",
             "--scip", "utm=127.0.0.2:0", "--cola", "lms=0") as run:
        ports = run.ports["scip"] | run.ports["cola"]
        grabbers = [grab(name, ports[name]) for name in RATES]
        time.sleep(patience)
        for grabber in grabbers:
            said = grabber.communicate(timeout=60)[0]
            check("Closing" in said, "rawlog-grabber: " + said)
    return {name: recorded(name) for name in RATES}


def main():
    need("rawlog-grabber", "rawlog-edit")
    pathlib.Path("lasers.3dm").write_text(LAYOUT)
    expected = computed()
    for patience in PATIENCE:
        found = grab_all(patience)
        late = [name for name, scans in found.items() if not keeps_time(name, scans)]
        if not late:
            break
        counts = ", ".join(f"{len(found[name])} of {name}" for name in late)
        print(f"too few scans in {patience} s, or too far apart: {counts}")
    check(not late, "nor in more time")
    for name, scans in found.items():
        compare(name, scans, expected[name])


if __name__ == "__main__":
    import os
    with scratch() as folder:
        os.chdir(folder)
        main()
