#!/bin/sh
# How punctual the control step of a flight in real time is, beside a program that keeps one processor busy.
#
#   real_time_jitter.sh BUILD_FOLDER [MINUTES] [OUT_FOLDER] [more options of karst fly...]
#
# Flies missions one after another for MINUTES (30): a 16 x 1024 LiDAR at 10 Hz, LOAM and mapping at full rate, beside a
# shell that counts on one processor. Prints a row for each flight, and the share of the load that is the simulator's
# own: its ray casting (lane sensing) and its physics (step vehicle) run in the same process. docs/real_time.md quotes
# the figures. SPINNERS: number of busy programs, 1 if it is not set.
set -eu
build=$1 minutes=${2:-30} out=${3:-$(mktemp -d)}
shift; [ $# -eq 0 ] || shift; [ $# -eq 0 ] || shift
karst=$build/bin/karst
mkdir -p "$out"
[ -f "$out/cave.info" ] || "$karst" cave generate --preset maze --seed 7 --out "$out/cave" > "$out/cave.log" 2>&1
burners=
i=0
while [ $i -lt "${SPINNERS:-1}" ]; do
  (while :; do :; done) &
  burners="$burners $!"
  i=$((i + 1))
done
trap 'kill $burners 2> /dev/null || true' EXIT INT TERM
end=$(($(date +%s) + minutes * 60))
n=0
while left=$((end - $(date +%s))); [ $left -ge 40 ]; do
  n=$((n + 1))
  seconds=$left
  [ $seconds -le 1900 ] || seconds=1900
  "$karst" fly --real-time --cave "$out/cave.info" --policy nearest_frontier --seed $n --time "${seconds}s" \
    --set localization.source=lidar --set simulator.lidar.unit=vlp16 --set simulator.lidar.columns=1024 \
    --set simulator.battery_minutes=40min --no-report --force --out "$out/flight_$n" "$@" \
    > "$out/flight_$n.txt" 2>&1 || echo "flight $n: exit code $?"
done
python3 - "$out" << 'EOF'
import json, pathlib, sys
out = pathlib.Path(sys.argv[1])
runs = sorted(out.glob("flight_*/timing.json"), key=lambda f: int(f.parent.name[7:]))
print(f"{'flight':>6} {'s':>6} {'steps':>7} {'p50 ms':>8} {'p99 ms':>8} {'p99.9 ms':>9} {'max ms':>8} {'missed':>6}"
      f" {'overruns':>8} {'busy':>5} {'simulator':>9}  degraded")
for file in runs:
    t = json.loads(file.read_text())
    c = t["real_time"]["lateness"]["control"]
    jobs = t["jobs"]
    total = sum(j["total_s"] for j in jobs.values())
    own = sum(jobs[k]["total_s"] for k in ("lidar", "depth camera", "rgb camera", "vehicle") if k in jobs)
    degraded = ", ".join(f"{k} x{v}" for k, v in t["real_time"]["degraded"].items()) or "nothing"
    print(f"{file.parent.name[7:]:>6} {t['simulated_s']:6.0f} {c['count']:7d} {c['p50_ms']:8.3f} {c['p99_ms']:8.3f}"
          f" {c['p99_9_ms']:9.3f} {c['max_ms']:8.3f} {c['missed_deadlines']:6d}"
          f" {sum(j['overruns'] for j in jobs.values()):8d} {total / t['wall_s']:5.2f} {own / max(total, 1e-9):9.0%}"
          f"  {degraded}")
if runs:
    granted = json.loads(runs[-1].read_text())["real_time"]["granted"]
    for what, grant in granted.items():
        print(f"{what}: {grant['text']}")
EOF
