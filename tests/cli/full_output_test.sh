#!/bin/bash
# tests/cli/full_output_test.sh CORDIS SOURCE_DIRECTORY -- each verb that prints says when that cannot be written, once.
set -euo pipefail
cordis=$1
scene=$2/launch_configs/scenes/plucked_string.yaml
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export CORDIS_RUNTIME_DIR=$folder/runtime
failed=0

expect() {  # WHERE REASON WORDS: where standard output goes, the reason that is said, if any
  local where=$1 reason=$2 code=0
  shift 2
  case $where in
    full) "$cordis" "$@" >/dev/full 2>"$folder/error" || code=$? ;;
    closed) "$cordis" "$@" >&- 2>"$folder/error" || code=$? ;;
  esac
  if [[ $code -ne 1 || $(grep -c "^cordis.*: cannot write the output$reason\$" "$folder/error") -ne 1 ]]; then
    echo "cordis $* with $where output: exit code $code and"
    cat "$folder/error"
    failed=1
  fi
}

for where in full closed; do
  reason=': No space left on device'
  [[ $where == full ]] || reason=': Bad file descriptor'
  expect $where "$reason" --help
  expect $where "$reason" --version
  expect $where "$reason" check --help
  expect $where "$reason" list
  expect $where "$reason" list --json
  # Longer than a buffer: the reason is gone at the end.
  expect $where '.*' check --json - "$scene"
  expect $where '.*' check "$scene"
  expect $where '.*' schema scene
done
"$cordis" --help | head -c 1 >/dev/null  # a reader that has gone is no failure
exit $failed
