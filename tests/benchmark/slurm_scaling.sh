#!/usr/bin/env bash
# What limits a campaign on Slurm (docs/results/slurm_scaling.md), on simulated nodes of this machine:
#   tests/benchmark/slurm_scaling.sh BUILD FOLDER [store|startup|disk|collect|queue|nodes|cores]...
# FOLDER lies on the disk to measure. `nodes` and `cores` do not fly: a stand-in for the task waits as long as a trial is
# said to take, and then copies the run directory of a flight of 12 s. So more nodes can be had than this machine has
# cores; everything else is what a campaign does: karst compare, its store, slurmctld, slurmd, the files.
set -euo pipefail
build=$(realpath "$1")
karst=$build/bin/karst
mkdir -p "$2"
work=$(realpath "$2")
here=$(realpath "$(dirname "$0")")
shift 2
parts=("${@:-store}")
[ $# -gt 0 ] || parts=(store startup disk collect queue nodes cores)
export PATH=$PATH:/usr/sbin
. "$here/../closed_loop/slurm_cluster.sh"

cave() { # cave PRESET: made once
  [ -f "$work/$1.info" ] || "$karst" cave generate --preset "$1" --seed 3 --out "$work/$1" >"$work/$1.log" 2>&1
  echo "$work/$1.info"
}

part_store() { # one writer: on this disk, and in memory
  "$build"/bin/campaign_store_bench "$work" 1000 10000
  "$build"/bin/campaign_store_bench /dev/shm 1000 10000
}

part_startup() { # a flight of 10 s: the whole process against what timing.json says of the flight
  local preset
  for preset in small medium large; do
    cave $preset >/dev/null
    rm -rf "$work/startup"
    /usr/bin/python3 - "$karst" "$work/$preset.info" "$work/startup" <<'PY'
import json, resource, statistics, subprocess, sys, time
karst, cave, out = sys.argv[1:]
first, rows = None, []
for i in range(8):
    before, t = resource.getrusage(resource.RUSAGE_CHILDREN), time.time()
    r = subprocess.run([karst, "fly", "--cave", cave, "--policy", "nearest_frontier", "--time", "10s", "--seed", str(i + 1),
                        "--threads", "1", "--quiet", "--no-report", "--cave-cache", out + "/cache", "--out", f"{out}/{i}"],
                       capture_output=True, text=True)
    wall, after = time.time() - t, resource.getrusage(resource.RUSAGE_CHILDREN)
    timing = json.load(open(f"{out}/{i}/timing.json"))
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    row = (wall, cpu, timing["wall_s"])
    if i == 0: first = row
    else: rows.append(row)
m = lambda k: statistics.median(r[k] for r in rows)
print(f"{cave.split('/')[-1]:12s} first {first[0]:.2f} s wall {first[1]:.2f} s CPU; then (median of {len(rows)}) "
      f"{m(0):.2f} s wall {m(1):.2f} s CPU, of which flight {m(2):.2f} s wall, beside it "
      f"{statistics.median(r[0] - r[2] for r in rows):.2f} s")
PY
  done
}

part_disk() { # bytes of a trial: what its process reads and writes, and what --keep leaves
  local flight
  for flight in 12s 60s 300s; do
    rm -rf "$work/disk"
    "$karst" compare nearest_frontier highest_frontier --caves "$(cave medium)" --seeds 1 --time $flight --out "$work/disk" \
      --quiet >/dev/null 2>&1  # for its mission file, and for what it works out of the cave once
    /usr/bin/python3 - "$karst" "$work/disk" $flight <<'PY'
import os, subprocess, sys
karst, folder, flight = sys.argv[1:]
io = lambda: {k: int(v) for k, v in (l.split(": ") for l in open("/proc/self/io"))}
DROPPED = {"all": set(), "replay": {"map.ot", "map.ply"}}
DROPPED["figures"] = DROPPED["replay"] | {"map.bt", "map_growth.bin", "ground_truth.tum", "trajectory.tum", "telemetry.csv",
    "localization.csv", "events.jsonl", "truth.csv", "truth_events.jsonl", "decisions.csv"}
run, before = f"{folder}/again", io()
subprocess.run([karst, "fly", f"{folder}/missions/nearest_frontier/medium.info", "--seed", "2", "--threads", "1", "--quiet",
                "--no-report", "--cave-cache", folder + "/caves", "--out", run], capture_output=True)
after = io()
d = {k: after[k] - before[k] for k in after}
files = {f: os.path.getsize(f"{run}/{f}") for f in os.listdir(run) if os.path.isfile(f"{run}/{f}")}
kept = {k: sum(s for f, s in files.items() if f not in dropped) for k, dropped in DROPPED.items()}
print(f"{flight:5s}: reads {d['rchar']/1e6:.2f} MB in {d['syscr']} calls, writes {d['wchar']/1e6:.2f} MB in {d['syscw']} calls; "
      f"{len(files)} files; kept: " + ", ".join(f"{k} {v/1e6:.3f} MB" for k, v in kept.items()))
PY
  done
}

seconds() { # CPU and wall seconds of a command: "CPU WALL"
  /usr/bin/time -o "$work/time" -f '%U %S %e' "$@" >"$work/out.txt" 2>&1 || { cat "$work/out.txt" >&2; return 1; }
  awk '{print $1 + $2, $3}' "$work/time"
}

part_collect() { # what the coordinator does for a trial that is flown: reads its record and stores it
  local flight campaign again stored
  for flight in 12s 300s; do
    rm -rf "$work/collect"
    campaign=("$karst" compare nearest_frontier highest_frontier --caves "$(cave medium)" --seeds 3 --time $flight
              --out "$work/collect" --quiet)
    seconds "${campaign[@]}" >/dev/null
    again=$(seconds "${campaign[@]}")  # plans, and prints what is stored
    rm "$work/collect/campaign.sqlite"
    stored=$(seconds "${campaign[@]}")  # the same, and collects six trials
    awk -v f=$flight -v a="$again" -v s="$stored" 'BEGIN { split(a, x); split(s, y)
      printf "flights of %s: collecting a trial takes %.0f ms of CPU, %.0f ms wall (mean of 6)\n", f, (y[1] - x[1]) / 6 * 1e3, (y[2] - x[2]) / 6 * 1e3 }'
  done
}

