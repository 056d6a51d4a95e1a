#!/bin/bash
# tests/cli/doctor_test.sh CORDIS -- the real `cordis doctor`: every example of its help, and what it refuses.
set -uo pipefail

directory=$(dirname -- "$1")
PATH=$directory:$PATH
failures=0
fail() {
  printf 'FAILED: %s\n%s\n' "$1" "$2"
  failures=$((failures + 1))
}

examples=0
while read -r words; do
  examples=$((examples + 1))
  words=${words/60s/1s}  # as long as a test may take
  # shellcheck disable=SC2086  # words of a command line
  output=$($words </dev/null 2>&1)
  code=$?
  ((code == 0 || code == 1)) || fail "$words ends with $code" "$output"
  [[ $output == *force_loop_at_1_khz* || $output == *'A force loop at 1 kHz '* ]] || fail "$words" "$output"
  verdict=$(grep -c 'cannot work\|"force_loop_at_1_khz": false' <<<"$output")
  ((verdict == code)) || fail "$words: its exit code is not what it says" "$output"
done < <(cordis doctor --help | sed -n 's/^  \(cordis doctor.*\)$/\1/p' | grep -v '  ')
((examples == 3)) || fail "examples found: $examples" ""

keys=$(cordis doctor --json --duration 100ms | grep -o '"key": "[a-z._]*"' | cut -d'"' -f4)
(($(wc -w <<<"$keys") == 15)) || fail 'the checks of the JSON' "$keys"
for key in $keys; do
  cordis doctor --help | grep -q "\b$key\b" || fail "the help does not name the key $key" ""
done

for words in '--port 0' '--domain 102' '--duration 3' '--jsno' 'word'; do
  # shellcheck disable=SC2086
  output=$(cordis doctor $words 2>&1)
  code=$?
  ((code == 2)) || fail "cordis doctor $words ends with $code" "$output"
done

if ((EUID == 0)) && type -P setpriv >/dev/null; then  # as somebody who has no rights
  output=$(setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all --inh-caps=-all -- \
    "$(command -v cordis)" doctor --duration 200ms 2>&1)
  code=$?
  if ((code == 126 || code == 127)); then
    printf 'not tried as another user, who may not start %s\n' "$(command -v cordis)"
  else
    [[ $output == *'A force loop at 1 kHz '* ]] || fail "as another user it ends with $code" "$output"
  fi
fi

((failures == 0)) && printf 'all well\n'
exit $((failures > 0))
