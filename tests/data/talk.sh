# SPDX-License-Identifier: GPL-3.0-or-later
# talk.sh SIMRUN-ARGUMENT… <REQUESTS: writes the replies to one client of a world that waits for steps.
simrun "$@" --clock step --port-file port >announced &
server=$!
tries=0
until [ -s port ] || [ $((tries += 1)) -gt 600 ]; do sleep 0.05; done
nc -N 127.0.0.1 "$(cat port)"
kill -TERM $server 2>/dev/null # it may have ended by SHUTDOWN
wait $server
status=$?
rm -f port announced
exit $status