part_queue() { # arrays that wait: to submit and to ask for them
  local tasks arrays ids begin
  rm -rf "$work/queue"
  mkdir -p "$work/queue"
  printf '#!/bin/sh\nsleep 1000\n' >"$work/queue/task.sh"
  (
    start_cluster "$work/queue" 1 MaxJobCount=20000
    for arrays in 1 10; do
      begin=$(date +%s.%N)
      ids=()
      for _ in $(seq $arrays); do
        ids+=("$(sbatch --parsable --array=0-999 --chdir="$work/queue" --output=/dev/null "$work/queue/task.sh")")
      done
      awk -v b="$begin" -v e="$(date +%s.%N)" -v n=$arrays 'BEGIN { printf "%d tasks: sbatch %.3f s for an array of 1000;", n * 1000, (e - b) / n }'
      seconds squeue --noheader --array --states=all --jobs="$(IFS=,; echo "${ids[*]}")" \
        '--Format=ArrayJobID:20|,ArrayTaskID:12|,State:20|,exit_code:12|,RestartCnt:8|,NodeList:64|,Reason:40|' |
        awk '{ printf " squeue %.2f s wall, %.2f s CPU;", $2, $1 }'
      begin=$(date +%s.%N)
      scancel "${ids[@]}"
      awk -v b="$begin" -v e="$(date +%s.%N)" 'BEGIN { printf " scancel %.2f s\n", e - b }'
    done
  )
}

