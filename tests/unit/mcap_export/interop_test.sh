#!/usr/bin/env bash
# interop_test.sh MCAP_INTEROP FOLDER: an exported run, read by Foxglove's libraries, which are installed into FOLDER.
# Skipped (77) without node, or where npm cannot reach the packages.
set -u
program=$1; folder=$2
packages=(@mcap/core@2.2.2 @foxglove/rosmsg@5.0.5 @foxglove/rosmsg2-serialization@3.1.0
          @foxglove/rosmsg-msgs-common@3.2.3 fzstd@0.1.1)
command -v node >/dev/null || { echo "skipped: no node"; exit 77; }
if [ ! -d "$folder/node_modules/@mcap/core" ] || [ ! -d "$folder/node_modules/fzstd" ]; then
  command -v npm >/dev/null || { echo "skipped: no npm"; exit 77; }
  mkdir -p "$folder"
  (cd "$folder" && timeout 120 npm install --silent --no-save --prefix . "${packages[@]}") >/dev/null 2>&1 ||
    { echo "skipped: npm cannot install ${packages[*]}"; exit 77; }
fi
"$program" "$folder/exported" || exit 1
node "$(dirname "$0")/interop.mjs" "$folder/node_modules" "$folder/exported/run.mcap" "$folder/exported/run"
