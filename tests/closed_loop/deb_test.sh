#!/bin/sh
# karst's Debian packages in a root that has nothing but Debian's minimal system: they are built, installed by the
# lines of the Dockerfile's last stage, and flown; then an author writes a policy there. Prints what took how long.
# usage: deb_test.sh SOURCE_DIR BINARY_DIR WORK_DIR
set -eu
source=$1 binary=$2 work=$3
mirror=${KARST_DEBIAN_MIRROR:-http://deb.debian.org/debian}
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" = 0 ] || skip "only root can make a root file system"
unshare --mount --pid --fork true 2> /dev/null || skip "this machine gives no namespaces"
for tool in debootstrap dpkg-shlibdeps file; do
  command -v $tool > /dev/null || skip "$tool is not installed (.ci/install deb)"
done
rm -rf "$work" && mkdir -p "$work"
/usr/lib/apt/apt-helper download-file "$mirror/dists/bookworm/Release" "$work/Release" > "$work/network.log" 2>&1 ||
  skip "$mirror cannot be reached"

"$source/.ci/deb" "$binary" "$work/packages"
for package in karst_*_amd64 karst-python_*_amd64 karst-sdk_*_all karst-doc_*_all; do
  ls "$work/packages"/$package.deb > /dev/null
done
contents() { dpkg-deb --contents "$work/packages"/$1.deb | awk '{print $6}'; }
has() { contents "$1" | grep -qx "$2" || { echo "$1 lacks $2"; exit 1; }; }
has 'karst_*' ./usr/bin/karst
has 'karst_*' ./usr/lib/karst/vehicles/libkarst_vehicle_simulator.so
has 'karst_*' ./usr/lib/karst/policies/nearest_frontier.so
has 'karst_*' ./usr/lib/karst/karst-policy-child
has 'karst_*' ./usr/share/man/man1/karst.1
dpkg-deb --fsys-tarfile "$work/packages"/karst_*.deb | tar -xO ./usr/share/man/man1/karst-fly.1 | sed 's/\\-/-/g' |
  grep -qF "/usr/share/doc/karst/examples/missions" || { echo "karst-fly(1) does not name the packaged examples"; exit 1; }
has 'karst-sdk_*' ./usr/include/karst/policy.h
has 'karst-sdk_*' ./usr/lib/cmake/karst/karstConfig.cmake
has 'karst-python_*' ./usr/lib/karst/languages/py.so
has 'karst-python_*' ./usr/lib/karst/python/karst/policy.py
has 'karst-doc_*' ./usr/share/doc/karst/docs/README.md
has 'karst-doc_*' ./usr/share/doc/karst/examples/missions/demo.info
for package in karst karst-python karst-sdk karst-doc; do has "${package}_*" "./usr/share/doc/$package/copyright"; done
for package in 'karst_*' 'karst-python_*' 'karst-sdk_*' 'karst-doc_*'; do
  if contents "$package" | grep -vE '^\./(usr/.*)?$'; then echo "these files are not below /usr"; exit 1; fi
done
depends=$(dpkg-deb --field "$work/packages"/karst_*.deb Depends)
echo "karst depends on $depends"
for library in libompl libembree libassimp libsodium; do
  case $depends in *$library*) ;; *) echo "dpkg-shlibdeps found no $library"; exit 1 ;; esac
done

debootstrap --variant=minbase bookworm "$work/root" "$mirror" > "$work/debootstrap.log" 2>&1 ||
  { tail -n 40 "$work/debootstrap.log"; exit 1; }
cp /etc/resolv.conf "$work/root/etc/resolv.conf"
mkdir "$work/root/tmp/packages"
cp "$work/packages"/*.deb "$work/root/tmp/packages"
in_root() { # a shell's words, in the root
  unshare --mount --pid --fork sh -c 'mount --make-rprivate / && mount -t proc none "$0/proc" &&
    exec env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive chroot "$0" sh -ec "$1"' \
    "$work/root" "$1"
}
started=$(date +%s)
since() { echo "[$(($(date +%s) - started)) s] $1"; }
# What RUN carries out after the last FROM; a line that ends with a backslash goes on in the next.
awk '/^FROM / {n = 0; split("", line)} /^RUN / || more {sub(/^RUN /, ""); more = /\\$/; sub(/\\$/, ""); line[n] = line[n] $0; if (!more) n++}
     END {for (i = 0; i < n; i++) print line[i]}' "$source/Dockerfile" > "$work/run_lines"
test -s "$work/run_lines" || { echo "the Dockerfile's last stage runs nothing"; exit 1; }
while read -r line; do
  in_root "$line" > "$work/apt.log" 2>&1 < /dev/null || { cat "$work/apt.log"; echo "failed: $line"; exit 1; }
done < "$work/run_lines"
since "the packages are installed"
in_root "cd /tmp && karst cave generate --preset small --seed 7 --out cave" > "$work/cave.log" 2>&1 || { cat "$work/cave.log"; exit 1; }
since "there is a cave; the flight begins"
in_root "cd /tmp && karst fly --quiet --cave cave.info --policy nearest_frontier --set mission.max_flight_time=60s --out run" |
  tee "$work/fly.log"
grep -q "^landed: " "$work/fly.log" || { echo "it did not land"; exit 1; }
test -s "$work/root/tmp/run/report.html"
since "the first flight and its report are done"

in_root "cd /tmp && karst policy new mine --template python && cd mine && karst python mine_test.py &&
  python3 -c 'import karst; print(karst.load(\"/tmp/run\").metrics[\"outcome\"])' &&
  karst policy check mine.py && karst fly --quiet --no-report --cave /tmp/cave.info --policy mine.py --time 60s --out run" \
  > "$work/python.log" 2>&1 || { cat "$work/python.log"; exit 1; }
grep -q "^landed: " "$work/python.log" || { cat "$work/python.log"; echo "the policy in Python did not land"; exit 1; }
since "a policy in Python is written, tested and flown"

in_root "apt-get update && apt-get install -y --no-install-recommends cmake g++ make" > "$work/apt.log" 2>&1 ||
  { cat "$work/apt.log"; exit 1; }
"$(dirname "$0")/clean_root_test.sh" - "$work/author" "$work/root"
rm -rf "$work/root"
