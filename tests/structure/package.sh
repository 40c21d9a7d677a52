#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian packages of the build: lintian reports no findings, a second run gives the same bytes, no package takes a
# name of another one, and the unpacked tools work; and the source package. `make package-check` installs them for real.
. "$(dirname "$0")/../pipelines/common.sh"

for program in dpkg-buildpackage dh dh_python3 lintian; do
    command -v "$program" >/dev/null || skip "no $program here (Debian: debhelper dh-python lintian)"
done
[ -d "$binary_dir/share/completions" ] || skip "a build with sanitizers is not packed"

# Versions go up: before a release, at it, and behind it.
if command -v git >/dev/null; then
    mkdir -p history/.ci
    cp "$source_dir/.ci/package" history/.ci
    cd history
    git init -q
    commit() {
        echo "$1" >CHANGELOG.md
        git add -A
        git -c user.name=a -c user.email=a@b.c commit -q -m "$2"
        .ci/package --version
    }
    echo 'project(ispace VERSION 1.2.0 LANGUAGES CXX)' >CMakeLists.txt
    versions="$(commit 1 'Begin 1.2.0') $(commit 2 'Add') $(commit 3 'Release 1.2.0') $(commit 4 'Add')"
    sed -i 's/1.2.0/1.3.0/' CMakeLists.txt
    versions+=" $(commit 5 'Begin 1.3.0')"
    [ "$(cut -d ' ' -f 3 <<<"$versions")" = 1.2.0 ] || fail "the version of a release: $versions"
    before=1.1.9
    for version in $versions; do
        dpkg --compare-versions "$before" lt "$version" || fail "$version is not above $before"
        before=$version
    done
    cd ..
fi

export DPKG_DEB_COMPRESSOR_TYPE=gzip DPKG_DEB_COMPRESSOR_LEVEL=1
"$source_dir/.ci/package" "$binary_dir" one >log 2>&1 || fail "$(cat log)"
LINTIAN="" "$source_dir/.ci/package" "$binary_dir" two >log 2>&1 || fail "$(cat log)"
[ "$(ls one/*.deb | wc -l)" -eq 5 ] || fail "other packages than expected: $(ls one)"
for package in one/*.deb; do
    cmp "$package" "two/${package#*/}" || fail "the second $package has other bytes"
done

mkdir root short
for package in one/*.deb; do
    case $package in
        */ispace-short-names_*) dpkg-deb -x "$package" short ;;
        *) dpkg-deb -x "$package" root ;;
    esac
done
[ "$(ls root/usr/bin | tr '\n' ' ')" = "golden-diff ispace ispace-sweep " ] || fail "in /usr/bin: $(ls root/usr/bin)"
[ "$(cd short/usr/bin && ls)" = "$(tr ' ' '\n' <<<"$tools" | sort)" ] || fail "short names: $(ls short/usr/bin)"
for tool in $tools; do
    [ -x "root/usr/lib/ispace/bin/$tool" ] || fail "no $tool"
    [ "$(readlink "root/usr/lib/ispace/bin/$tool")" = "../../../bin/ispace" ] || fail "$tool: not a link to the program"
    [ "$(readlink "short/usr/bin/$tool")" = "../lib/ispace/bin/$tool" ] || fail "$tool: not a link to the tool"
    [ -s "root/usr/share/man/man1/$tool.1ispace.gz" ] || fail "no manual page of $tool"
done
for page in man1/ispace.1 man1/ispace-sweep.1 man5/ispace-env.5 man5/ispace-3dm.5 man5/ispace-yaml.5 \
    man1/golden-diff.1 man7/ispace-protocol.7 man7/ispace-ros.7 man7/ispace-stability.7 man7/ispace-wire.7; do
    [ -s "root/usr/share/man/$page.gz" ] || fail "no page $page"
