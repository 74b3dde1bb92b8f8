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

# Completion and manual pages lie where shells and man(1) look; the pages name documentation of this installation.
share=$work/karst/share
for file in bash-completion/completions/karst zsh/site-functions/_karst man/man1/karst.1 man/man1/karst-policy-new.1; do
  test -s "$share/$file" || { echo "$file is not installed"; exit 1; }
done
bash --norc -c ". '$share/bash-completion/completions/karst' && complete -p karst" > completion.txt
bash --norc -c ". '$share/bash-completion/completions/karst'
  COMP_WORDS=('$karst' fly --set mission.max_f) COMP_CWORD=3
  _karst
  echo \"\${COMPREPLY[*]}\"" > keys.txt
grep -qx "mission.max_flight_time=" keys.txt || { echo "keys of --set are not completed: $(cat keys.txt)"; exit 1; }

# The missions that help names fly through any cave.
for mission in "$share"/doc/karst/examples/missions/*.info; do
  "$karst" fly --quiet "$mission" --cave cave.info --check "$(basename "$mission").resolved"
done
sed 's/\\-/-/g' "$share"/man/man1/*.1 > pages.txt
if grep -F -e "$binary/share" -e KARST_DOC_FOLDER pages.txt; then echo "a manual page names the folder of the build, or none"; exit 1; fi
grep -oE "[^[:space:]\"'(]*(docs|examples)/[A-Za-z0-9_./-]*[A-Za-z0-9_]" pages.txt | sort -u > named_by_man.txt
test "$(wc -l < named_by_man.txt)" -ge 4
while read -r path; do
  case $path in
    "$share/doc/karst/"*) test -e "$path" || { echo "a manual page names $path, which is not there"; exit 1; } ;;
    *) echo "a manual page names $path, which is not of this installation"; exit 1 ;;
  esac
done < named_by_man.txt

code=0
"$karst" fly --quiet --cave cave.info --policy nearest_frontier --set "mission.max_flight_time=10 s" --out run \
  > fly.log 2>&1 || code=$?
cat fly.log
test $code = 0 || test $code = 2  # flown; where it landed is not the question
test -s run/telemetry.csv && test -s run/report.html
