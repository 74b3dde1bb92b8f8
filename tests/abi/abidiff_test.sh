#!/bin/sh
# Compares the ABI with the reviewed baseline, and proves that the comparison would see a break.
# usage: abidiff_test.sh SOURCE_DIR WORK_DIR CC [--accept]   (--accept writes a new baseline)
set -u
source=$(cd "$1" && pwd) work=$2 cc=$3 accept=${4:-}
baseline=$source/tests/abi/karst_abi_1_0.abi
command -v abidiff >/dev/null && command -v abidw >/dev/null || { echo "skipped: abidiff is not installed"; exit 77; }
mkdir -p "$work" && cd "$work" || exit 1

build() { # headers, library
  "$cc" -std=c11 -g -O0 -fPIC -shared -fvisibility=hidden -I"$1" "$source/tests/abi/abi_probe.c" -o "$2" || exit 1
}
build "$source/sdk/abi" probe.so
if [ "$accept" = --accept ]; then
  abidw --no-corpus-path --no-comp-dir-path --no-show-locs probe.so > "$baseline"
  exit
fi
[ -f "$baseline" ] || { echo "no baseline at $baseline"; exit 1; }
if ! abidiff --no-show-locs "$baseline" probe.so; then
  echo "The ABI differs from tests/abi/karst_abi_1_0.abi. If that is meant: docs/policy_abi.md, 'Growth'."
  exit 1
fi

# A field put into a frozen struct, a slot moved, a changed type: each must be seen.
broken() { # description, file, sed expression
  rm -rf broken && cp -r "$source/sdk/abi" broken && sed -i "$3" "broken/$2"
  cmp -s "broken/$2" "$source/sdk/abi/$2" && { echo "the break '$1' changed nothing"; exit 1; }
  build broken broken.so
  if abidiff "$baseline" broken.so > broken.txt; then echo "abidiff did not see: $1"; exit 1; fi
}
broken "a field in a frozen struct" karst_abi_types.h 's/^  double tolerance_m;/  double extra; double tolerance_m;/'
broken "a smaller error text" karst_abi_types.h 's/KARST_ERROR_TEXT_SIZE 256/KARST_ERROR_TEXT_SIZE 128/'
broken "a slot's argument" karst_abi_policy.h 's/int32_t (\*activate)(void\* self, karst_error_t\*)/int32_t (*activate)(void* self, int32_t, karst_error_t*)/'
echo "the ABI is as reviewed; three breaks were seen"
