#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A user without rights to install gets one message with the packages that are missing and the command for root, from
# each target that needs them; with all packages there, none. What a release of Debian lacks is left out, but for the group build.
. "$(dirname "$0")/../pipelines/common.sh"

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || skip "no Debian packages here"
user=()
if [ "$(id -u)" -eq 0 ]; then
    command -v setpriv >/dev/null || skip "root, and no setpriv here"
    user=(setpriv --reuid=65534 --regid=65534 --clear-groups)
fi
"${user[@]}" sh -c ': >/dev/null' 2>err || skip "users cannot write to /dev/null: $(cat err)"
# The copy lies where any user may read, and the programs are those of Debian without sudo.
copy=$(mktemp -d)
trap 'rm -rf "$copy"; cleanup' EXIT
mkdir -p "$copy/tree/.ci" "$copy/bin"
cp "$source_dir/Makefile" "$copy/tree"
cp "$source_dir/.ci/deps" "$copy/tree/.ci"
for program in bash sh env make awk sed tr id dirname dpkg-query apt-get apt-cache nproc mktemp rm tail; do
    ln -s "$(command -v "$program")" "$copy/bin/$program"
done
printf '[build]\nbash\nispace-is-missing\nispace-is-missing-too\nanother make\n' >"$copy/tree/packages.txt"
chmod -R a+rX "$copy"
chmod 755 "$copy"
as_user() { (cd "$copy/tree" && "${user[@]}" env -i PATH="$copy/bin" HOME=/nonexistent "$@"); }

for target in demo check package; do
    status=0
    as_user make --no-print-directory "$target" >out 2>err || status=$?
    [ "$status" -eq 2 ] || fail "make $target ends with $status: $(cat out err)"
    [ ! -s out ] || fail "make $target writes: $(cat out err)"
    [ "$(grep -vc '^make: ' err)" -eq 1 ] || fail "make $target: not one message: $(cat err)"
    grep -qx 'deps: packages are missing, .*; run as root: apt-get install ispace-is-missing ispace-is-missing-too' err ||
        fail "make $target: $(cat err)"
done
sed -i '/ispace-is/d' "$copy/tree/packages.txt"
as_user .ci/deps build check >out 2>err || fail "all is there: $(cat err)"
[ ! -s out ] && [ ! -s err ] || fail "all is there: $(cat out err)"

if compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null; then
    printf '[check]\nispace-is-missing\n' >>"$copy/tree/packages.txt"
    as_user .ci/deps build check >out 2>err || fail "a package for tests that no release has: $(cat err)"
    [ "$(cat out)" = "deps: this release has no ispace-is-missing: going on without it" ] && [ ! -s err ] ||
        fail "a package for tests that no release has: $(cat out err)"
fi