done
tools_size=$(find root/usr/bin root/usr/lib/ispace/bin -type f -printf '%s\n' | awk '{ sum += $1 } END { print int(sum / 1e6) }')
[ "$tools_size" -lt 25 ] || fail "the tools are $tools_size MB"
if found=$(grep -rlF -e "$source_dir" -e "$binary_dir" root); then fail "the build's path is in $found"; fi
dpkg-deb -f one/ispace_*.deb Recommends | has 'libopencv-imgcodecs' || fail "OpenCV's pictures are not recommended"
if [ -e "$binary_dir/lib/ispace/dds.so" ]; then
    dpkg-deb -f one/ispace_*.deb Recommends | has 'libddsc' || fail "Cyclone DDS is not recommended"
    if dpkg-deb -f one/ispace_*.deb Depends | grep ddsc; then fail "Cyclone DDS is needed"; fi
fi
dpkg-deb -f one/ispace_*.deb Depends | has 'libcairo2' || fail "Cairo, which a module links, is not needed"
if dpkg-deb -f one/ispace_*.deb Depends | grep imgcodecs; then fail "OpenCV's pictures are needed"; fi
# Each static library that the linker is given is named, by its source package and in the copyright.
{ grep -ohE '/usr/[^ ]*/lib[a-z0-9]*\.a' "$binary_dir/build.ninja" "$binary_dir"/*/CMakeFiles/*/link.txt 2>/dev/null || true; } |
    sort -u | { grep -vE 'gtest|benchmark' || true; } >archives
[ "$(wc -l <archives)" -gt 4 ] || fail "no static libraries: $(cat archives)"
dpkg-deb -f one/ispace_*.deb Built-Using >built_using
while read -r archive; do
    library=$(dpkg-query -S "$archive" | sed 's/[:,].*//')
    grep -qF "$(dpkg-query -W -f '${source:Package} (= ${source:Version})' "$library")" built_using ||
        fail "Built-Using lacks $library: $(cat built_using)"
    grep -qw -- "$library" root/usr/share/doc/ispace/copyright || fail "the copyright lacks $library"
done <archives

# The source package holds what git does, and needs what packages.txt lists.
if git -C "$source_dir" rev-parse --git-dir >/dev/null 2>&1; then
    XZ_OPT=-0 LINTIAN="" "$source_dir/.ci/package" --source "$scratch/source" >log 2>&1 || fail "$(cat log)"
    dpkg-source --no-check -x source/*.dsc unpacked >log 2>&1 || fail "$(cat log)"
    (cd unpacked && find . \( -path ./debian -o -path ./.pc \) -prune -o \( -type f -o -type l \) -printf '%P\n') | LC_ALL=C sort >packed
    git -C "$source_dir" -c core.quotePath=off ls-tree -r --name-only HEAD | LC_ALL=C sort | diff - packed ||
        fail "the source package holds other files than the commit"
    for library in libembree-dev libglpk-dev cmake ninja-build; do
        grep -qx " $library,\?" unpacked/debian/control || fail "$library is no Build-Depends: $(cat unpacked/debian/control)"
    done
    [ -x unpacked/debian/tests/tools ] || fail "no test of the installed package"
else
    echo "no git here: no source package"
fi

export PATH=$scratch/root/usr/bin:/usr/bin:/bin
ispace envc root/usr/share/ispace/scenes/crowded.env -o room.glb
ispace arrange -q room.glb --sensor urg-04lx:2 --strategy grid -X 3 -Y 3 -o best.3dm
ispace coverage -q room.glb best.3dm --json | has ispace-coverage/1 || fail "no report"
# An example runs from where it lies, by the short names.
PATH=$scratch/root/usr/lib/ispace/bin:$PATH root/usr/share/doc/ispace/examples/ci.sh ci >log 2>&1 ||
    fail "the example ci.sh: $(tail -n 3 log)"
if command -v man >/dev/null; then
    ispace help scan | sed -n 1p | has '^SCAN(1ispace)' || fail "another page: $(ispace help scan | sed -n 1p)"
fi
