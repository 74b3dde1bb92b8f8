#!/bin/sh
# Tunes two parameters of each policy in four caves that the selection campaign does not use, and says what they are
# worth in seven of that campaign, one of each kind. The presets are left where the campaign takes them as contestants:
# all its caves are held out.
#   tests/benchmark/selection_tune.sh KARST CAMPAIGN_FOLDER FOLDER [FLIGHTS]
# FLIGHTS of each policy, 46 if not given: 14 in the caves held out, and 8 candidates in four caves.
# Started again, it goes on.
set -eu
karst=$1 campaign=$2 folder=$3 flights=${4:-46}
here=$(dirname "$0")
python3 "$here/selection_campaign.py" caves "$folder" --karst "$karst" --seed 500000 --of-each 1 \
  --kinds gallery branches halls alpine
set --
for kind in tube gallery meander alpine branches maze halls; do
  set -- "$@" "$campaign/caves/${kind}1.info"
done
mkdir -p "$campaign/tuned"
while read -r policy first second; do
  echo "$policy: $first, $second"
  "$karst" tune "$policy" --parameter "$first" --parameter "$second" --seeds 1 \
    --caves "$folder"/caves/*.info --held-out "$@" --time "3 min" --set simulator.battery_minutes="3 min" --flights "$flights" --any-binary --quiet \
    --out "$folder/$policy" > "$folder/$policy.txt"
  if [ -f "$folder/$policy/preset.info" ]; then
    cp "$folder/$policy/preset.info" "$campaign/tuned/${policy}_tuned.info"
  fi
done <<END
nearest_frontier opening_bonus turn_cost
highest_frontier climb_worth turn_cost
lateral_frontier deviation_cost path_weight
unknown_ratio ratio_worth half_edge
information_gain gain_depth keep
viewpoint_tour keep stop_time
deep_cave even_volume reach
surface_coverage patience frontier_worth
END
