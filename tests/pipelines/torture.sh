#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Torture finds tools with bytes that differ from run to run, and tools that leave half a file after a kill.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"

torture=$source_dir/tests/torture/run.py
mkdir -p bad/bin
for tool in $tools; do
    ln -s "$(command -v "$tool")" "bad/bin/$tool"
done

# bad_envc SCRIPT: envc is that script, in which $tool is the real one.
bad_envc() {
    rm -f bad/bin/envc
    printf '#!/usr/bin/env bash\ntool=%q\n%s\n' "$(command -v envc)" "$1" >bad/bin/envc
    chmod +x bad/bin/envc
}

# expect_violation PART MESSAGE: that part fails, and reports this violation.
expect_violation() {
    expect_status 1 python3 "$torture" --build bad --minutes 0.1 --seed 1 --only "$1"
    grep -q "^torture: $1: VIOLATED: .*$2" out || fail "$1 has not noticed: $(cat out)"
    grep -q "^torture: repeat by: .* --seed 1 --only $1$" out || fail "$1 is not to be repeated: $(cat out)"
}

bad_envc '"$tool" "$@" || exit; [ ! -e room.out.glb ] || date +%N >>room.out.glb'
expect_violation same_bytes "product .* with -j"
bad_envc 'case $* in *room.out.glb*) printf half >room.out.glb; sleep 0.05;; esac; exec "$tool" "$@"'
expect_violation kills "neither the old file nor the new one"
