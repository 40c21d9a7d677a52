# SPDX-License-Identifier: GPL-3.0-or-later
"""MRPT's rawlog-grabber records scans of simulated Hokuyos and a SICK as of real ones: its ranges are
those that `scan` takes from the same places, to the millimetre of SCIP and CoLa."""
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
# It takes 16 s to begin with a SICK, whatever that says, and then asks for each scan.
PATIENCE = 20


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
    (table,) = pathlib.Path().glob(name + "_*.txt")
    rows = [line.split() for line in table.read_text().splitlines() if not line.startswith("%")]
    return [(float(row[0]), row[1:]) for row in rows]


def computed():
    """The scans that `scan` takes, in whole millimetres; None is no return."""
    text = subprocess.run(["scan", SCENES / "ispace.env", "lasers.3dm"], check=True, text=True,
                          capture_output=True).stdout
    scans = {}
    for line in text.splitlines()[1:]:
        scan = json.loads(line)
        scans[scan["sensor"]] = [None if r is None else math.floor(r * 1000 + 0.5)
                                 for r in scan["ranges"]]
    return scans


def compare(name, expected):
    scans = recorded(name)
    # It takes a while to begin, longer on a busy machine.
    check(len(scans) >= 10, f"{name}: {len(scans)} scans in {PATIENCE} s")
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
    gaps = [later - earlier for (earlier, _), (later, _) in zip(scans, scans[1:])]
    period = sum(gaps) / len(gaps)
    # Scans of a SICK come when they are asked for.
    check(name == "lms" or abs(period * RATES[name] - 1) < 0.2, f"{name}: a scan each {period:.4f} s")
    print(f"{name}: {len(scans)} scans of {len(expected)} beams, {returns} returns, "
          f"a scan each {1000 * period:.1f} ms: as scan has them, to the millimetre")


def main():
    need("rawlog-grabber", "rawlog-edit")
    pathlib.Path("lasers.3dm").write_text(LAYOUT)
    with Run(SCENES / "ispace.env", "lasers.3dm", "--scip", "urg=0",
             "--scip", "utm=127.0.0.2:0", "--cola", "lms=0") as run:
        ports = run.ports["scip"] | run.ports["cola"]
        grabbers = [grab(name, ports[name]) for name in RATES]
        time.sleep(PATIENCE)
        for grabber in grabbers:
            said = grabber.communicate(timeout=60)[0]
            check("Closing" in said, "rawlog-grabber: " + said)
    expected = computed()
    for name in RATES:
        compare(name, expected[name])


if __name__ == "__main__":
    import os
    with scratch() as folder:
        os.chdir(folder)
        main()
