# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Read after pipelines/common.sh by scripts that talk to simrun through nc.
command -v nc >/dev/null || skip "no nc here (Debian: netcat-openbsd)"

server=
clients=()
trap 'for process in $server "${clients[@]}"; do kill -9 "$process" 2>/dev/null || true; done; cleanup' EXIT

# eventually MESSAGE COMMAND…: waits until the command succeeds, for a minute at most; for a few seconds after the
# server has ended, as its last output may be on its way.
eventually() {
    local what=$1 i
    shift
    for ((i = 0; i < 3000; ++i)); do
        if "$@"; then return 0; fi
        [ -z "$server" ] || [ "$i" -gt 2750 ] || kill -0 "$server" 2>/dev/null || i=2750
        sleep 0.02
    done
    fail "in vain: $what (simrun says: $(head -n 5 simrun.err))"
}

# write_hall [RECORD…]: hall.env, 12 m long; hall.3dm with a robot in it, a laser, and the records.
write_hall() {
    printf '%s\n' '#env 1' 'ispace at=0,0 size=12,4' >hall.env
    printf '%s\n' '#3dm 1' 'robot id=r1 model=pioneer-2dx at=-5,0' \
        'laser id=l1 at=0,-1.9 heading=90 range=8' "$@" >hall.3dm
}

# start ARGUMENT…: runs simrun in the background; sets server and port. simrun.err holds its messages.
start() {
    rm -f port
    simrun "$@" --port-file port >announced 2>simrun.err &
    server=$!
    eventually "the port file" test -s port
    eventually "the first line" test -s announced
    port=$(cat port)
    grep -qx '{"schema":"ispace-simrun/1","listen":"127.0.0.1:'"$port"'","p2os":{},"scip":{}}' \
        announced || fail "first line: $(cat announced)"
}

# The server has ended, with status $1.
ended() {
    local status=0
    wait "$server" || status=$?
    server=
    [ "$status" -eq "$1" ] || fail "simrun ended with $status, expected $1: $(cat simrun.err)"
}

stop() {
    kill -"${1:-TERM}" "$server"
    ended 0
}

# dial NAME: a client that stays; its lines are in NAME.out.
dial() {
    mkfifo "$1.in"
    nc 127.0.0.1 "$port" <"$1.in" >"$1.out" &
    clients+=($!)
    eval "exec {${1}_in}>$1.in"
    eval "${1}_asked=0"
    eventually "the greeting of $1" grep -q '^ISPACE 1$' "$1.out"
}

hang_up() {
    eval "exec {${1}_in}>&-"
    rm "$1.in"
}

replies() { grep -aE '^(OK|ERR|SCAN)' "$1" | grep -av ' stream=1 '; }
has_reply() { [ "$(replies "$1" | wc -l)" -ge "$2" ]; }

# ask NAME REQUEST: sends it; the reply is in $reply.
ask() {
    local fd count
    eval "fd=\${${1}_in} count=\$((${1}_asked + 1)); ${1}_asked=\$count"
    printf '%s\n' "$2" >&"$fd"
    eventually "an answer to $2" has_reply "$1.out" "$count"
    reply=$(replies "$1.out" | sed -n "${count}p")
}

# send NAME REQUESTS: as printf writes them, in one piece, one answer each.
send() {
    eval "fd=\${${1}_in}; ${1}_asked=\$((${1}_asked + $(printf "$2" | wc -l)))"
    # shellcheck disable=SC2059,SC2154
    printf "$2" >&"$fd"
}

# expect NAME REQUEST PATTERN: the reply is as the extended pattern says.
expect() {
    ask "$1" "$2"
    grep -qEx "$3" <<<"$reply" || fail "$1: $2 is answered: $reply"
}

# value KEY: of $reply
value() { sed -n "s/.* $1=\([^ ]*\).*/\1/p" <<<"$reply"; }

# near A B TOLERANCE MESSAGE
near() {
    awk -v a="$1" -v b="$2" -v e="$3" 'BEGIN { d = a - b; exit !(a != "" && d <= e && d >= -e) }' ||
        fail "$4: $1, expected $2 within $3"
}
