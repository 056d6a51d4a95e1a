#!/bin/bash
# A step takes at most 5 % more instructions than instruction_counts.txt says, with SSE2 and with AVX2. Callgrind counts them.
# Where dampers are light, `leapfrog` takes at most 1.15 times the instructions of `cordis` on the same scene.
# No step of a melt takes more than twice the median.
# usage: instruction_counts_test.sh PROGRAM COUNTS; with CORDIS_WRITE_COUNTS=1 it writes the file
set -euo pipefail

program=$1
counts=$2
renew="CORDIS_WRITE_COUNTS=1 bash tests/bench/instruction_counts_test.sh build/release/bin/counted_steps tests/bench/instruction_counts.txt"
type -P valgrind >/dev/null || { echo "skipped: valgrind is not installed (Debian package valgrind)"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

valgrind --tool=callgrind --callgrind-out-file="$folder/dump" --zero-before=cordis_counted_steps \
  --dump-after=cordis_counted_steps "$program" >"$folder/scenes" 2>"$folder/log" || { cat "$folder/log"; exit 1; }
compiler=$(sed -n 's/^compiler //p' "$folder/scenes")
{
  echo "# Instructions of a step, for each link or ball, as callgrind counts them; of longest_step, over the median. Written by:"
  echo "# $renew"
  echo "compiler $compiler"
  number=0
  while read -r width scene elements; do
    number=$((number + 1))
    instructions=$(sed -n 's/^summary: //p' "$folder/dump.$number")
    ((instructions > 0)) || { echo "nothing was counted of $width $scene" >&2; exit 1; }
    awk -v name="$width $scene" -v instructions="$instructions" -v elements="$elements" \
      'BEGIN { printf "%s %.2f\n", name, instructions / elements }'
  done < <(grep -v '^compiler ' "$folder/scenes")
} >"$folder/all"
{
  grep -v ' each:' "$folder/all"
  for width in $(sed -n 's/ each:melt .*//p' "$folder/all" | sort -ru); do
    sed -n "s/^$width each:melt //p" "$folder/all" | sort -n |
      awk -v width="$width" '{ step[NR] = $1 } END { printf "%s longest_step_of_a_melt %.2f\n", width, step[NR] / step[int((NR + 1) / 2)] }'
  done
} >"$folder/measured"
awk '
  { value[$1 " " $2] = $3; widths[$1] }
  function hold(what, ratio, most) { if (!(ratio <= most)) { printf "%s: %.2f, more than %s\n", what, ratio, most; bad = 1 } }
  END {
    for (name in value) {
      if (name !~ / leapfrog_/) continue
      other = name
      sub(/ leapfrog_/, " ", other)
      if (!(other in value)) { printf "%s: no scene %s beside it\n", name, other; bad = 1; continue }
      ++compared
      hold(name " over " other, value[name] / value[other], 1.15)
    }
    if (!compared) { print "no scene of leapfrog was counted"; bad = 1 }
    for (width in widths) {
      if (width != "sse2" && width != "avx2") continue
      hold(width " longest_step_of_a_melt over the median", value[width " longest_step_of_a_melt"], 2)
    }
    exit bad
  }' "$folder/measured"
grep -q '^sse2 ' "$folder/measured" || { echo "no scene was counted"; cat "$folder/log"; exit 1; }

if [[ -n ${CORDIS_WRITE_COUNTS-} ]]; then
  grep -q '^avx2 ' "$folder/measured" || { echo "this processor lacks AVX2: $counts stays as it is"; exit 1; }
  cp "$folder/measured" "$counts"
  exit 0
fi
known=$(sed -n 's/^compiler //p' "$counts")
if [[ $known != "$compiler" ]]; then
  echo "skipped: the counts are those of $known, and $compiler has built this"
  exit 77
fi
awk -v renew="$renew" '
  /^#|^compiler / { next }
  NR == FNR { known[$1 " " $2] = $3; next }
  {
    name = $1 " " $2
    widths[$1]
    if (!(name in known)) { printf "%s: not in the file\n", name; bad = 1; next }
    change = 100 * ($3 / known[name] - 1)
    verdict = change > 5 ? "   <- more than 5 % above the file" : change < -5 ? "   fewer: write the file again" : ""
    printf "%-32s %9.2f instead of %9.2f: %+.1f %%%s\n", name, $3, known[name], change, verdict
    if (change > 5) bad = 1
    delete known[name]
  }
  END {
    for (name in known) {
      split(name, word, " ")
      if (word[1] in widths) { printf "%s: only in the file\n", name; bad = 1 }
    }
    if (bad) printf "Mend the step. Where the cost is meant, write the file again:\n  %s\n", renew
    exit bad
  }' "$counts" "$folder/measured"
