#!/bin/sh
# A new author with nothing but what `cmake --install` puts down, in a root of its own where no source tree is to be seen: from
# `karst policy new` to a flown mission. Prints each command and the seconds it took.
# usage: clean_root_test.sh BINARY_DIR|- WORK_DIR [ROOT]
#   -: nothing is put down; ROOT has karst, from Debian packages for example
#   ROOT: a root file system with a compiler, CMake and karst's run-time libraries, such as debootstrap makes; it
#   stays as it is. Without it, this machine's /usr and /etc serve, and nothing else of it.
set -eu
if [ "${1:-}" != --inside ]; then
  binary=$1 work=$2 base=${3:-}
  rm -rf "$work" && mkdir -p "$work/root" "$work/prefix"
  if [ "$binary" != - ]; then
    for component in sdk karst; do
      cmake --install "$binary" --component $component --prefix "$work/prefix" > "$work/install.log"
    done
  fi
  cp "$0" "$work/clean_root_test.sh"
  user=""
  [ "$(id -u)" = 0 ] || user=--map-root-user
  unshare $user --mount --pid --fork true 2>/dev/null || { echo "skipped: this machine gives no namespaces"; exit 77; }
  exec unshare $user --mount --pid --fork sh "$work/clean_root_test.sh" --inside root "$work" "$base"
fi

if [ "$2" = root ]; then
  work=$3 base=$4 root=$3/root
  mount --make-rprivate / 2>/dev/null || true
  mount -t tmpfs none "$root"
  mkdir -p "$root/usr" "$root/etc" "$root/proc" "$root/dev" "$root/tmp" "$root/home/author"
  for part in usr etc; do mount --rbind "$base/$part" "$root/$part"; done
  for link in bin lib lib64; do ln -s usr/$link "$root/$link"; done
  mount --bind "$work/prefix" "$root/usr/local"
  for device in null zero urandom; do touch "$root/dev/$device"; mount --bind /dev/$device "$root/dev/$device"; done
  mount -t proc none "$root/proc"
  cp "$work/clean_root_test.sh" "$root/tmp"
  chroot=$(command -v chroot || echo /usr/sbin/chroot)
  exec env -i HOME=/home/author PATH=/usr/local/bin:/usr/bin:/bin "$chroot" "$root" /bin/sh /tmp/clean_root_test.sh --inside author
fi

cd
test ! -e /work && test ! -e /root || { echo "the checkout may be in sight"; exit 1; }
failed() { echo "failed: $1"; exit 1; }
started=$(date +%s)
type_in() { # a command, as it is typed
  echo "\$ $1"
  begin=$(date +%s)
  eval "$1" > /tmp/output 2>&1 || { cat /tmp/output; failed "$1"; }
  tail -n "${2:-3}" /tmp/output | sed 's/^/    /'
  echo "    [$(($(date +%s) - begin)) s]"
}
so=build/lib/karst/policies/deep_first.so
type_in "karst policy new deep_first" 9
type_in "cd deep_first"
type_in "cmake -S . -B build" 1
type_in "cmake --build build" 1
readelf --sections "$so" | grep -q "\.debug_info" || failed "the policy is built without debug information"
type_in "ctest --test-dir build" 4
type_in "karst policy list --plugin $so" 4
grep -q "deep_first 0.1.0" /tmp/output || failed "it is not listed"
if karst policy --help | grep -q "^ *check"; then type_in "karst policy check $so"; fi
type_in "karst cave generate --preset small --seed 7 --out caves/small"
type_in "karst fly --cave caves/small.info --policy deep_first --plugin $so --set mission.max_flight_time=60s --quiet --out runs/first" 8
grep -q "^landed: " /tmp/output || failed "it did not land"
type_in "cmake --install build --prefix ~/.local" 1
type_in "karst policy list"
grep -q "$HOME/.local/share/karst/policies/deep_first.so" /tmp/output || failed "it is not listed after its installation"
type_in "karst fly --cave caves/small.info --policy deep_first --set mission.max_flight_time=60s --quiet --no-report --out runs/second" 8
cmp runs/first/trajectory.tum runs/second/trajectory.tum
echo "from an empty folder to two flown missions in $(($(date +%s) - started)) s"
