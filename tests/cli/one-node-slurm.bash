# one-node-slurm.bash - a Slurm of one node for a test, all of it in a folder: start_slurm FOLDER, stop_slurm. As root.

# start_slurm FOLDER: munged, slurmctld and slurmd with their keys, sockets, states and logs there. False when they do not
# get ready.
start_slurm() {
    local d=$1 host port=$((20000 + RANDOM % 20000))
    host=$(hostname -s)
    mkdir -p "$d/state" "$d/spool"
    head -c 128 /dev/urandom >"$d/munge.key"
    chmod 400 "$d/munge.key"
    munged --force --foreground -S "$d/munge.sock" --key-file="$d/munge.key" --pid-file="$d/munge.pid" \
        --log-file="$d/munge.log" --seed-file="$d/munge.seed" --num-threads=1 >/dev/null 2>&1 3>&- &
    SLURM_PIDS=$!
    cat >"$d/slurm.conf" <<END
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$d/munge.sock
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$d/state
SlurmdSpoolDir=$d/spool
SlurmctldPidFile=$d/slurmctld.pid
SlurmdPidFile=$d/slurmd.pid
SlurmctldLogFile=$d/slurmctld.log
SlurmdLogFile=$d/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
    export SLURM_CONF=$d/slurm.conf
    slurmctld -D -f "$SLURM_CONF" >/dev/null 2>&1 3>&- &
    SLURM_PIDS+=" $!"
    slurmd -D -f "$SLURM_CONF" >/dev/null 2>&1 3>&- &
    SLURM_PIDS+=" $!"
    for _ in $(seq 100); do
        ! timeout 5 sinfo -h -o %T 2>/dev/null | grep -q idle || return 0
        sleep 0.2
    done
    return 1
}

stop_slurm() {
    local pid
    for pid in $SLURM_PIDS; do kill "$pid" 2>/dev/null || true; done
    for pid in $SLURM_PIDS; do wait "$pid" 2>/dev/null || true; done
    SLURM_PIDS=
}
