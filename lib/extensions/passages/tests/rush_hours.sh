#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Twenty hours of eight robots and twenty people on three storeys: all arrive at each of their goals.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

"$ISPACE_BINARY_DIR/tests/passages_test" --gtest_also_run_disabled_tests \
    --gtest_filter='*.DISABLED_EverybodyArrivesInTwentyRushHours' >said || fail "$(cat said)"
