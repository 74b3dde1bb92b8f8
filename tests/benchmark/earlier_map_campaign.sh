#!/usr/bin/env bash
# earlier_map_campaign.sh KARST RUNS [PROCESSES]: the flights of docs/results/earlier_map.md, in RUNS; what is there
# already is not flown again. Then: earlier_map_figures.py RUNS 11 12
set -u
karst=$1 runs=$2 processes=${3:-2} here=$(cd "$(dirname "$0")" && pwd)
export karst runs here
mkdir -p "$runs/wrong"

first() {  # CAVE NUMBER: the cave, its first flight, and the cave turned, mirrored and scaled for second ones
  local c=$1 i=$2
  [ -f "$runs/cave$c.info" ] || "$karst" cave generate --preset medium --seed "$c" --out "$runs/cave$c" --quiet
  [ -f "$runs/first_$c/metrics.json" ] ||
    "$karst" fly --cave "$runs/cave$c.info" --policy nearest_frontier --seed 1 --time "100 s" \
      --out "$runs/first_$c" --force --no-report --quiet --threads 1
  local turned="python3 $here/earlier_map_turned_cave.py $runs/cave$c.ply" factor=1.15
  [ $((i % 2)) = 0 ] && factor=0.87
  $turned "$runs/turned$c" "$runs/first_$c" $((47 * i + 20)) $((3 * i - 11)).37 $((5 - 2 * i)).21 0.$((i * 7 % 9))3 $((3 + i % 4))
  $turned "$runs/mirrored$c" "$runs/first_$c" $((31 * i + 5)) 4.1 $((2 * i)).3 0.5 4 mirror
  $turned "$runs/scaled$c" "$runs/first_$c" $((53 * i + 5)) 2.1 $((3 * i)).3 0.25 4 scale $factor
}
second() {  # ARM CAVE SEED
  local out=$runs/$1_$2_$3 map=()
  [ -f "$out/metrics.json" ] && return
  [ "$1" = with ] && map=(--set "map.start=$runs/first_$2")
  "$karst" fly --cave "$runs/turned$2.info" --policy nearest_frontier --seed "$3" --time "240 s" --out "$out" \
    --force --no-report --quiet --threads 1 --cave-cache "$runs/cache" "${map[@]}" > "$out.log" 2>&1
}
wrong() {  # CAVE MAP NAME: it must not find its place
  local out=$runs/wrong/$3
  [ -f "$out/metrics.json" ] && return
  "$karst" fly --cave "$runs/$1.info" --policy nearest_frontier --seed 3 --time "40 s" --out "$out" --force \
    --no-report --quiet --threads 1 --set map.required=true --set "map.start=$runs/first_$2" > "$out.log" 2>&1
}
export -f first second wrong

for i in $(seq 10); do echo "first $((100 + i)) $i"; done | xargs -P "$processes" -I{} bash -c '{}'
{
  for seed in 11 12; do
    for c in $(seq 101 110); do echo "second with $c $seed"; echo "second without $c $seed"; done
  done
  for i in $(seq 10); do
    c=$((100 + i))
    for other in $((101 + i % 10)) $((101 + (i + 3) % 10)); do echo "wrong turned$c $other other_${c}_$other"; done
    echo "wrong mirrored$c $c mirrored_$c"
    echo "wrong scaled$c $c scaled_$c"
  done
} | xargs -P "$processes" -I{} bash -c '{}'
grep -h '"earlier_map"' "$runs"/wrong/*/events.jsonl | grep -c '"state":"found"'
