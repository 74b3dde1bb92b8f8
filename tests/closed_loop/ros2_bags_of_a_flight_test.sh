#!/usr/bin/env bash
# ros2_bags_of_a_flight_test.sh KARST WORK_FOLDER NODE_FOLDER: the sensors of a simulated flight, written as MCAP by
# @mcap/core and as db3 by Python, replay to the same trajectory as the folder that the flight recorded.
# Skipped (77) without node, or where npm cannot reach the packages.
set -u
karst=$1; work=$2; here=$(dirname "$0")/../unit/replay/bag
. "$here/node_packages.sh"
node_packages "$3"
rm -rf "$work"; mkdir -p "$work/bags"
"$karst" cave generate --preset small --seed 7 --out "$work/cave" --quiet || exit 1
"$karst" fly --cave "$work/cave.info" --seed 7 --time 40s --set record.scans=true \
  --set simulator.lidar.columns=256 --quiet --no-report --out "$work/flight" >/dev/null || exit 1
replay() { "$karst" replay "$1" --out "$2" --quiet --no-report >"$2.log" 2>&1; }
replay "$work/flight/scans" "$work/expected" || { cat "$work/expected.log"; exit 1; }
[ "$(wc -l < "$work/expected/trajectory.tum")" -ge 150 ] || { echo "the folder gives no trajectory"; exit 1; }
node "$here/recorded_flight.mjs" "$work/flight/scans" "$work/bags" "$3/node_modules" || exit 1
python3 "$here/write_db3.py" "$work/bags/messages.jsonl" "$work/bags/python.db3" || exit 1
rm "$work/bags/messages.jsonl"
count=0; failures=0
for bag in "$work"/bags/*.mcap "$work"/bags/*.db3; do
  name=$(basename "$bag"); count=$((count + 1))
  cp "$work/flight/scans/recording.info" "${bag%.*}.info"  # where the LiDAR is mounted
  if ! replay "$bag" "$work/$name.run" ||
      ! cmp "$work/expected/trajectory.tum" "$work/$name.run/trajectory.tum"; then
    echo "FAILED $name"; cat "$work/$name.run.log"; failures=$((failures + 1))
  fi
done
echo "$count bags of $(ls "$work/flight/scans" | grep -c pcd) scans, $failures failures"
[ "$count" -eq 4 ] && [ "$failures" -eq 0 ] && rm -rf "$work"
