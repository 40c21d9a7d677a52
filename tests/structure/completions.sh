#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Completions know every option of --help and the words of those that have some, in bash, and in zsh and fish
# where these are installed.
. "$(dirname "$0")/../pipelines/common.sh"

folder=$binary_dir/share/completions
[ -d "$folder" ] || skip "a build with sanitizers has no completions"

# try WORD…: writes bash's proposals for the last word.
cat >try.bash <<'END'
. "$1/bash/scan"
shift
compopt() { echo "$2"; }
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_ispace
echo "${COMPREPLY[*]}"
END
# expect WANTED SHELL WORD…
expect() {
    local wanted=$1 shell=$2 found
    shift 2
    if [ "$shell" = bash ]; then
        found=$(bash try.bash "$folder" "$@")
    else
        found=$(XDG_CONFIG_HOME=$PWD fish -c "source $folder/fish/ispace.fish; source $folder/fish/scan.fish
            complete -C '$*'" | cut -f1 | tr '\n' ' ' | sed 's/ $//')
    fi
    [ "$found" = "$wanted" ] || fail "$shell: $* gives \`$found\`, not \`$wanted\`"
}
shells=bash
if command -v fish >/dev/null; then shells="bash fish"; else echo "no fish here"; fi
for shell in $shells; do
    expect arrange "$shell" ispace ar
    expect wire "$shell" ispace help wi
    expect 'region beams' bash ispace coverage --grid-of ''
    expect 'urg-04lx urg-04lx-ug01' "$shell" ispace arrange --sensor urg-04
    expect --grid-of "$shell" ispace coverage --grid-
    expect rgb24 "$shell" scan --to rg
done
expect rgb24 bash scan --to = rg
expect default bash scan --poses x
expect dirnames bash ispace simrun --record x
expect default bash scan room

for tool in $tools; do
    "$tool" --help all | grep -E '^  -' | cut -c 3-26 | grep -oE -- '--?[A-Za-z][A-Za-z0-9-]*' | LC_ALL=C sort -u >in_help
    sed -n "s/^    $tool) echo '\(.*\)' ;;/\1/p" "$folder/bash/ispace" | tr ' ' '\n' | LC_ALL=C sort >in_bash
    diff in_help in_bash || fail "$tool: options of --help (<) and of the completion (>) differ"
    [ -s "$folder/zsh/_$tool" ] && [ -s "$folder/fish/$tool.fish" ] || fail "no completion of $tool"
done

if ! command -v zsh >/dev/null; then echo "no zsh here"; exit 0; fi
zsh -f -c "
    _arguments() { print -rl -- \"\$words[1] \$CURRENT\" \"\$@\" }
    words=(ispace scan --to p) CURRENT=4
    source $folder/zsh/_ispace" >arguments
grep -qx 'scan 3' arguments || fail "zsh: $(head -n 1 arguments)"
grep -q -- '^(--to)--to=\[format of the readings\]:.*:(jsonl csv .*png' arguments || fail "zsh: no --to: $(cat arguments)"
zsh -f -c "
    _describe() { print -rl -- \${(P)2} }
    words=(ispace s) CURRENT=2
    source $folder/zsh/_ispace" >described
[ "$(cut -d: -f1 described | tr '\n' ' ')" = "$tools " ] || fail "zsh: $(cat described)"
