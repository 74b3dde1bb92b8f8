#!/usr/bin/env bash
# interop_test.sh KARST FOLDER: a flight, followed by Foxglove's own client, which is installed into FOLDER, and compared
# with its run directory. Skipped (77) without node, or where npm cannot reach the packages.
set -u
karst=$1; folder=$2
packages=(@foxglove/ws-protocol@0.8.0 ws@8.18.0 @foxglove/rosmsg@5.0.5 @foxglove/rosmsg2-serialization@3.1.0)
command -v node >/dev/null || { echo "skipped: no node"; exit 77; }
if [ ! -d "$folder/node_modules/@foxglove/ws-protocol" ] || [ ! -d "$folder/node_modules/ws" ]; then
  command -v npm >/dev/null || { echo "skipped: no npm"; exit 77; }
  mkdir -p "$folder"
  (cd "$folder" && timeout 120 npm install --silent --no-save --prefix . "${packages[@]}") >/dev/null 2>&1 ||
    { echo "skipped: npm cannot install ${packages[*]}"; exit 77; }
fi
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$folder/runs"; mkdir -p "$folder/runs"
"$karst" cave generate --preset maze --seed 7 --out "$folder/runs/cave" >/dev/null 2>&1 || exit 1
flight=(fly --cave "$folder/runs/cave.info" --policy nearest_frontier --seed 7 --time 40s --no-report)
"$karst" "${flight[@]}" --out "$folder/runs/alone" >/dev/null 2>&1
# Five clients: three that follow all, one that reads nothing, one that sends garbage.
node "$here/interop.mjs" "$folder/node_modules" "$folder/runs/followed" "$karst" "${flight[@]}" \
  --out "$folder/runs/followed" --live=127.0.0.1:0 || exit 1
# The flight is the same, but for the times that its decisions took.
for file in "$folder"/runs/alone/*; do
  name=$(basename "$file")
  case $name in timing.json | decisions.csv) continue ;; esac
  cmp "$file" "$folder/runs/followed/$name" || exit 1
done
echo "the run directory is the same with five clients as with none"
