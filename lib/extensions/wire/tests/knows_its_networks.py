# SPDX-License-Identifier: GPL-3.0-or-later
"""Device ports know no password: only this machine and the networks of --allow may use them."""
import os
import pathlib
import socket

from device_run import SCENES, Run, check, scratch, skip

LASER = "#3dm 1\nlaser id=l1 model=urg-04lx at=0,0\n"


def own_address():
    """Of a network, not the loopback one."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # sends no byte
            return probe.getsockname()[0]
        except OSError:
            skip("this machine has no network")


def answer(address, port):
    """Reads a laser's answer there, up to its end or that of the connection."""
    said = b""
    with socket.create_connection((address, port), timeout=30) as client:
        try:
            client.sendall(b"QT\n")
            while not said.endswith(b"\n\n"):
                some = client.recv(100)
                if not some:
                    break
                said += some
        except (ConnectionResetError, BrokenPipeError):
            pass
    return said


def main():
    own = own_address()
    pathlib.Path("laser.3dm").write_text(LASER)
    for allowed, wanted in (("203.0.113.0/24", b""), (own, b"QT\n00P\n\n"),
                            (own.rsplit(".", 1)[0] + ".0/24", b"QT\n00P\n\n")):
        with Run(SCENES / "ispace.env", "laser.3dm", "--scip", "l1=0.0.0.0:0",
                 "--allow", allowed) as run:
            port = run.ports["scip"]["l1"][1]
            said = answer(own, port)
            check(said == wanted, f"from {own}, where {allowed} is allowed: {said}")
            check(answer("127.0.0.1", port) == b"QT\n00P\n\n", "this machine is refused")


if __name__ == "__main__":
    with scratch() as folder:
        os.chdir(folder)
        main()
