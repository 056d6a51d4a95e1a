#!/bin/bash
# tests/campaigns/repeat_test.sh BUSY_HOST -- repeat.sh with tests of its own: what it counts, logs and returns.
set -euo pipefail

place=$(mktemp -d "${TMPDIR:-/tmp}/cordis campaign test XXXXXX")
trap 'rm -rf "$place"' EXIT
repeat=$(dirname -- "$(readlink -f -- "$0")")/repeat.sh
mkdir -p "$place/build/bin" "$place/build/tests"
ln -s "$(readlink -f -- "$1")" "$place/build/bin/busy_host"
cat >"$place/build/tests/CTestTestfile.cmake" <<END
add_test(good true)
add_test(odd bash -c "echo words of the odd one; mkdir '$place/seen' 2>/dev/null")
END

failures=0
# expect WHAT ACTUAL PATTERN
expect() {
  # shellcheck disable=SC2053  # a pattern on purpose
  [[ $2 == $3 ]] && return
  printf 'FAILED: %s\n--- expected\n%s\n--- got\n%s\n' "$1" "$3" "$2"
  failures=$((failures + 1))
}

# call WORD...: its output and exit code go to $output and $code.
call() {
  code=0
  output=$("$repeat" -b "$place/build" -o "$place/out" "$@" 2>&1) || code=$?
}

call -n 2
expect 'a run that fails names the tests' "$output" "2 runs, load none: ctest *
run 1 passed in * s: 100% tests passed, 0 tests failed out of 2
run 2 FAILED in * s: 50% tests passed, 1 tests failed out of 2
  odd"
expect 'and the campaign fails' "$code" 1
expect 'the output of a failed test is kept' "$(<"$place/out/run-2.log")" '*words of the odd one*'
expect 'the summary is kept' "$(<"$place/out/summary.txt")" "$output"

call -n 1 -l loops:2 -- -R good
expect 'a load runs beside, and its share is reported' "$output" "1 runs, load loops:2: ctest -R good
run 1 passed in * s: 100% tests passed, 0 tests failed out of 1
took * % of the time in 2 threads for * s"
expect 'all passed' "$code" 0

call -n 1 -- -R nothing
expect 'a selection without tests is a failure' "$code" 1

call -n 1 -l loops:many
expect 'a load that cannot be is reported' "$output" '*usage: busy_host *'
expect 'before anything runs' "$code" 2

((failures == 0)) && printf 'all well\n'
exit $((failures > 0))
