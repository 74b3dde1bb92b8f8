#!/bin/sh
# Compares the ABI with the reviewed baseline; or breaks a copy of it and demands that the gates see it.
# usage: abidiff_test.sh SOURCE_DIR WORK_DIR CC [CASE]   CASE: as_reviewed, --accept (writes a new baseline) or
#        the name of a break below
set -u
source=$(cd "$1" && pwd) work=$2 cc=$3 case=${4:-as_reviewed}
baseline=$source/tests/abi/karst_abi_1_0.abi
command -v abidiff >/dev/null && command -v abidw >/dev/null || { echo "skipped: abidiff is not installed"; exit 77; }
rm -rf "$work/$case" && mkdir -p "$work/$case" && cd "$work/$case" || exit 1

probe() { # folder of the headers
  "$cc" -std=c11 -g -O0 -fPIC -shared -fvisibility=hidden -I"$1" "$source/tests/abi/abi_probe.c" -o probe.so || exit 1
}
layout_check() { # folder of the headers; says whether the layout's asserts hold
  "$cc" -std=c11 -fsyntax-only "$1/layout_check.c" 2> layout.txt
}

# The break must be seen by abidiff as incompatible, and by the layout's asserts in the words given; "-" where they
# cannot see it, because nothing has moved: then they must hold, or this table is wrong.
broken() { # file, sed expression, what the asserts say
  cp -r "$source/sdk/abi" broken && sed -i "$2" "broken/$1"
  cmp -s "broken/$1" "$source/sdk/abi/$1" && { echo "$case changed nothing in $1"; exit 1; }
  probe broken
  abidiff "$baseline" probe.so > abidiff.txt
  test $(($? & 4)) = 4 || { echo "abidiff did not see: $case"; exit 1; }
  if layout_check broken; then
    test "$3" = - || { echo "the layout's asserts did not see: $case"; exit 1; }
  else
    grep -q "assertion failed.*$3" layout.txt || { echo "not the assert expected:"; cat layout.txt; exit 1; }
  fi
  echo "seen by abidiff:"; grep -m 4 -E "data member|offset changed|type changed|type name changed|type size changed|parameter . " abidiff.txt
  echo "by the layout's asserts: $(grep -m 1 -o 'assertion failed.*' layout.txt || echo "nothing, as nothing has moved")"
}

case $case in
  as_reviewed)
    probe "$source/sdk/abi"
    if ! abidiff --no-show-locs "$baseline" probe.so; then
      echo "The ABI differs from tests/abi/karst_abi_1_0.abi. If that is meant: docs/abi.md, \"How it grows\"."
      exit 1
    fi
    layout_check "$source/sdk/abi" || { cat layout.txt; exit 1; }
    echo "the ABI is as reviewed" ;;
  --accept)
    probe "$source/sdk/abi"
    abidw --no-corpus-path --no-comp-dir-path --no-show-locs probe.so > "$baseline" ;;
  swapped_slot)
    broken karst_abi_services.h '/int64_t (\*now_ns)/{s/.*/  SECOND/};/uint32_t (\*should_stop)/{s/.*/  int64_t (*now_ns)(const karst_host_t*) KARST_NOEXCEPT;/};s/  SECOND/  uint32_t (*should_stop)(const karst_host_t*) KARST_NOEXCEPT;/' \
           "offset of karst_host.now_ns" ;;
  swapped_slot_of_same_type)
    broken karst_abi_policy.h 's/(\*deactivate)/(*other)/;s/(\*destroy)/(*deactivate)/;s/(\*other)/(*destroy)/' \
           "offset of karst_policy.deactivate" ;;
  changed_type)
    broken karst_abi_types.h 's/^  double score; /  float score; /' - ;;
  changed_type_of_same_size)
    broken karst_abi_types.h 's/^  uint32_t cells; /  int32_t cells; /' - ;;
  changed_argument)
    broken karst_abi_policy.h 's/int32_t (\*activate)(void\* self, karst_error_t\*)/int32_t (*activate)(void* self, int32_t, karst_error_t*)/' - ;;
  smaller_text)
    broken karst_abi_types.h 's/KARST_ERROR_TEXT_SIZE 256/KARST_ERROR_TEXT_SIZE 128/' "size of karst_error" ;;
  field_in_the_middle)
    broken karst_abi_types.h 's/^  double tolerance_m;/  double extra; double tolerance_m;/' "offset of karst_goal.tolerance_m" ;;
  field_in_the_middle_of_the_request)
    broken karst_abi_policy.h 's/^  double seconds_before_homing;/  double extra; double seconds_before_homing;/' \
           "offset of karst_request.seconds_before_homing" ;;
  field_at_the_end_of_a_frozen_struct)
    broken karst_abi_types.h 's/^  karst_text_t why; .*/  karst_text_t why; double extra;/' "size of karst_goal" ;;
  *) echo "no such case: $case"; exit 1 ;;
esac
