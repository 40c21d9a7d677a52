#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The Python module as others get it: installed by CMake, and as a wheel, which is built without any
# network; and its types.
. "$(dirname "$0")/../pipelines/common.sh"

python=/usr/bin/python3
[ -x "$python" ] || python=python3
unset PYTHONPATH

# check FOLDER: the module is there, with its types, and drives a robot.
check() {
    cat >use.py <<'END'
import sys
from pathlib import Path

import ispace

assert str(Path(ispace.__file__).parent.parent) == sys.argv[1], ispace.__file__
assert (Path(ispace.__file__).parent / "py.typed").exists()
with ispace.simrun(sys.argv[2] + "/square.env", sys.argv[2] + "/session.3dm", clock="step") as run:
    with run.robot("r1") as robot, run.world() as world:
        motion = robot.forward(0.25)
        world.advance(5)
        assert robot.wait(motion).done
END
    PYTHONPATH=$1 PYTHONDONTWRITEBYTECODE=1 "$python" -W error use.py "$1" "$data" || fail "not usable from $1"
}

cmake --install "$binary_dir" --prefix "$scratch/prefix" >log
folder=$(find prefix -type d -name ispace -path '*dist-packages*')
[ -n "$folder" ] || fail "not installed"
check "$scratch/${folder%/ispace}"
# The lines of the page for a prefix that Python does not search.
sed -n '/^    export PATH=\$prefix/,/^$/s/^    //p' "$source_dir/docs/install.md" >lines
[ "$(wc -l <lines)" -eq 3 ] || fail "docs/install.md has other lines: $(cat lines)"
(
    export prefix=$scratch/prefix
    # shellcheck disable=SC1091
    . ./lines
    cd scenes
    "$python" -B -c 'import ispace; print(ispace.coverage("crowded.env", ispace.arrange("crowded.env", sensor="urg-04lx:1")))'
    [ "$(command -v arrange)" = "$prefix/bin/arrange" ]
) >log 2>&1 || fail "the lines of docs/install.md: $(cat log)"
for name in "" scenes/crowded.env examples/shares examples/rules examples/ci-github.yaml; do
    [ -e "prefix/share/ispace/$name" ] || fail "no share/ispace/$name"
done
if find prefix -name '*.pyc' | grep .; then fail "compiled files are installed"; fi
# For /usr it goes into the folder of Debian's own packages, whatever prefix was configured.
DESTDIR=$scratch/usr cmake --install "$binary_dir" --prefix /usr >log
[ -e usr/usr/lib/python3/dist-packages/ispace/__init__.py ] || fail "elsewhere: $(find usr -name __init__.py)"

if command -v mypy >/dev/null; then
    # Strict by any configuration, with numpy where it is installed; and so is a program that uses it.
    mkdir typed
    cp -r "$source_dir/lib/client/python/ispace" typed
    cat >typed/program.py <<'END'
from typing import Optional

import ispace

share: Optional[float] = ispace.coverage("room.env", "room.3dm").coverage.exact
reveal_type(ispace.coverage("room.env").free_coverage.grid)
wrong: str = ispace.coverage("room.env").indoor_area
END
    types_of() { (cd typed && mypy --strict --config-file= --no-incremental --cache-dir=/dev/null "$@"); }
    types_of ispace >types || fail "$(cat types)"
    if types_of program.py >types; then fail "self-test: an area is a text: $(cat types)"; fi
    grep -q '^Found 1 error' types || fail "other errors: $(cat types)"
    grep -q 'Revealed type is "Union\[builtins.float, None\]"' types || fail "no type: $(cat types)"
    grep -q 'program.py:7: error: Incompatible types' types || fail "another error: $(cat types)"
else
    echo "no mypy here: types are not checked"
fi

"$python" -c 'import pip, setuptools, wheel' 2>/dev/null || { echo "no pip, setuptools and wheel here: no wheel is built"; exit 0; }
cp -r "$source_dir/lib/client/python" source
"$python" -m pip wheel --quiet --no-index --no-deps --no-build-isolation -w wheels ./source 2>wheel.err ||
    fail "no wheel: $(cat wheel.err)"
version=$(sed -n 's/^project(ispace VERSION \([^ ]*\).*/\1/p' "$source_dir/CMakeLists.txt")
[ "$(ls wheels)" = "ispace-$version-py3-none-any.whl" ] || fail "$(ls wheels)"
"$python" -m zipfile -e wheels/*.whl unpacked
check "$scratch/unpacked"
