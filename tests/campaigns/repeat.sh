#!/bin/bash
# Runs tests again and again beside a load, and keeps the output of every run.
#
# usage: tests/campaigns/repeat.sh [-n RUNS] [-l LOAD] [-b BUILD_FOLDER] [-o FOLDER] [-- CTEST_WORD...]
#   -n RUNS    how often (5)
#   -l LOAD    none; steal:SHARE:LONGEST_S, a host that takes SHARE of each core away in bursts of up to LONGEST_S;
#              loops:COUNT, so many busy loops of ordinary priority (none)
#   -b FOLDER  where the programs and tests are built (build/release)
#   -o FOLDER  where run-N.log and summary.txt go (build/campaigns/LOAD)
#   CTEST_WORD for ctest, such as -L integration -R Restart
# Exit code: 0 when every run passed, 1 when a test failed, 2 when the campaign could not begin.
#
# ./cordis test must have built the tests before. Example, hours long:
#   tests/campaigns/repeat.sh -n 5 -l steal:0.3:0.25 -- -L integration
set -euo pipefail

root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "$0")")")")
runs=5
load=none
build=$root/build/release
folder=
while getopts n:l:b:o: option; do
  case $option in
    n) runs=$OPTARG ;;
    l) load=$OPTARG ;;
    b) build=$(readlink -f -- "$OPTARG") ;;
    o) folder=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
[[ -n $folder ]] || folder=$root/build/campaigns/${load//:/-}
mkdir -p "$folder"
folder=$(readlink -f -- "$folder")

host=
tests=
end_load() {
  [[ -n $host ]] || return 0
  kill "$host" 2>/dev/null || true
  wait "$host" || true
  host=
}
# shellcheck disable=SC2317  # called by the trap
end_all() {
  [[ -z $tests ]] || kill -- "-$tests" 2>/dev/null || true
  end_load
}
trap end_all EXIT
trap 'exit 130' INT TERM

# The load runs in the background until end_load; it ends by itself when this script is killed.
begin_load() {
  [[ $load != none ]] || return 0
  local -a words
  IFS=: read -r -a words <<<"$load"
  "$build/bin/busy_host" "${words[@]}" >>"$folder/load.log" 2>&1 &
  host=$!
  sleep 0.2
  kill -0 "$host" 2>/dev/null && return
  host=
  tail -n 1 "$folder/load.log" >&2
  exit 2
}

say() { printf '%s\n' "$*" | tee -a "$folder/summary.txt"; }

# failed_in LOG: the names of the tests that failed, one in a line.
failed_in() { sed -n '/^The following tests FAILED/,$ s/^\t *[0-9]* - \([^ ]*\) (.*/\1/p' "$1" | sort; }

rm -f "$folder"/run-*.log "$folder/summary.txt" "$folder/load.log"
say "$runs runs, load $load: ctest $*"
status=0
for ((run = 1; run <= runs; ++run)); do
  log=$folder/run-$run.log
  begin=$SECONDS
  begin_load
  result=passed
  setsid ctest --test-dir "$build/tests" --output-on-failure --no-tests=error "$@" >"$log" 2>&1 </dev/null &
  tests=$!
  wait "$tests" || result=FAILED
  tests=
  end_load
  [[ $result == passed ]] || status=1
  say "run $run $result in $((SECONDS - begin)) s: $(grep -E 'tests passed|No tests' "$log" || echo 'ctest itself failed')"
  failed_in "$log" | while read -r name; do say "  $name"; done
done
[[ $load == none ]] || tail -n "$runs" "$folder/load.log"
exit $status
