# SPDX-License-Identifier: GPL-3.0-or-later
# talk_each.sh SIMRUN-ARGUMENT… <SESSIONS: writes the replies to clients one after another of a world that waits for
# steps; a blank line ends a session. Skips pictures.
simrun "$@" --clock step --port-file port >announced &
server=$!
tries=0
until [ -s port ] || [ $((tries += 1)) -gt 600 ]; do sleep 0.05; done
requests=
while IFS= read -r line; do
    if [ -n "$line" ]; then
        requests="$requests$line
"
        continue
    fi
    printf '%s' "$requests" | nc -N 127.0.0.1 "$(cat port)" | sed '1d;s/base64=.*/base64=.../'
    requests=
done
kill -TERM $server
wait $server
status=$?
rm -f port announced
exit $status
