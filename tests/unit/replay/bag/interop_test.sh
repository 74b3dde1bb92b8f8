#!/usr/bin/env bash
# interop_test.sh BAG_INTEROP FOLDER: bags written by other implementations (MCAP and CDR by npm's packages, which are
# installed into FOLDER; db3 by Python) give the trajectory of the files they were made of.
# Skipped (77) without node, or where npm cannot reach the packages.
set -u
program=$1; folder=$2; here=$(dirname "$0")
. "$here/node_packages.sh"
node_packages "$folder"
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
