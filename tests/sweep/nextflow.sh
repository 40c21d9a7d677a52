#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/batch with Nextflow, which Debian does not have: skipped unless installed.
. "$(dirname "$0")/batch.sh"

nextflow -version >/dev/null 2>&1 || skip "no nextflow"
set_up flow
(cd flow && NXF_OFFLINE=true nextflow run main.nf >../out 2>../err) || fail "$(cat out err)"
expect_single flow
