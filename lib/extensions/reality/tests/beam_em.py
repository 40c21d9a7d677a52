#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""beam_em.py BEAMS.csv: the beam model of Thrun, Burgard and Fox (Probabilistic Robotics, 6.3) by expectation
maximisation, apart from ispace: one sigma, a bias, no edges. Reads the table of `scan --against LOG -o BEAMS.csv`, fits
the model to even scans and prints the mean log-likelihood of the odd ones. Needs numpy."""
import csv
import sys

import numpy as np


def read(path):
    rows = []
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if row["expected"] and row["range_max"]:
                rows.append((int(row["scan"]), float(row["measured"] or "inf"), float(row["expected"]),
                             float(row["range_max"])))
    table = np.array(rows)
    margin = 0.05  # simulated ranges next to the limit tell nothing
    return table[table[:, 2] < table[:, 3] - margin]


def parts(z, expected, limit, model):
    """Densities of hit, short, max and random, without their weights."""
    is_return = np.isfinite(z) & (z < limit)
    safe = np.where(is_return, z, 0)
    hit = np.exp(-0.5 * ((safe - expected - model["bias"]) / model["sigma"]) ** 2) / (
        model["sigma"] * np.sqrt(2 * np.pi))
    short = np.where(safe < expected, model["lambda"] * np.exp(-model["lambda"] * safe) /
                     (1 - np.exp(-model["lambda"] * expected)), 0)
    zero = np.zeros_like(expected)
    return np.stack([np.where(is_return, hit, zero), np.where(is_return, short, zero),
                     np.where(is_return, zero, 1), np.where(is_return, 1 / limit, zero)])


def fit(z, expected, limit, rounds=300):
    model = {"weights": np.array([0.7, 0.1, 0.1, 0.1]), "sigma": 0.2, "bias": 0.0, "lambda": 0.5}
    for _ in range(rounds):
        shares = model["weights"][:, None] * parts(z, expected, limit, model)
        shares /= shares.sum(0)
        model["weights"] = shares.mean(1)
        hit, short = shares[0], shares[1]
        # Beams without return have no share of hits.
        off = np.where(np.isfinite(z), z - expected, 0)
        model["bias"] = (hit * off).sum() / hit.sum()
        model["sigma"] = np.sqrt((hit * (off - model["bias"]) ** 2).sum() / hit.sum())
        total = (short * np.where(np.isfinite(z), z, 0)).sum()
        if total > 0:
            model["lambda"] = max(short.sum() / total, 1e-3)
    return model


table = read(sys.argv[1])
even = table[table[:, 0] % 2 == 0][:, 1:].T
odd = table[table[:, 0] % 2 == 1][:, 1:].T
found = fit(*even)
density = (found["weights"][:, None] * parts(*odd, found)).sum(0)
print(f"{np.log(np.maximum(density, 1e-12)).mean():.4f} {odd.shape[1]} beams, sigma {found['sigma']:.4f}, "
      f"bias {found['bias']:.4f}")