# throughput NODES CORES_A_NODE TRIALS SECONDS_A_TRIAL [option of compare...]: a line.
throughput() {
  local nodes=$1 cluster_cpus=$2 trials=$3 trial_s=$4 dir=$work/flown
  shift 4
  rm -rf "$dir" "$work/cluster" "$work/bin"
  mkdir -p "$work/cluster" "$work/bin"
  if [ ! -d "$work/template" ]; then
    "$karst" compare nearest_frontier highest_frontier --caves "$(cave small)" --seeds 1 --time 12s --out "$work/one" --quiet >/dev/null 2>&1
    cp -r "$work"/one/trials/nearest_frontier/small/1 "$work/template"
  fi
  cat >"$work/bin/stand_in" <<'TASK'
#!/usr/bin/env bash
# Instead of `karst trials BATCH`: waits, and leaves the run directory of another flight.
batch=$2/$SLURM_ARRAY_TASK_ID.json
mapfile -t ids < <(sed -n 's/.*"identity": "\(.*\)",*$/\1/p' "$batch")
mapfile -t dirs < <(sed -n 's/.*"run_dir": "\(.*\)",*$/\1/p' "$batch")
trial() {
  local part=$STAND_IN_FOLDER/flying/$SLURM_JOB_ID-$1
  sleep "$STAND_IN_SECONDS"
  mkdir -p "$STAND_IN_FOLDER/flying" "${dirs[$1]%/*}"
  cp -r "$STAND_IN_TEMPLATE" "$part"
  echo '{"exit_code": 0, "signal": 0, "hung": false, "wall_s": 1, "machine": "stand-in", "identity": "'"${ids[$1]}"'"}' >"$part/trial.json"
  mv -T "$part" "${dirs[$1]}"
}
for i in "${!ids[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge "$SLURM_CPUS_ON_NODE" ]; do wait -n; done
  trial "$i" &
done
wait
TASK
  cat >"$work/bin/sbatch" <<SBATCH
#!/usr/bin/env bash
exec $(command -v sbatch) "\${@:1:\$#-3}" "$work/bin/stand_in" "\${@: -2}"
SBATCH
  chmod +x "$work"/bin/*
  (
    export STAND_IN_SECONDS=$trial_s STAND_IN_FOLDER=$dir STAND_IN_TEMPLATE=$work/template
    start_cluster "$work/cluster" "$nodes" SlurmdTimeout=300 MaxJobCount=20000
    export PATH=$work/bin:$PATH
    campaign=("$karst" compare nearest_frontier highest_frontier --caves "$(cave small)" --seeds $((trials / 2)) --time 12s
              --out "$dir" --executor slurm --keep figures --quiet)
    flown=$(seconds "${campaign[@]}" "$@")
    begin=$(stat -c %.3Y "$dir/slurm/batches/1/task.sh")  # before the first array is submitted
    end=$(stat -c %.3Y "$dir/campaign.sqlite")            # the last trial is stored
    again=$(seconds "${campaign[@]}")
    stored=$(sqlite3 "$dir/campaign.sqlite" "SELECT count(*) FROM trial WHERE status = 'done'")
    awk -v n="$nodes" -v c="$cluster_cpus" -v t="$stored" -v s="$trial_s" -v b="$begin" -v e="$end" -v f="$flown" -v a="$again" -v o="$*" 'BEGIN {
      split(f, x); split(a, y); ideal = t * s / (n * c)
      printf "%d nodes x %d cores, %d trials of %g s %s: %.1f s, %.2f trials/s, ideal %.1f s, %.0f %% of it; coordinator %.1f ms of CPU a trial, %.1f s to plan and print\n", n, c, t, s, o, e - b, t / (e - b), ideal, 100 * ideal / (e - b), (x[1] - y[1]) / t * 1e3, y[1] }'
  )
}

part_nodes() {
  local nodes
  for nodes in 1 2 4 8; do throughput $nodes 1 $((12 * nodes)) 5 --batch 2; done
}

part_cores() { # simulated cores; ideally a minute each
  throughput 8 8 192 20 --batch 1
  throughput 8 32 768 20 --batch 1
  throughput 8 125 3000 20 --batch 1
  throughput 8 125 3000 20 --batch 75 --sbatch=--cpus-per-task=25
}

for part in "${parts[@]}"; do
  echo "== $part ($(date +%T), load $(cut -d' ' -f1-3 /proc/loadavg))"
  "part_$part"
done
