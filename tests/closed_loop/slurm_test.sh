#!/usr/bin/env bash
# The Slurm executor against a real slurmctld and slurmd on 127.0.0.1, started here and ended here:
#   tests/closed_loop/slurm_test.sh BUILD FOLDER
# One campaign here, one on Slurm, one on Slurm that is killed and resumed: their stores hold the same rows.
set -uo pipefail
karst=$(realpath "$1")/bin/karst
work=$2
skip() { echo "skipped: $1"; exit 77; }
for program in slurmctld slurmd sbatch squeue scancel munged mungekey sqlite3; do
  command -v $program >/dev/null || PATH=$PATH:/usr/sbin command -v $program >/dev/null || skip "no $program (apt-get install slurmctld slurmd slurm-client munge sqlite3)"
done
[ "$(id -u)" = 0 ] || skip "slurmd runs as root"
export PATH=$PATH:/usr/sbin
rm -rf "$work"
mkdir -p "$work"/{state,spool,munge}
work=$(realpath "$work")
run=$(mktemp -d /tmp/karst-slurm-XXXXXX)  # sockets: their names must be short
chmod 755 "$run"
pids=()
finish() {
  squeue --noheader --format=%A 2>/dev/null | sort -u | xargs -r scancel 2>/dev/null
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null; done
  rm -rf "$run"
}
trap finish EXIT

free_port() { # one that nobody listens on
  local port
  while port=$((20000 + RANDOM % 20000)); (: >"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
  echo $port
}
grep -qs ' /sys/fs/cgroup ' /proc/mounts || skip "slurmd needs /sys/fs/cgroup, and nothing is mounted there"
host=$(hostname -s)
mungekey --create --keyfile="$work/munge/key" || skip "mungekey cannot make a key"
munged --foreground --force --socket="$run/munge" --key-file="$work/munge/key" --log-file="$work/munge/log" \
  --pid-file="$work/munge/pid" --seed-file="$work/munge/seed" >"$work/munge/out" 2>&1 &
pids+=($!)
export SLURM_CONF=$work/slurm.conf
cat >"$SLURM_CONF" <<CONF
ClusterName=karst
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
AuthType=auth/munge
AuthInfo=socket=$run/munge
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
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$run/slurmctld.pid
SlurmdPidFile=$run/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ReturnToService=2
MinJobAge=10
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out" 2>&1 &
pids+=($!)
slurmd -D -f "$SLURM_CONF" >"$work/slurmd.out" 2>&1 &
pids+=($!)
for _ in $(seq 300); do
  [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ] && break
  sleep 0.2
done
[ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ] || { sinfo; tail -n 5 "$work"/slurm*.log; echo "Slurm did not start"; exit 1; }

fail() { echo "FAILED: $1"; exit 1; }
"$karst" cave generate --preset small --seed 3 --set volume=300 --out "$work/cave" >"$work/cave.log" 2>&1 || fail "no cave"
campaign=(nearest_frontier highest_frontier --caves "$work/cave.info" --seeds 3 --time 12s)
rows() { for table in campaign contestant cave trial curve; do sqlite3 "$work/$1/campaign.sqlite" "SELECT * FROM $table"; done; }
here() { "$karst" compare "${campaign[@]}" --out "$work/$1" "${@:2}"; }

here local >"$work/local.txt" 2>&1 || fail "$(cat "$work/local.txt")"
here slurm --executor slurm --batch 2 >"$work/slurm.txt" 2>&1 || fail "$(cat "$work/slurm.txt")"
[ "$(rows slurm)" = "$(rows local)" ] || fail "other rows than with the local executor"
[ "$(rows local | wc -l)" -gt 20 ] || fail "nothing is compared"
[ "$(sqlite3 "$work/slurm/campaign.sqlite" 'SELECT count(*) FROM trial WHERE status = "done"')" = 6 ] || fail "trials are missing"

(exec "$karst" compare "${campaign[@]}" --out "$work/killed" --executor slurm --batch 2 >"$work/killed.txt" 2>&1) &
killed=$!
for _ in $(seq 600); do
  [ -n "$(ls "$work"/killed/flying 2>/dev/null)" ] && break
  sleep 0.1
done
kill -9 $killed
wait $killed 2>/dev/null
[ -n "$(squeue --noheader)" ] || fail "it was over before it could be killed"
here killed --executor slurm --batch 2 >"$work/resumed.txt" 2>&1 || fail "$(cat "$work/resumed.txt")"
[ "$(rows killed)" = "$(rows local)" ] || fail "other rows after kill and resume"
[ -z "$(squeue --noheader)" ] || fail "tasks are left"

here refused --executor slurm --batch 2 --sbatch=--partition=nowhere >"$work/refused.txt" 2>&1 && fail "a bad partition was accepted"
grep -q "slurm: sbatch: .*partition" "$work/refused.txt" || fail "$(cat "$work/refused.txt")"
echo "the same rows: here, on Slurm, and on Slurm after a kill"
