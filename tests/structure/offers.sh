#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Each extension lists what it offers, for builds without it: offers.py.
. "$(dirname "$0")/../pipelines/common.sh"
python3 "$source_dir/tests/structure/offers.py" "$source_dir" "$(dirname "$(command -v envc)")"
