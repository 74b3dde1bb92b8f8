#!/usr/bin/env bash
# Flies in 50 generated caves without loops, replays the recorded scans, and compares the closures with the truth:
#   loops_campaign.sh KARST FOLDER [KEY=VALUE ...]
# It goes on where it was stopped. The scans take about 0.3 GB a flight. docs/results/loops.md
set -eu
karst=$1 folder=$2
shift 2
here=$(dirname "$(readlink -f "$0")")
presets=(small medium vertical tight maze)
settings=()
for s in "$@"; do settings+=(--set "$s"); done
mkdir -p "$folder/caves" "$folder/flights" "$folder/replays"
for i in $(seq 1 50); do
  cave=$folder/caves/$i flight=$folder/flights/$i replay=$folder/replays/$i
  if ! [ -f "$flight.done" ]; then
    rm -rf "$flight"
    "$karst" cave generate --preset "${presets[$((i % 5))]}" --seed "$i" --set loops=0 --out "$cave" --quiet --force
    # Exit code 2: the flight did not end as planned. Its scans are as good.
    "$karst" fly --cave "$cave.info" --policy nearest_frontier --seed "$i" --time "110 s" --set record.scans=true \
      --out "$flight" --no-report --quiet || [ $? = 2 ]
    touch "$flight.done"
  fi
  if ! [ -f "$replay.done" ]; then
    rm -rf "$replay"
    "$karst" replay "$flight/scans" --out "$replay" --no-report --quiet ${settings[@]+"${settings[@]}"} > "$replay.txt"
    touch "$replay.done"
  fi
  python3 "$here/judge_loops.py" "$flight/ground_truth.tum" "$replay"
done
