#!/bin/sh
# Whether clients of `karst fly --live` cost the flight anything: how punctual its control steps are without --live, with
# nobody connected, and with clients that follow, are dead or attack.
#
#   live_jitter.sh BUILD_FOLDER [SECONDS] [OUT_FOLDER] [ROUNDS]
#
# Flies missions in real time of SECONDS (60) each, ROUNDS (1) times in turn. The clients are five that follow all topics,
# two that subscribe and read nothing, and one that opens connections, sends garbage and huge frames without a pause.
set -eu
build=$1 seconds=${2:-60} out=${3:-$(mktemp -d)} rounds=${4:-1}
karst=$build/bin/karst
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out"
[ -f "$out/cave.info" ] || "$karst" cave generate --preset maze --seed 7 --out "$out/cave" > "$out/cave.log" 2>&1
fly() {
  name=$1; shift
  "$karst" fly --real-time --cave "$out/cave.info" --policy nearest_frontier --seed 7 --time "${seconds}s" \
    --set localization.source=lidar --set simulator.lidar.unit=vlp16 --set simulator.lidar.columns=1024 \
    --no-report --force --out "$out/$name" "$@" > "$out/$name.txt" 2>&1 || echo "$name: exit code $?"
}
for round in $(seq "$rounds"); do
  fly "without_$round"
  fly "nobody_$round" --live=127.0.0.1:18765
  python3 "$here/live_clients.py" 18765 "$out/clients_$round.txt" &
  clients=$!
  fly "clients_$round" --live=127.0.0.1:18765
  kill $clients 2> /dev/null || true
  wait $clients 2> /dev/null || true
done
python3 - "$out" << 'END'
import json, pathlib, sys
out = pathlib.Path(sys.argv[1])
print(f"{'flight':>12} {'s':>5} {'steps':>6} {'p50 ms':>7} {'p99 ms':>7} {'p99.9 ms':>8} {'max ms':>7} {'missed':>6}"
      f" {'overruns':>8}  degraded")
for file in sorted(out.glob("*/timing.json"), key=lambda f: (f.parent.name.split("_")[-1], f.parent.name)):
    t = json.loads(file.read_text())
    c = t["real_time"]["lateness"]["control"]
    degraded = ", ".join(f"{k} x{v}" for k, v in t["real_time"]["degraded"].items()) or "nothing"
    print(f"{file.parent.name:>12} {t['simulated_s']:5.0f} {c['count']:6d} {c['p50_ms']:7.3f} {c['p99_ms']:7.3f}"
          f" {c['p99_9_ms']:8.3f} {c['max_ms']:7.3f} {c['missed_deadlines']:6d}"
          f" {sum(j['overruns'] for j in t['jobs'].values()):8d}  {degraded}")
for file in sorted(out.glob("clients_*.txt")):
    print(file.name + ": " + file.read_text().strip())
END
