# SPDX-License-Identifier: GPL-3.0-or-later
"""ispace-sweep: one file describes many jobs; lists them for make, parallel, Slurm and others, and joins
what they wrote into a table and a picture. Uses Python's standard library and PyYAML; pictures need
matplotlib."""
