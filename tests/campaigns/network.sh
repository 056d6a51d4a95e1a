#!/bin/bash
# Plays sessions on two hosts over every bad cable, the long tests too, again and again, and keeps the output of each run.
#
# usage: tests/campaigns/network.sh [-n RUNS] [-b BUILD_FOLDER] [-o FOLDER]
#   -n RUNS    how often (5); a run takes minutes
#   -b FOLDER  where the tests are built (build/release)
#   -o FOLDER  where run-N.log goes (build/campaigns/network)
# Exit code: 0 when every run passed, 1 when one failed, 2 for bad options. Needs root, for network namespaces.
set -euo pipefail

root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "$0")")")")
runs=5
build=$root/build/release
folder=$root/build/campaigns/network
while getopts n:b:o: option; do
  case $option in
    n) runs=$OPTARG ;;
    b) build=$(readlink -f -- "$OPTARG") ;;
    o) folder=$OPTARG ;;
    *) exit 2 ;;
  esac
done
mkdir -p "$folder"

failed=0
for ((run = 1; run <= runs; run++)); do
  log=$folder/run-$run.log
  if "$build/bin/network_test" --gtest_also_run_disabled_tests >"$log" 2>&1; then
    printf 'run %d of %d: %s\n' "$run" "$runs" "$(grep -c '^\[       OK \]' "$log") passed"
  else
    failed=$((failed + 1))
    printf 'run %d of %d: FAILED, see %s\n' "$run" "$runs" "$log"
  fi
done
exit $((failed > 0))
