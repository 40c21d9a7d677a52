# SPDX-License-Identifier: GPL-3.0-or-later
"""Requests of laser drivers until their first scan, byte for byte by their sources, each after the reply to the one
before: no reply rejects one, and scans come. hokuyolx itself runs if installed."""
import importlib.util
import os
import pathlib
import socket

from device_run import SCENES, Run, check, scratch

LAYOUT = """#3dm 1
laser id=urg model=urg-04lx at=0.3,-0.2 heading=40
laser id=ust model=ust-10lx at=-1,0.5
laser id=ew model=utm-30lx-ew at=-1,0.5 heading=-100
laser id=lms model=lms111 at=1,0 heading=80
laser id=tim model=tim551 at=1,1
"""
# The first scan is the answer to the last request, or comes after it.
SCIP = {
    ("hokuyolx", "ust"): "%ST TM0 TM1 TM1 TM2 PP BM GD0000108000 ME0000108000002",
    ("urg_library, get_multiecho", "ew"): "QT PP ND0000108001010",
    ("urg_library, get_multiecho_intensity", "ew"): "QT PP BM HE0000108001",
    ("urg_library, get_distance", "urg"): "QT PP MD0044072501010",
    ("urg_node", "ew"): "QT PP VV II ME0000108001001 QT ND0000108001001 QT TM0 TM1 TM2 MD0000108001000",
}
PASSWORD = b"sMN SetAccessMode \x03\xf4\x72\x47\x44"
SECTOR = bytes.fromhex("0001 00001388 fff92230 00225510")
COLA_A = {
    ("LMS1xx", "lms"): ["sMN SetAccessMode 03 F4724744", "sRN LMPscancfg", "sRN LMPoutputRange",
                        "sWN LMDscandatacfg 01 00 1 1 0 00 00 0 0 0 0 +1", "sMN LMCstartmeas",
                        "sRN STlms", "sMN Run", "sEN LMDscandata 1"],
    ("sick_tim", "tim"): ["sRI0", "sRN SerialNumber", "sRN FirmwareVersion", "sRN SCdevicestate",
                          "sEN LMDscandata 1"],
}
SICK_SCAN = [b"sRN SCdevicestate", PASSWORD, b"sWN EIHstCola \x01", b"sRN FirmwareVersion",
             b"sRN SCdevicestate", b"sRN ODoprh", b"sRN ODpwrc", b"sRN LocationName"]
COLA_B = {
    ("sick_scan_xd, sick_lms_1xx.launch", "lms"):
        SICK_SCAN + [b"sRN LMPoutputRange", b"sWN LMPoutputRange " + SECTOR, b"sRN LMPoutputRange"] +
        [b"sRN field%03d" % i for i in range(30)] +
        [b"sRN LIDinputstate", b"sWN LMDscandatacfg " + bytes.fromhex("01000000 000000000000 01 0001"),
         b"sRN LMDscandatacfg", b"sMN mLMPsetscancfg " + bytes.fromhex("00001388") + SECTOR,
         b"sRN LMPscancfg", b"sEN LFErec \x01", b"sEN LIDoutputstate \x01", b"sEN LIDinputstate \x01",
         b"sMN LMCstartmeas", b"sMN Run", b"sRN SCdevicestate", b"sEN LMDscandata \x01"],
    ("sick_scan_xd, sick_tim_5xx.launch", "tim"):
        SICK_SCAN + [b"sRN LMPoutputRange",
                     b"sWN LMPoutputRange " + bytes.fromhex("0001 00002710 fff92230 00225510"),
                     b"sRN LMPoutputRange",
                     b"sWN LMDscandatacfg " + bytes.fromhex("01000101 000000000000 01 0001"),
                     b"sRN LMDscandatacfg", b"sMN LMCstartmeas", b"sMN Run", b"sEN LMDscandata \x01"],
}


