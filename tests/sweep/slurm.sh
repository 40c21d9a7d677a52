#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/batch on a private cluster of this machine: munge, a controller and two nodes on loopback, with
# separate keys, ports and state. An array of 100 tasks loses one node in the middle; Slurm requeues its tasks, and the
# results are the single run's.
. "$(dirname "$0")/batch.sh"

PATH=$PATH:/usr/sbin
for program in munged slurmctld slurmd slurmstepd sbatch sinfo; do
    command -v "$program" >/dev/null || skip "no $program (Debian: munge slurmctld slurmd slurm-client)"
done

# Of a cluster that the test itself may run on.
unset ${!SLURM_@} ${!SBATCH_@}

# A socket's path must be short.
cluster=$(mktemp -d "${TMPDIR:-/tmp}/ispace-slurm.$$.XXXXXX")
export SLURM_CONF=$cluster/slurm.conf

# processes_of VARIABLE=VALUE: those of this cluster that have it in their environment.
processes_of() {
    { grep -lzsxF -- "$1" /proc/[0-9]*/environ 2>/dev/null || true; } | while read -r file; do
        grep -qzsxF -- "SLURM_CONF=$SLURM_CONF" "$file" && basename "$(dirname "$file")"
    done || true
}

# kill_tasks NODE: ends all processes there at once, with their supervisors.
kill_tasks() {
    local tasks
    tasks=$(processes_of "SLURMD_NODENAME=$1" | paste -sd ' ')
    [ -n "$tasks" ] || return 0
    # shellcheck disable=SC2046,SC2086
    kill -9 $(ps -o ppid= -p ${tasks// /,} | sort -u | xargs ps -o pid=,comm= -p |
        awk '$2 == "slurmstepd" { print $1 }') $tasks 2>/dev/null || true
}

stop_cluster() {
    local file pid
    for file in slurmctld slurmd.node1 slurmd.node2 munged; do
        pid=$(cat "$cluster/run/$file.pid" 2>/dev/null) || continue
        # A number that is no longer ours is left alone.
        grep -qsF "$cluster" "/proc/$pid/cmdline" || continue
        kill "$pid" 2>/dev/null || continue
        for _ in $(seq 100); do [ -d "/proc/$pid" ] && sleep 0.05; done
        kill -9 "$pid" 2>/dev/null || true
    done
    kill_tasks node1
    kill_tasks node2
    rm -rf "$cluster"
    cleanup
}
trap stop_cluster EXIT

start_cluster() {
    local user host ports force=()
    user=$(id -un) host=$(hostname)
    ports=($(python3 -c 'import socket
held = [socket.socket() for _ in range(3)]
for one in held: one.bind(("127.0.0.1", 0))
print(*(one.getsockname()[1] for one in held))'))
    mkdir -p "$cluster"/{run,log,state,node1,node2}
    chmod 755 "$cluster" "$cluster/run"
    head -c 1024 /dev/urandom >"$cluster/munge.key"
    chmod 400 "$cluster/munge.key"
    # Later versions want cgroups, which a container may lack; tasks here need none.
    case $(slurmd -V) in *' 22.'*) ;; *) echo CgroupPlugin=disabled >"$cluster/cgroup.conf" ;; esac
    cat >"$SLURM_CONF" <<END
ClusterName=probe
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
# A task that is requeued waits until its old credential is void.
AuthInfo=socket=$cluster/run/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/%n
SlurmctldPidFile=$cluster/run/slurmctld.pid
SlurmdPidFile=$cluster/run/slurmd.%n.pid
SlurmctldLogFile=$cluster/log/slurmctld.log
SlurmdLogFile=$cluster/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
JobRequeue=1
SlurmdTimeout=5
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SlurmdParameters=config_overrides
NodeName=node1 NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[1]} CPUs=3 RealMemory=100
NodeName=node2 NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[2]} CPUs=3 RealMemory=100
PartitionName=debug Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
END
    if [ "$(id -u)" -eq 0 ]; then force=(--force); fi
    munged "${force[@]}" --key-file="$cluster/munge.key" --socket="$cluster/run/munge.socket" \
        --pid-file="$cluster/run/munged.pid" --log-file="$cluster/log/munged.log" \
        --seed-file="$cluster/run/seed" >"$cluster/log/start" 2>&1 || fail "$(cat "$cluster/log/start")"
    slurmctld -f "$SLURM_CONF" -c
    slurmd -N node1 -f "$SLURM_CONF"
    slurmd -N node2 -f "$SLURM_CONF"
    eventually "two idle nodes" sh -c '[ "$(sinfo -h -N -o %t | grep -cx idle)" -eq 2 ]'
}

