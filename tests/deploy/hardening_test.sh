#!/bin/bash
# The programs are compiled and linked as docs/security.md says.
# usage: hardening_test.sh PROGRAM_FOLDER
set -uo pipefail

failures=0
fail() {
  printf 'FAILED: %s\n' "$*"
  failures=$((failures + 1))
}

for name in cordis sim_node device_node viz_node record_node; do
  program=$1/$name
  header=$(readelf -hldW "$program") || fail "readelf cannot read $program"
  grep -q 'Type: *DYN' <<<"$header" || fail "$name is not position independent"
  grep -q 'FLAGS_1.*PIE' <<<"$header" || fail "$name is not marked as position independent"
  grep -q 'FLAGS_1.*NOW' <<<"$header" || fail "$name binds symbols while it runs"
  grep -q 'GNU_RELRO' <<<"$header" || fail "$name has a writable table of addresses"
  grep -q 'GNU_STACK.*RW ' <<<"$header" || fail "$name has no stack that is only read and written"
  grep -q 'GNU_STACK.*RWE' <<<"$header" && fail "$name has a stack that can be executed"
  symbols=$(readelf --dyn-syms -W "$program")
  grep -q '__stack_chk_fail' <<<"$symbols" || fail "$name does not check its stack frames"
  grep -Eq '__[a-z]+_chk@' <<<"$symbols" || fail "$name does not check bounds of the C library"
done

((failures == 0)) || exit 1
printf 'five programs are hardened\n'
