#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Options refuse wrong values by their rows: wrong_values.py.
. "$(dirname "$0")/../pipelines/common.sh"
python3 "$source_dir/tests/structure/wrong_values.py" "$(dirname "$(command -v envc)")"
