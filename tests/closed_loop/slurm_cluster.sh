# A Slurm cluster on 127.0.0.1, for scripts to source: a real slurmctld and one slurmd for each simulated node, each in
# a PID namespace of its own, so that a node can be lost with all that runs on it.
#   start_cluster FOLDER NODES [LINE...]   nodes node1, node2 ... of $cluster_cpus cores (1); LINEs go to slurm.conf
#   lose_node N                            kills node N and its tasks for good, without a word to Slurm
# What was started ends with the script.

need_for_cluster() { # prints what is missing for a cluster here
  local program
  for program in slurmctld slurmd sbatch squeue scancel munged mungekey unshare; do
    command -v $program >/dev/null || { echo "no $program (apt-get install slurmctld slurmd slurm-client munge)"; return; }
  done
  [ "$(id -u)" = 0 ] || { echo "slurmd runs as root"; return; }
  grep -qs ' /sys/fs/cgroup ' /proc/mounts || { echo "slurmd needs /sys/fs/cgroup, and nothing is mounted there"; return; }
  unshare --pid --fork --kill-child --mount-proc --uts true 2>/dev/null || echo "PID namespaces cannot be made here"
}

cluster_pids=() cluster_nodes=()
stop_cluster() {
  local pid
  squeue --noheader --format=%A 2>/dev/null | sort -u | xargs -r scancel 2>/dev/null || true
  for pid in "${cluster_nodes[@]}"; do kill -9 "$pid" 2>/dev/null || true; done  # unshare heeds no other signal
  for pid in "${cluster_pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${cluster_nodes[@]}" "${cluster_pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  cluster_pids=() cluster_nodes=()
  rm -rf "$cluster_run"
}

free_port() { # one that nobody listens on
  local port
  while port=$((20000 + RANDOM % 20000)); (: >"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
  echo $port
}

start_cluster() {
  local work=$1 nodes=$2 host n
  shift 2
  cluster_run=$(mktemp -d /tmp/karst-slurm-XXXXXX)  # sockets: their names must be short
  chmod 755 "$cluster_run"
  trap stop_cluster EXIT
  mkdir -p "$work"/{state,spool,munge}
  host=$(hostname -s)
  mungekey --create --force --keyfile="$work/munge/key" || return 1
  munged --foreground --force --socket="$cluster_run/munge" --key-file="$work/munge/key" --log-file="$work/munge/log" \
    --pid-file="$work/munge/pid" --seed-file="$work/munge/seed" >"$work/munge/out" 2>&1 &
  cluster_pids+=($!)
  export SLURM_CONF=$work/slurm.conf
  cat >"$SLURM_CONF" <<CONF
ClusterName=karst
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$(free_port)
AuthType=auth/munge
AuthInfo=socket=$cluster_run/munge,cred_expire=5
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
SwitchType=switch/none
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool/%n
SlurmctldPidFile=$cluster_run/slurmctld.pid
SlurmdPidFile=$cluster_run/%n.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/%n.log
SlurmdParameters=config_overrides
ReturnToService=2
$(printf '%s\n' "$@")
PartitionName=all Nodes=node[1-$nodes] Default=YES MaxTime=INFINITE State=UP
CONF
  for n in $(seq "$nodes"); do
    echo "NodeName=node$n NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port) CPUs=${cluster_cpus:-1} State=UNKNOWN" >>"$SLURM_CONF"
    mkdir -p "$work/spool/node$n"
  done
  slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out" 2>&1 &
  cluster_pids+=($!)
  for n in $(seq "$nodes"); do
    unshare --pid --fork --kill-child --mount-proc --uts sh -c \
      "hostname node$n && exec slurmd -D -N node$n -f '$SLURM_CONF'" >"$work/node$n.out" 2>&1 &
    cluster_nodes[n]=$!
  done
  for _ in $(seq 300); do
    [ "$(sinfo --noheader --Node --format=%T 2>/dev/null | grep -c '^idle$')" = "$nodes" ] && return
    sleep 0.2
  done
  sinfo
  tail -n 5 "$work"/slurmctld.log "$work"/node*.log
  echo "Slurm did not start"
  return 1
}

lose_node() {
  kill -9 "${cluster_nodes[$1]}"
  wait "${cluster_nodes[$1]}" 2>/dev/null || true
}
