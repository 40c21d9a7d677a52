# SPDX-License-Identifier: GPL-3.0-or-later
# Below the tables: _ispace_tools, and a function _ispace_TOOL for each.
_ispace_models() {
    local -a models=(${(f)"$(ispace scan --list-models 2>/dev/null | sed -n 's/^\([a-z0-9][^ ]*\) .*/\1/p')"})
    compadd -S '' -a models
}
_ispace() {
    local tool=${words[1]:t}
    if [[ $tool == ispace ]]; then
        if (( CURRENT == 2 )); then
            _describe tool _ispace_tools -- '(help:open\ a\ manual\ page)'
            return
        fi
        shift words
        (( CURRENT-- ))
        tool=${words[1]}
        if [[ $tool == help ]]; then
            compadd ${_ispace_tools%%:*} env 3dm yaml protocol wire
            return
        fi
    fi
    (( $+functions[_ispace_$tool] )) && _ispace_$tool
}
_ispace "$@"