def read_scip(stream):
    lines = []
    while not lines or lines[-1] != b"\n":
        lines.append(stream.readline())
        check(lines[-1], "the connection ended")
    return lines


def start_scip(client, stream, requests):
    for request in requests.split():
        stream.write(request.encode() + b"\n")
        stream.flush()
        lines = read_scip(stream)
        while lines[0] != request.encode() + b"\n" or lines[1][:2] == b"99":
            lines = read_scip(stream)  # a scan of the stream that this request ends
        check(lines[1][:2] == b"00", f"{client}: {request} is answered {lines[1]}")
    if request[0] in "MN":
        lines = read_scip(stream)
        check(lines[1] == b"99b\n", f"{client}: {lines[:2]} in place of a scan")
    check(len(lines) > 30, f"{client}: a scan of {len(lines)} lines")


def read_cola(stream, is_binary):
    if not is_binary:
        text = b""
        while not text.endswith(b"\x03"):
            text += stream.read(1)
        return text[1:-1]
    head = stream.read(8)
    check(head[:4] == b"\2\2\2\2", "no telegram")
    content = stream.read(int.from_bytes(head[4:], "big") + 1)
    return content[:-1]


def start_cola(client, stream, requests, is_binary):
    for request in requests:
        content = request if is_binary else request.encode()
        size = len(content).to_bytes(4, "big")
        parity = 0
        for byte in content:
            parity ^= byte
        stream.write(b"\2\2\2\2" + size + content + bytes([parity]) if is_binary
                     else b"\2" + content + b"\3")
        stream.flush()
        kind, name = content[1:3], content.split(b" ")[-1 if content.startswith(b"sRI") else 1:][:1]
        wanted = {b"RN": b"sRA", b"RI": b"sRA", b"WN": b"sWA", b"MN": b"sAN", b"EN": b"sEA"}[kind]
        answer = read_cola(stream, is_binary)
        check(answer.startswith(wanted) and (kind == b"RI" or name[0] in answer),
              f"{client}: {content} is answered {answer}")
    scan = read_cola(stream, is_binary)
    check(scan.startswith(b"sSN LMDscandata "), f"{client}: {scan[:16]} in place of a scan")


def run_hokuyolx(where, scans_of):
    if importlib.util.find_spec("hokuyolx") is None:
        return print("no hokuyolx here")
    from hokuyolx import HokuyoLX
    laser = HokuyoLX(addr=where)
    check(laser.model == scans_of and laser.laser_state()[0] == 3, "hokuyolx: " + laser.model)
    check(len(laser.get_dist()[1]) == 1081 and laser.get_intens()[1].shape == (1081, 2), "hokuyolx: short scans")
    check([pending for _, _, pending in laser.iter_dist(5)] == [4, 3, 2, 1, 0], "hokuyolx: no stream")
    laser.sleep()
    check(laser.laser_state()[0] == 5, "hokuyolx: it does not sleep")
    laser.close()
    return print("hokuyolx runs with a", scans_of)


def main():
    pathlib.Path("lasers.3dm").write_text(LAYOUT)
    ports = [argument for one in ("urg", "ust", "ew") for argument in ("--scip", one + "=0")]
    ports += [argument for one in ("lms", "tim") for argument in ("--cola", one + "=0")]
    with Run(SCENES / "ispace.env", "lasers.3dm", *ports) as run:
        where = run.ports["scip"] | run.ports["cola"]
        for clients, start in ((SCIP, start_scip),
                               (COLA_A, lambda *all: start_cola(*all, False)),
                               (COLA_B, lambda *all: start_cola(*all, True))):
            for (client, laser), requests in clients.items():
                with socket.create_connection(where[laser], timeout=30) as connection:
                    start(client, connection.makefile("rwb"), requests)
                print(client, "starts")
        run_hokuyolx(where["ust"], "UST-10LX")
        run_hokuyolx(where["ew"], "UTM-30LX-EW")


if __name__ == "__main__":
    with scratch() as folder:
        os.chdir(folder)
        main()
