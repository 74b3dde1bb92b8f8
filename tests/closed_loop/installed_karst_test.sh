#!/bin/sh
# What `cmake --install` puts down can fly: the vehicle and the policies are found beside the installed command.
# usage: installed_karst_test.sh BINARY_DIR WORK_DIR
set -eu
binary=$1 work=$2
rm -rf "$work" && mkdir -p "$work"
cmake --install "$binary" --prefix "$work/karst" > "$work/install.log"
karst=$work/karst/bin/karst
cd "$work"
export HOME="$work"  # no policies of this user
"$karst" cave generate --preset small --seed 7 --set volume=500 --set "grid=0.4 m" --out cave > cave.log 2>&1

# Pages and examples that help texts name are those of this installation.
{ "$karst" --help-all; "$karst" fly --keys; "$karst" replay --keys; } > help.txt
grep -oE "[^[:space:]\"'(]*(docs|examples)/[A-Za-z0-9_./-]*[A-Za-z0-9_]" help.txt | sort -u > named.txt
test "$(wc -l < named.txt)" -ge 5
while read -r path; do
  case $path in
    "$(realpath "$work")/karst/share/doc/karst/"*) test -e "$path" || { echo "help names $path, which is not there"; exit 1; } ;;
    *) echo "help names $path, which is not of this installation"; exit 1 ;;
  esac
done < named.txt

code=0
"$karst" fly --quiet --cave cave.info --policy nearest_frontier --set "mission.max_flight_time=10 s" --out run \
  > fly.log 2>&1 || code=$?
cat fly.log
test $code = 0 || test $code = 2  # flown; where it landed is not the question
test -s run/telemetry.csv && test -s run/report.html
