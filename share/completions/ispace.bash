# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Below the tables: _ispace_options TOOL; _ispace_value TOOL OPTION, the kind of its value (words …, files,
# folders, models, nothing), or an empty line for an option without a value.
_ispace() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} tool=${COMP_WORDS[0]##*/} kind
    COMPREPLY=()
    if [ "$tool" = ispace ]; then
        tool=${COMP_WORDS[1]}
        if [ "$COMP_CWORD" -eq 1 ]; then
            mapfile -t COMPREPLY < <(compgen -W "$_ispace_tools help --help --version" -- "$word")
            return
        elif [ "$tool" = help ]; then
            mapfile -t COMPREPLY < <(compgen -W "$_ispace_tools env 3dm yaml protocol wire" -- "$word")
            return
        fi
    fi
    # --to=png comes as three words.
    if [ "$word" = = ]; then word=; elif [ "$before" = = ]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
    kind=$(_ispace_value "$tool" "$before")
    case $kind in
    words*) mapfile -t COMPREPLY < <(compgen -W "${kind#words }" -- "$word") ;;
    models) mapfile -t COMPREPLY < <(compgen -W "$(_ispace_models)" -- "$word") ;;
    folders) compopt -o dirnames ;;
    files) compopt -o default ;;
    nothing) ;;
    *) case $word in
        -*) mapfile -t COMPREPLY < <(compgen -W "$(_ispace_options "$tool")" -- "$word") ;;
        *) compopt -o default ;;
        esac ;;
    esac
}
_ispace_models() { ispace scan --list-models 2>/dev/null | sed -n 's/^\([a-z0-9][^ ]*\) .*/\1/p'; }
