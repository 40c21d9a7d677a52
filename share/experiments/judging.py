# SPDX-License-Identifier: GPL-3.0-or-later
"""Tracks against the truth, as share/examples/tracker/judge_tracks.py judges them, for experiments."""

import os
import statistics
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "examples", "tracker"))
import judge_tracks  # noqa: E402


class Outcome:
    """One run of the tracker on a record: the truth, the tracks and a verdict by source."""

    def __init__(self, lab, tracks, record, begin=3.0):
        self.truth = judge_tracks.read_truth(lab.path(record))
        self.tracks = judge_tracks.read_tracks(lab.path(tracks))
        self.verdicts = {source: judge_tracks.judge(self.truth, self.tracks, source, begin=begin)
                         for source in self.tracks}


def summary(lab, what, verdicts, thesis_switches=None, switches=None, mean=None,
            followed=None, most=None):
    """Rows on one source over all runs; `switches`, `mean`, `followed` in per cent and `most`, the 95th percentile of
    the errors in metres, are bounds."""
    errors = [error for verdict in verdicts for error in verdict.errors]
    present = sum(verdict.present for verdict in verdicts)
    lab.row(f"{what}: identity switches in {len(verdicts)} runs", thesis_switches,
            sum(verdict.switches for verdict in verdicts), bound=switches)
    lab.row(f"{what}: tracks that went over from one person to another", None,
            sum(verdict.handovers for verdict in verdicts), bound=switches)
    lab.row(f"{what}: people followed", None, 100 * len(errors) / present, "% of the time", digits=1,
            bound=followed)
    lab.row(f"{what}: mean error of a place", None, statistics.fmean(errors), "m", digits=3, bound=mean)
    lab.row(f"{what}: 95th percentile of the errors", None,
            statistics.quantiles(errors, n=20)[-1], "m", digits=3, bound=most)
