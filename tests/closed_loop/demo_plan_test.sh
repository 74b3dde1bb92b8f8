#!/bin/sh
# What `make demo` compiles, as a fresh clone would: what a flight needs and no more; and what it says beforehand.
# usage: demo_plan_test.sh SOURCE_DIR WORK_DIR
set -eu
source=$1 work=$2
rm -rf "$work" && mkdir -p "$work"
failed() { echo "failed: $1"; exit 1; }
cmake -S "$source" -B "$work/build" -G Ninja -DKARST_FLIGHT_ONLY=ON -DKARST_TESTS=OFF > "$work/configure.log" 2>&1 ||
  { cat "$work/configure.log"; exit 1; }
ninja -C "$work/build" -n flight > "$work/commands"
for needed in core_stack/mission plugins/simulator/cave_generator sdk/flight sdk/evaluation policies/CMakeFiles/nearest_frontier; do
  grep -q "Building.* $needed" "$work/commands" || failed "nothing of $needed is compiled"
done
if grep -E 'Building.* (sdk/(campaign|check|map_merge|preflight|replay|tuning)|plugins/replay|policies/CMakeFiles/[^n]|sdk/selection/CMakeFiles/karst_selection|tests)' "$work/commands"; then
  failed "a flight needs none of these"
fi

# The number that it says before there is a build folder is the right one, or nearly.
plan() { "$source/.ci/demo" --plan "$1" 2 > "$work/plan" || failed "$(cat "$work/plan")"; }
sources() { sed -n 's/^  2\. compile  *\([0-9]*\) sources on 2 cores: about [0-9]* minutes*$/\1/p' "$work/plan"; }
plan "$work/none"
cat "$work/plan"
said=$(sources)
plan "$work/build"
counted=$(sources)
test "$counted" = "$(grep -c ' Building ' "$work/commands")" || failed "it says $counted sources"
test "$said" -ge $((counted - 5)) && test "$said" -le $((counted + 5)) || failed ".ci/demo says $said sources, and there are $counted"
grep -qE '^  1\. packages   (all are installed|[0-9]+ and what they need, from Debian: about [0-9]+ minutes?)$' "$work/plan" || failed "packages"
grep -qE '^  3\. fly  .*: about [0-9]+ minutes?$' "$work/plan" || failed "the flight"
grep -qE '^About [0-9]+ minutes? in all\.$' "$work/plan" || failed "the sum"
grep -q 'make build' "$work/plan" || failed "it does not say what is left out"

# A folder that builds all of karst: nothing is left out, and that is not said.
cmake -S "$source" -B "$work/build" -DKARST_FLIGHT_ONLY=OFF > "$work/configure.log" 2>&1 || { cat "$work/configure.log"; exit 1; }
plan "$work/build"
if grep 'make build' "$work/plan"; then failed "this folder has every command"; fi
test "$(sources)" -gt "$counted" || failed "all of karst takes no longer than what flies"
