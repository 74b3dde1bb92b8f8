# node_packages FOLDER: installs into it what interop.mjs and recorded_flight.mjs use; ends the test as skipped (77)
# without node, or where npm cannot reach the packages. To be sourced.
node_packages() {
  command -v node >/dev/null || { echo "skipped: no node"; exit 77; }
  [ ! -d "$1/node_modules/zstd-codec" ] || return 0
  command -v npm >/dev/null || { echo "skipped: no npm"; exit 77; }
  mkdir -p "$1"
  (cd "$1" && timeout 120 npm install --silent --no-save --prefix . @mcap/core@2.2.2 \
    @foxglove/rosmsg2-serialization@3.1.0 @foxglove/rosmsg@5.0.5 lz4-napi@2.10.0 zstd-codec@0.1.5) >/dev/null 2>&1 ||
    { echo "skipped: npm cannot install @mcap/core and others"; exit 77; }
}
