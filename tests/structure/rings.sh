#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The fence between the rings of the house, see rings.py.
. "$(dirname "$0")/../pipelines/common.sh"

python3 -B "$source_dir/tests/structure/rings.py" "$source_dir"
