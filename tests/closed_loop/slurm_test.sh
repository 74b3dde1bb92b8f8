#!/usr/bin/env bash
# The Slurm executor against a real slurmctld and three slurmd on 127.0.0.1, started here and ended here:
#   tests/closed_loop/slurm_test.sh BUILD FOLDER
# One campaign here; the same on Slurm, where a node is lost for good in the middle of a trial, which is flown elsewhere,
# then the campaign is killed, and resumed: their stores hold the same rows.
set -uo pipefail
karst=$(realpath "$1")/bin/karst
work=$2
skip() { echo "skipped: $1"; exit 77; }
fail() { echo "FAILED: $1"; exit 1; }
export PATH=$PATH:/usr/sbin
. "$(dirname "$0")/slurm_cluster.sh"
missing=$(need_for_cluster)
[ -z "$missing" ] || skip "$missing"
command -v sqlite3 >/dev/null || skip "no sqlite3 (apt-get install sqlite3)"
rm -rf "$work"
mkdir -p "$work"
work=$(realpath "$work")
start_cluster "$work" 3 MinJobAge=10 SlurmdTimeout=5 || exit 1  # a node that is silent for 5 s is lost

wait_for() { # wait_for TENTHS COMMAND...
  local i
  for ((i = 0; i < $1; ++i)); do
    "${@:2}" >/dev/null 2>&1 && return
    sleep 0.1
  done
  return 1
}
"$karst" cave generate --preset small --seed 3 --set volume=300 --out "$work/cave" >"$work/cave.log" 2>&1 || fail "no cave"
campaign=(nearest_frontier highest_frontier --caves "$work/cave.info" --seeds 4 --time 12s)
rows() { for table in campaign contestant cave trial curve; do sqlite3 "$work/$1/campaign.sqlite" "SELECT * FROM $table"; done; }
here() { "$karst" compare "${campaign[@]}" --out "$work/$1" "${@:2}"; }
done_trials() { find "$work/lost/trials" -name trial.json 2>/dev/null | wc -l; }
flies_on() { compgen -G "$work/lost/flying/$1-*"; }

here local >"$work/local.txt" 2>&1 || fail "$(cat "$work/local.txt")"
[ "$(rows local | wc -l)" -gt 20 ] || fail "nothing is compared"
[ "$(sqlite3 "$work/local/campaign.sqlite" 'SELECT count(*) FROM trial WHERE status = "done"')" = 8 ] || fail "trials are missing"

(exec "$karst" compare "${campaign[@]}" --out "$work/lost" --executor slurm --batch 1 >"$work/lost.txt" 2>&1) &
coordinator=$!
wait_for 600 flies_on node2 || fail "nothing flies on node2: $(cat "$work/lost.txt")"
lose_node 2
# What has not begun is held, so that the campaign is not over before the lost trial is flown elsewhere.
readarray -t held < <(squeue --noheader --array --states=PENDING --format=%i)
[ ${#held[@]} -gt 0 ] || fail "it was over before a node could be lost"
scontrol hold "$(IFS=,; echo "${held[*]}")" || fail "tasks cannot be held"
others_done() { [ "$(done_trials)" -ge $((8 - ${#held[@]})) ]; }
wait_for 1200 others_done || fail "the trial of the lost node was not flown elsewhere: $(cat "$work/lost.txt"; squeue)"
wait_for 100 grep -q "karst: slurm: node2 was lost or taken away: 1 task starts again" "$work/lost.txt" ||
  fail "the lost node is not named: $(cat "$work/lost.txt")"
scontrol release "$(IFS=,; echo "${held[*]}")" || fail "tasks cannot be released"
wait_for 600 flies_on 'node[13]' || fail "nothing flies any more"
kill -9 $coordinator
wait $coordinator 2>/dev/null
[ -n "$(squeue --noheader)" ] || fail "it was over before it could be killed"
here lost --executor slurm --batch 2 >"$work/resumed.txt" 2>&1 || fail "$(cat "$work/resumed.txt")"
[ "$(rows lost)" = "$(rows local)" ] || fail "other rows with a lost node, kill and resume"
[ -z "$(squeue --noheader)" ] || fail "tasks are left"

here refused --executor slurm --sbatch=--partition=nowhere >"$work/refused.txt" 2>&1 && fail "a bad partition was accepted"
grep -q "slurm: sbatch: .*partition" "$work/refused.txt" || fail "$(cat "$work/refused.txt")"
echo "the same rows: here, and on Slurm with a lost node, a kill and a resumption"
