#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""share.py [SCHEDULER]: eight shares of the sweep on the workers of a Dask cluster (tcp://HOST:PORT; without it two
processes of this machine), which share the folder; then the table. A share whose worker dies continues on another."""

import os
import subprocess
import sys

from dask.distributed import Client

SHARES = 8


def share(index, folder):
    subprocess.run(["ispace-sweep", "run", "sweep.yaml", "--shard", f"{index}/{SHARES}", "-j", "1", "-q",
                    "-o", f"part{index}.jsonl"], cwd=folder, check=True)
    return index


if __name__ == "__main__":
    cluster = {"address": sys.argv[1]} if len(sys.argv) > 1 else {"n_workers": 2, "threads_per_worker": 1,
                                                                  "dashboard_address": None}
    with Client(**cluster) as client:
        client.gather(client.map(share, range(1, SHARES + 1), folder=os.getcwd(), pure=False))
    subprocess.run(["ispace-sweep", "join", *(f"part{i}.jsonl" for i in range(1, SHARES + 1)), "-o", "table.csv"],
                   check=True)
