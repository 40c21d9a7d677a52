# SPDX-License-Identifier: GPL-3.0-or-later
"""ispace-sweep: one file describes many jobs; lists them for make, parallel, Slurm and others, and merges their
results into a table and a picture. Requires Python's standard library and PyYAML; pictures require matplotlib."""
