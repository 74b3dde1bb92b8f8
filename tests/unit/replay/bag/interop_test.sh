#!/usr/bin/env bash
# interop_test.sh BAG_INTEROP FOLDER: bags written by other implementations (MCAP and CDR by npm's packages, which are
# installed into FOLDER; db3 by Python) give the trajectory of the files they were made of.
# Skipped (77) without node, or where npm cannot reach the packages.
set -u
program=$1; folder=$2; here=$(dirname "$0")
command -v node >/dev/null || { echo "skipped: no node"; exit 77; }
if [ ! -d "$folder/node_modules/zstd-codec" ]; then
  command -v npm >/dev/null || { echo "skipped: no npm"; exit 77; }
  mkdir -p "$folder"
  (cd "$folder" && timeout 120 npm install --silent --no-save --prefix . @mcap/core@2.2.2 \
    @foxglove/rosmsg2-serialization@3.1.0 @foxglove/rosmsg@5.0.5 lz4-napi@2.10.0 zstd-codec@0.1.5) >/dev/null 2>&1 ||
    { echo "skipped: npm cannot install @mcap/core and others"; exit 77; }
fi
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
"$program" files "$work/scans" || exit 1
mkdir "$work/bags"
node "$here/interop.mjs" "$work/scans" "$work/bags" "$folder/node_modules" || exit 1
command -v python3 >/dev/null && python3 "$here/write_db3.py" "$work/bags/messages.jsonl" "$work/bags/python.db3"
"$program" replay "$work/scans" "$work/run" > "$work/expected" || exit 1
[ "$(wc -l < "$work/expected")" -ge 10 ] || { echo "the files give no trajectory"; exit 1; }
count=0; failures=0
for bag in "$work"/bags/*.mcap "$work"/bags/*.db3; do
  [ -e "$bag" ] || continue
  name=$(basename "$bag"); count=$((count + 1))
  if ! "$program" replay "$bag" "$work/run_$name" > "$work/found" || ! cmp -s "$work/expected" "$work/found"; then
    echo "FAILED $name"; failures=$((failures + 1))
  fi
done
echo "$count bags, $failures failures"
[ "$count" -ge 7 ] && [ "$failures" -eq 0 ]
