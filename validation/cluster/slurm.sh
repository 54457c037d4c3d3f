#!/usr/bin/env bash
# A Slurm of two nodes with one processor each on this host, for as long as a command runs:
#
#   validation/cluster/slurm.sh COMMAND [ARGUMENT...]
#
# COMMAND finds the cluster through SLURM_CONF, as sbatch and squeue do. Its exit code is that of COMMAND. Needs root and a Debian or
# Ubuntu host; installs slurm-wlm and munge where they are missing. The daemons run without systemd and without cgroups, from a folder
# under TMPDIR that disappears with them: key, sockets, spools and logs. SLURM_KEEP=1 keeps the folder.
set -euo pipefail

(($#)) || { sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 2; }
[[ $(id -u) == 0 ]] || { echo "slurm.sh: expected root, which starts the daemons; found $(id -un)" >&2; exit 2; }

export PATH="$PATH:/usr/sbin"
if ! (command -v slurmctld && command -v slurmd && command -v sbatch && command -v munged) >/dev/null; then
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends slurm-wlm munge >/dev/null
fi

base="$(mktemp -d "${TMPDIR:-/tmp}/palpate-slurm-XXXXXX")"
chmod 755 "$base"
daemons=()

stop() {
    trap - EXIT INT TERM
    scancel --full --signal=KILL --user root 2>/dev/null || true
    # Newest first: slurmd before slurmctld before munged.
    for ((at = ${#daemons[@]} - 1; at >= 0; at--)); do
        kill "${daemons[at]}" 2>/dev/null || true
        wait "${daemons[at]}" 2>/dev/null || true
    done
    [[ -n "${SLURM_KEEP:-}" ]] && echo "slurm.sh: kept $base" >&2 || rm -rf "$base"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# start NAME COMMAND...: a daemon in the foreground of a job of this script, with a log.
start() {
    "${@:2}" >"$base/$1.out" 2>&1 &
    daemons+=($!)
}

# Four free ports: of the controller and of the nodes.
read -r -a ports < <(python3 - <<'PORTS'
import socket
sockets = [socket.socket() for _ in range(3)]
for one in sockets:
    one.bind(("127.0.0.1", 0))
print(*(one.getsockname()[1] for one in sockets))
PORTS
)

mkdir -m 755 "$base/munge" "$base/state" "$base/spool-one" "$base/spool-two"
(umask 077 && head -c 128 /dev/urandom >"$base/munge/key")

export SLURM_CONF="$base/slurm.conf"
cat >"$SLURM_CONF" <<CONF
ClusterName=palpate
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
# A requeued job waits for its credential to expire, 120 s by default.
AuthInfo=socket=$base/munge/socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$base/state
SlurmdSpoolDir=$base/spool-%n
SlurmctldPidFile=$base/slurmctld.pid
SlurmdPidFile=$base/slurmd-%n.pid
SlurmctldLogFile=$base/slurmctld.log
SlurmdLogFile=$base/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1,default_queue_depth=1000
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MaxArraySize=100001
MaxJobCount=100000
JobRequeue=1
KillWait=5
# A node that registers anew within this time after the start of a job is not checked for it, 10 s by default.
BatchStartTimeout=1
SlurmdTimeout=10
InactiveLimit=0
NodeName=one NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=${ports[1]} CPUs=1 RealMemory=2000
NodeName=two NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=${ports[2]} CPUs=1 RealMemory=2000
PartitionName=all Nodes=one,two Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
CONF

start munged munged --foreground --force --key-file="$base/munge/key" --socket="$base/munge/socket" \
    --pid-file="$base/munge/pid" --seed-file="$base/munge/seed" --log-file="$base/munge/log"
for ((turn = 0; turn < 100; turn++)); do
    [[ -S "$base/munge/socket" ]] && break
    sleep 0.1
done
start slurmctld slurmctld -D -c
start one slurmd -D -c -N one
start two slurmd -D -c -N two

for ((turn = 0; ; turn++)); do
    [[ "$(sinfo --noheader --states=idle --format=%D 2>/dev/null)" == 2 ]] && break
    if ((turn == 300)); then
        echo "slurm.sh: expected two idle nodes after 30 s, found:" >&2
        sinfo >&2 || true
        tail -n 15 "$base"/*.out "$base"/*.log "$base"/munge/log >&2 || true
        exit 2
    fi
    sleep 0.1
done

"$@"
