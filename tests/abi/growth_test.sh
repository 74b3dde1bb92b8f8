#!/bin/sh
# Does to a copy of the SDK what docs/abi.md's worked example says, and demands that every gate says what stands there.
# usage: growth_test.sh SOURCE_DIR BINARY_DIR WORK_DIR CC CXX
set -eu
source=$(cd "$1" && pwd) binary=$(cd "$2" && pwd) work=$3 cc=$4 cxx=$5
command -v abidiff >/dev/null || { echo "skipped: abidiff is not installed"; exit 77; }
rm -rf "$work" && mkdir -p "$work/copy/tests" && cd "$work"
for part in sdk core_stack cmake tests/abi; do cp -r "$source/$part" copy/$part; done
document=$source/docs/abi.md

fail() { echo "growth_test: $1"; exit 1; }
block() { # kind, number: a block of the worked example
  awk -v kind="$1" -v number="$2" '/^### Worked example/ {on = 1} on && $0 == "```" && inside {inside = 0}
    inside && n == number {print} on && $0 == "```" kind {inside = 1; ++n}' "$document"
}
apply() { # number of the diff
  block diff "$1" > "step$1.diff"
  test -s "step$1.diff" || fail "docs/abi.md has no diff $1"
  patch -d copy -p1 --no-backup-if-mismatch < "step$1.diff" > "step$1.log" || { cat "step$1.log"; fail "diff $1 of docs/abi.md does not apply"; }
}
says() { # text, file: what the document quotes was printed; and the document does quote it
  grep -qF "$1" "$2" || { cat "$2"; fail "not said: $1"; }
  grep -qF "$1" "$document" || fail "docs/abi.md does not quote: $1"
}
layout() { "$cc" -std=c11 -fsyntax-only copy/sdk/abi/layout_check.c 2> layout.txt; }
abi() { copy/tests/abi/abidiff_test.sh copy "$work/abidiff" "$cc" "$1" > abi.txt 2>&1; }

layout && abi as_reviewed || { cat layout.txt abi.txt; fail "the ABI is not as reviewed to begin with"; }

apply 1
if layout; then fail "the layout's asserts did not see that the request and the host's table have grown"; fi
says 'assertion failed: "size of karst_host"' layout.txt
if grep -q 'offset of' layout.txt; then cat layout.txt; fail "a field that was there has moved"; fi
if abi as_reviewed; then fail "abidiff did not see the new field"; fi
says "'double battery_left_wh', at offset 2816 (in bits)" abi.txt
if grep -qE 'deletion|offset changed' abi.txt; then cat abi.txt; fail "abidiff sees more than additions at the end"; fi

apply 2
layout || { cat layout.txt; fail "the layout's asserts do not hold with the lines of diff 2"; }
grep -E '^-KARST_FIELD' step2.diff && fail "a field that was there has another line"
abi --accept
abi as_reviewed || { cat abi.txt; fail "abidiff sees a difference from its own baseline"; }

apply 3
includes="-Icopy/sdk/abi -Icopy/sdk/include -Icopy/sdk/testing -Icopy"
block cpp 1 > careful.cpp
test -s careful.cpp || fail "docs/abi.md has no policy"
plugin="-std=c++17 -O0 -Wall -Wextra -Werror -fPIC -shared -fvisibility=hidden"
"$cxx" $plugin $includes careful.cpp -o careful.so
"$cxx" $plugin -I"$source/sdk/abi" -I"$source/sdk/include" "$source/tests/abi/kept/1.0/right_hand.cpp" -o old.so
"$cxx" -std=c++20 -O0 -Wall $includes -DKARST_VERSION_MAJOR=0 -DKARST_VERSION_MINOR=1 -DKARST_VERSION_PATCH=0 \
  copy/tests/abi/growth/host_1_1.cpp copy/sdk/host/plugin/plugin_file.cpp copy/sdk/host/plugin/script_file.cpp copy/core_stack/common/input_file.cpp copy/sdk/host/plugin/process_state.cpp copy/sdk/host/boundary/text.cpp \
  -o host_1_1 -ldl -lm

answer() { ./host_1_1 "$1" "$2" > answer.txt || { cat answer.txt; fail "$1 was not asked"; }; }
olds=old.so
[ "$(uname -m)" = x86_64 ] && olds="old.so $source/tests/abi/kept/1.0/right_hand.so"
for old in $olds; do
  answer "$old" offers
  grep -q "built for 1.0" answer.txt && grep -q "outcome 1" answer.txt && grep -q "goal: .* deg to the right, 2.0 m away" answer.txt || {
    cat answer.txt; fail "$old does not answer as before"; }
done
answer careful.so offers
grep -q "built for 1.1" answer.txt
says "battery 40.0 Wh, rock at 2.0 m" answer.txt
answer careful.so bare
says "battery 0.0 Wh, rock at 0.0 m" answer.txt
grep -q "log: this karst has no clearance service" answer.txt || { cat answer.txt; fail "no line in the log"; }
if "$binary/bin/karst" policy list --plugin careful.so > list.txt; then fail "a plugin that was asked for and cannot be flown is no error"; fi
says "built for policy ABI 1.1, this karst offers 1.0: install a newer karst, or rebuild the plugin with this karst's SDK" list.txt
echo "the worked example of docs/abi.md holds"
