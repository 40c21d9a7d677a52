#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""judge_tracks.py TRACKS.csv RECORD [--near M]: how well a tracker does, against the record of simrun.

Prints, for each source of tracks, the errors of places, how much of the time each person or robot was followed, how
often they got another track than before (identity switches, as the CLEAR MOT metrics count them: Bernardin and
Stiefelhagen, 2008), and how often a track went over from one of them to another. Standard library alone.
"""

import argparse
import csv
import dataclasses
import math
import os
import sys

NEAR = 0.5  # m: farther tracks do not follow a person


@dataclasses.dataclass
class Verdict:
    """Errors and counts of the tracks of one source."""

    errors: list = dataclasses.field(default_factory=list)  # m
    present: int = 0  # times with a person present
    switches: int = 0
    false: int = 0  # times of tracks without a person
    handovers: int = 0  # times a track that was of one is of another

    @property
    def followed(self):
        return len(self.errors) / self.present if self.present else 0.0

    @property
    def mean(self):
        return sum(self.errors) / len(self.errors) if self.errors else math.nan

    @property
    def percentile95(self):
        ordered = sorted(self.errors)
        return ordered[max(0, math.ceil(0.95 * len(ordered)) - 1)] if ordered else math.nan


def read_truth(folder):
    """{milliseconds: {id: (x, y)}} of a record."""
    truth = {}
    for name in ("robots.csv", "people.csv"):
        if os.path.exists(os.path.join(folder, name + ".zst")):
            sys.exit(f"judge_tracks.py: {folder} is compressed: unzstd --rm {folder}/*.zst")
        with open(os.path.join(folder, name), encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                at = round(1000 * float(row["t"]))
                truth.setdefault(at, {})[row["id"]] = float(row["x"]), float(row["y"])
    return truth


def read_tracks(path):
    """{source: {milliseconds: {track: (x, y)}}}."""
    tracks = {}
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            source = tracks.setdefault(row["source"], {})
            at = round(1000 * float(row["t"]))
            source.setdefault(at, {})[row["track"]] = float(row["x"]), float(row["y"])
    return tracks


def match(truth, tracks, before, near):
    """Maps people to tracks: as before while that is still right, else the nearest first."""
    found = {}
    for who, track in before.items():
        if who in truth and track in tracks and track not in found.values():
            if math.dist(truth[who], tracks[track]) <= near:
                found[who] = track
    pairs = sorted((math.dist(truth[who], tracks[track]), who, track) for who in truth for track in tracks)
    for off, who, track in pairs:
        if off <= near and who not in found and track not in found.values():
            found[who] = track
    return found


def judge(truth, sources, name, near=NEAR, begin=0.0):
    """Computes the Verdict on one source; times before `begin`, in seconds, do not count. A source without a track at
    a time at which another has one follows no person then."""
    verdict, last, owner = Verdict(), {}, {}
    for at in sorted(set().union(*sources.values())):
        if at < 1000 * begin or at not in truth:
            continue
        tracks = sources[name].get(at, {})
        found = match(truth[at], tracks, last, near)
        verdict.present += len(truth[at])
        verdict.false += len(tracks) - len(found)
        for who, track in found.items():
            verdict.errors.append(math.dist(truth[at][who], tracks[track]))
            if last.get(who, track) != track:
                verdict.switches += 1
            last[who] = track
        for track, place in tracks.items():
            who = min(truth[at], key=lambda one: math.dist(truth[at][one], place))
            if math.dist(truth[at][who], place) <= near / 2:
                verdict.handovers += owner.get(track, who) != who
                owner[track] = who
    return verdict


def main():
    parser = argparse.ArgumentParser(description="how well a tracker does, against the record of simrun")
    parser.add_argument("tracks")
    parser.add_argument("record")
    parser.add_argument("--near", type=float, default=NEAR, help="farther away nobody is followed (m)")
    parser.add_argument("--begin", type=float, default=3, help="seconds that do not count")
    args = parser.parse_args()
    try:
        truth, sources = read_truth(args.record), read_tracks(args.tracks)
    except OSError as error:
        print(f"judge_tracks.py: {error.filename}: {error.strerror}", file=sys.stderr)
        return 1
    except (KeyError, TypeError, ValueError) as error:  # a column is not there, or no number
        print(f"judge_tracks.py: {args.tracks} or {args.record} is not what tracker or simrun writes: {error}",
              file=sys.stderr)
        return 1
    for source in sorted(sources):
        verdict = judge(truth, sources, source, args.near, args.begin)
        print(f"{source}: error {verdict.mean:.3f} m in the mean, {verdict.percentile95:.3f} m at 95 %; followed "
              f"{100 * verdict.followed:.1f} %; {verdict.switches} identity switches, tracks went over {verdict.handovers} times, "
              f"{verdict.false} false places")
    return 0


if __name__ == "__main__":
    sys.exit(main())
