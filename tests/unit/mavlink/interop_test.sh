#!/usr/bin/env bash
# interop_test.sh MAVLINK_INTEROP FOLDER: karst's MAVLink against node-mavlink, which is installed into FOLDER.
# Skipped (77) without node, or where npm cannot reach the package.
set -u
program=$1; folder=$2
command -v node >/dev/null || { echo "skipped: no node"; exit 77; }
if [ ! -d "$folder/node_modules/node-mavlink" ]; then
  command -v npm >/dev/null || { echo "skipped: no npm"; exit 77; }
  mkdir -p "$folder"
  (cd "$folder" && timeout 120 npm install --silent --no-save --prefix . node-mavlink@2.3.0) >/dev/null 2>&1 ||
    { echo "skipped: npm cannot install node-mavlink"; exit 77; }
fi
node "$(dirname "$0")/interop.mjs" "$program" "$folder/node_modules"
