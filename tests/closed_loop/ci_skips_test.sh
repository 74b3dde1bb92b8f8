#!/bin/sh
# .ci/ctest with a ctest that only says so: on CI a skipped test of the packages is a failure that names it, and
# elsewhere it is a skipped test. usage: ci_skips_test.sh SOURCE_DIR WORK_DIR
set -eu
source=$1 work=$2
rm -rf "$work" && mkdir -p "$work/bin" "$work/build"
failed() { echo "failed: $1"; cat "$work/said"; exit 1; }
says() { # what ctest prints, and its exit code
  printf '#!/bin/sh\ncat <<END\n%s\nEND\nexit %s\n' "$1" "$2" > "$work/bin/ctest"
  chmod +x "$work/bin/ctest"
}
counts() { # 1: CI's value; sets code
  code=0
  env CI="$1" PATH="$work/bin:$PATH" "$source/.ci/ctest" "$work/build" > "$work/said" 2>&1 || code=$?
}
passed=' 1/4 Test #7: Goals.QuoteTheReasons .................   Passed    0.10 sec'
allowed=' 2/4 Test #8: OctomapIo.ReadsTheMaps ................***Skipped   0.01 sec'
packages=' 3/4 Test #9: deb_packages ..........................***Skipped   0.02 sec
 4/4 Test #10: abidiff.removed_slot ...................***Skipped   0.02 sec
 5/5 Test #11: SurveyFlight.ACaveMadeOfASurveyIsFlownAndLandedIn ...***Skipped   0.02 sec'

says "$passed
$allowed
$packages" 0
counts true
test "$code" = 1 || failed "CI is green without a test of the packages"
grep -qx 'failed: CI must not skip deb_packages abidiff.removed_slot SurveyFlight.ACaveMadeOfASurveyIsFlownAndLandedIn' "$work/said" || failed "it does not name them"
grep -qx '1 passed, 0 failed, 4 skipped' "$work/said" || failed "the counts"
counts ""
test "$code" = 0 || failed "away from CI they may be skipped"

says "$passed
$allowed" 0
counts true
test "$code" = 0 || failed "CI may skip a test that needs files which are not in the repository"

says "$packages" 8
counts true
test "$code" = 8 || failed "ctest's own exit code is $code"
