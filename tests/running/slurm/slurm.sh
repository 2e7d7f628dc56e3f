# A SLURM cluster on one machine, to be sourced: start_cluster FOLDER, stop_cluster.
#
# Controller, munge and two nodes of one core each, all as root, without systemd and accounting database.
# Memory is watched as MEMORY says: cgroup (as on most clusters; has to be writable here, version 1) or
# polling (SLURM adds up what processes take, every second).
# Each node lives in a UTS namespace of its own: it has another host name than the machine that submits,
# as on a real cluster, and nothing but the shared folder tells them of one another.

NODES="node1 node2"
CGROUPS=/sys/fs/cgroup
[ -n "${MEMORY:-}" ] || { [ -w $CGROUPS/memory/cgroup.procs ] && MEMORY=cgroup || MEMORY=polling; }
export MEMORY

install_slurm() {
    command -v slurmctld slurmd munged >/dev/null && return
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends slurm-wlm munge >/dev/null
}

write_configuration() {
    local folder=$1 port=17003 node
    cat >"$folder/slurm.conf" <<END
ClusterName=trial
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=17001
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=20
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmctldPidFile=$folder/slurmctld.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdSpoolDir=$folder/spool-%n
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=$([ $MEMORY = cgroup ] && echo task/cgroup || echo task/none)
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
DefMemPerNode=100
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
$([ $MEMORY = cgroup ] || echo JobAcctGatherParams=OverMemoryKill)
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/ended
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
AccountingStorageType=accounting_storage/none
MpiDefault=none
SchedulerParameters=sched_interval=5,batch_sched_delay=0
KillWait=5
SlurmdTimeout=15
ReturnToService=2
MaxArraySize=$MAX_ARRAY
MaxJobCount=50000
END
    cat >"$folder/cgroup.conf" <<END
CgroupPlugin=cgroup/v1
CgroupMountpoint=$CGROUPS
ConstrainRAMSpace=$([ $MEMORY = cgroup ] && echo yes || echo no)
END
    for node in $NODES; do
        echo "NodeName=$node NodeHostname=$node NodeAddr=127.0.0.1 Port=$port CPUs=1 RealMemory=4000 State=UNKNOWN"
        port=$((port + 1))
    done >>"$folder/slurm.conf"
    cat >>"$folder/slurm.conf" <<END
PartitionName=all Nodes=ALL Default=YES PriorityTier=1 PreemptMode=REQUEUE State=UP
PartitionName=frail Nodes=ALL PriorityTier=1 PreemptMode=CANCEL State=UP
PartitionName=urgent Nodes=ALL PriorityTier=2 PreemptMode=OFF State=UP
END
}

start_node() {
    unshare --uts sh -c "hostname $1 && exec slurmd -N $1 -f $CLUSTER/slurm.conf"
}

start_cluster() {
    CLUSTER=$1
    export SLURM_CONF=$CLUSTER/slurm.conf
    mkdir -p "$CLUSTER/state"
    write_configuration "$CLUSTER"
    dd if=/dev/urandom of="$CLUSTER/munge.key" bs=128 count=1 2>/dev/null
    chmod 600 "$CLUSTER/munge.key"
    munged --force --key-file="$CLUSTER/munge.key" --socket="$CLUSTER/munge.socket" \
        --pid-file="$CLUSTER/munged.pid" --log-file="$CLUSTER/munged.log" --seed-file="$CLUSTER/munge.seed"
    slurmctld -f "$SLURM_CONF"
    for node in $NODES; do start_node "$node"; done
    for _ in $(seq 60); do
        [ "$(sinfo --noheader --Node --partition=all --format=%t 2>/dev/null | grep -c idle)" = 2 ] && return
        sleep 1
    done
    echo "the cluster does not start:" >&2
    sinfo >&2
    tail -n 5 "$CLUSTER"/slurm*.log >&2
    return 1
}

stop_cluster() {
    local pid node
    scancel --quiet --user=root 2>/dev/null || true
    for _ in $(seq 20); do
        [ -z "$(squeue --noheader 2>/dev/null)" ] && break
        sleep 0.5
    done
    scontrol shutdown 2>/dev/null || true
    sleep 2
    for pid in "$CLUSTER"/slurmd-*.pid "$CLUSTER/slurmctld.pid" "$CLUSTER/munged.pid"; do
        [ -f "$pid" ] && kill "$(cat "$pid")" 2>/dev/null
    done
    sleep 1
    for node in $NODES; do
        find $CGROUPS/memory/slurm_"$node" -depth -type d -exec rmdir {} + 2>/dev/null || true
    done
}
