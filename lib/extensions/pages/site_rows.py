# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
import struct
import zlib

from words import LASERS, SENSOR


def png():
    """Returns a small picture, the logo."""

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = b"".join(b"\0" + bytes([40 * y, 90, 160] * 6) for y in range(6))
    head = struct.pack(">IIBBBBB", 6, 6, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


FILES = {
    "logo.png": png(),
    "prices.csv": "item,price EUR\nurg-04lx,1500\ndome-2.8-1080p,200\n",
}
OPTIONS = {
    "arrange": {
        "--title": f"--title Hall --report page.html {LASERS}",
        "--project": f"--project Hall --report page.html {LASERS}",
        "--client": f"--client Ann --report page.html {LASERS}",
        "--author": f"--author Ann --report page.html {LASERS}",
        "--logo": f"--logo logo.png --report page.html {LASERS}",
        "--paper": f"--paper letter --report page.html {LASERS}",
        "--prices": f"--prices prices.csv --material list.csv {SENSOR}",
        "--material": f"--material list.csv {SENSOR}",
    },
    "coverage": {
        "--title": "--title Hall --report page.html",
        "--project": "--project Hall --report page.html",
        "--client": "--client Ann --report page.html",
        "--author": "--author Ann --report page.html",
        "--logo": "--logo logo.png --report page.html",
        "--paper": "--paper letter --report page.html",
        "--prices": "--prices prices.csv --material list.csv",
        "--material": "--material list.csv",
    },
}