# eventually MESSAGE COMMAND…: within a minute the command succeeds.
eventually() {
    for _ in $(seq 600); do
        if "${@:2}" 2>/dev/null; then return; fi
        sleep 0.1
    done
    tail -n 5 "$cluster"/log/*.log >&2
    fail "in vain: $1"
}

# Jobs on node2 take longer, and tell their tasks, so that one runs when the node dies.
mkdir bin
cat >bin/arrange <<END
#!/bin/sh
echo "\$SLURM_ARRAY_TASK_ID \$SLURMD_NODENAME \${SLURM_RESTART_COUNT:-0} \$SLURM_CPUS_PER_TASK" >>$scratch/begun
if [ "\$SLURMD_NODENAME" = node2 ]; then sleep 5; fi
exec $binary_dir/bin/arrange "\$@"
END
chmod +x bin/arrange

start_cluster
set_up slurm
cd slurm
cp "$scenes"/ispace.* .
export PATH=$scratch/bin:$PATH
parts=$(sbatch --parsable --array=1-10 slurm-array.sh 10 shards.yaml)
./slurm.sh 100 >../out 2>../err &
submitted=$!
eventually "twenty jobs" sh -c '[ "$(ls results/*.json | wc -l)" -ge 20 ]'
on_node2=$(grep -c ' node2 ' ../begun || true)
eventually "a job that begins on node2" sh -c "[ \"\$(grep -c ' node2 ' ../begun)\" -gt $on_node2 ]"
kill -9 "$(cat "$cluster/run/slurmd.node2.pid")"
kill_tasks node2
at_death=$(ls results/*.json | wc -l)
[ "$at_death" -lt 100 ] || fail "all done before the node died"
status=0
wait "$submitted" || status=$?
cd ..
[ "$status" -eq 0 ] || fail "status $status: $(cat err; tail -n 20 slurm/slurm-*.txt)"
rm -f slurm/results/.ispace.tmp.*
expect_single slurm

grep -q ' node2 0 ' begun || fail "node2 did nothing"
grep -q ' node1 [1-9]' begun || fail "nothing was requeued: $(cut -d' ' -f2,3 begun | sort | uniq -c)"
sinfo -h -N -n node2 -o %t | has down || fail "node2 is not down: $(sinfo -h -N)"
! grep -qv ' 1$' begun || fail "tasks without SLURM_CPUS_PER_TASK: $(grep -v ' 1$' begun)"

# One long scan in a hundred parts, ten for each task.
cd slurm
eventually "all parts" sh -c "[ -z \"\$(squeue -h -j $parts)\" ]"
scan --merge $(ispace-sweep names shards.yaml) -o merged.jsonl
scan ispace.env ispace.3dm --noise --frames 500 -q -o whole.jsonl
expect_same whole.jsonl merged.jsonl "the merged parts are not the whole scan"
[ "$(wc -l <whole.jsonl)" -gt 500 ] || fail "a short scan: $(wc -l <whole.jsonl)"
cd ..
# The same with one file for each task: share/examples/shares.
cp -r "$source_dir/share/examples/shares" shares
cp "$scenes/l-room.env" shares
sed -i 's/1\.\.400/1..40/' shares/sweep.yaml
# node2 comes back, and dies in the middle of its shares: they continue behind their last lines on node1.
slurmd -N node2 -f "$SLURM_CONF"
eventually "node2 again" sh -c '[ "$(sinfo -h -N -o %t | grep -cx idle)" -eq 2 ]'
: >begun
(cd shares && exec ./slurm.sh 4) >out 2>err &
submitted=$!
eventually "two jobs of a share on node2" sh -c "[ \"\$(grep -c ' node2 0 ' begun)\" -ge 2 ]"
share=$(awk '$2 == "node2" { print $1; exit }' begun)
eventually "a line of share $share" sh -c "[ \"\$(wc -l <shares/part$share.jsonl)\" -ge 2 ]"
kill -9 "$(cat "$cluster/run/slurmd.node2.pid")"
kill_tasks node2
lines=$(wc -l <"shares/part$share.jsonl")
[ "$lines" -lt 11 ] || fail "share $share was done before the node died"
status=0
wait "$submitted" || status=$?
[ "$status" -eq 0 ] || fail "status $status: $(cat err; tail -n 20 shares/slurm-*.txt)"
grep -q "^$share node1 [1-9]" begun || fail "share $share was not requeued: $(cat begun)"
(
    cd shares
    for i in 1 2 3 4; do ispace-sweep run sweep.yaml --shard "$i/4" -q -o "whole$i.jsonl"; done
    ispace-sweep join whole*.jsonl -o whole.csv
)
for i in 1 2 3 4; do
    expect_same "shares/whole$i.jsonl" "shares/part$i.jsonl" "share $i of an array has other bytes"
done
expect_same shares/whole.csv shares/table.csv "the shares of an array are not the whole"
echo "share $share continued behind its line $lines; node2 died after $at_death of 100 jobs; requeued: $(awk '$3 > 0 { print $1 }' begun | sort -nu | tr '\n' ' ')"
