#!/bin/bash
# Plays what strangers may send into the readers of Cordis with libFuzzer, and says what each target did.
#
# usage: tests/campaigns/fuzz.sh [-r RUNS] [-t SECONDS] [-s SEED] [-o FOLDER] [TARGET...]
#   -r RUNS     executions of each target (1000000)
#   -t SECONDS  longest time of each target (3600)
#   -s SEED     where its changes begin (1)
#   -o FOLDER   where TARGET.log, what it has found and its grown corpus go (build/campaigns/fuzz)
#   TARGET      such as kfb1; all of tests/fuzz when none is named
# Exit code: 0 when no target found a crash, a leak, an input of 1 s, or more than 1 GB of memory; 1 when one did; 2 when the
# campaign could not begin: clang-19 and libclang-rt-19-dev (packages.txt) are needed.
set -euo pipefail

root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "$0")")")")
runs=1000000
longest=3600
seed=1
folder=$root/build/campaigns/fuzz
while getopts r:t:s:o: option; do
  case $option in
    r) runs=$OPTARG ;;
    t) longest=$OPTARG ;;
    s) seed=$OPTARG ;;
    o) folder=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))

probe=$(mktemp -d)
trap 'rm -rf -- "$probe"' EXIT
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' >"$probe/probe.cpp"
if ! clang++-19 -fsanitize=fuzzer "$probe/probe.cpp" -o "$probe/probe" 2>"$probe/log"; then
  echo "fuzz.sh: no fuzzer of clang-19 here (Debian: clang-19, libclang-rt-19-dev)" >&2
  exit 2
fi

targets=("$@")
if ((${#targets[@]} == 0)); then
  for corpus in "$root"/tests/fuzz/corpus/*/; do targets+=("$(basename -- "$corpus")"); done
fi
(cd "$root" && cmake --preset fuzz) >"$probe/log" || { cat "$probe/log" >&2; exit 2; }
ninja -C "$root/build/fuzz" "${targets[@]/#/fuzz_}" >"$probe/log" || { cat "$probe/log" >&2; exit 2; }

found=0
mkdir -p "$folder"
printf '%-14s %12s %10s %8s  %s\n' target executions seconds 'peak MB' result
for target in "${targets[@]}"; do
  mkdir -p "$folder/corpus/$target" "$folder/found/$target"
  log=$folder/$target.log
  result=nothing
  more=() # files that Cordis has anyway, and the words of a language
  case $target in
    scene) more=("$root/launch_configs/scenes" "$root/launch_configs/liaisons") ;;
    device) more=("$root/launch_configs/devices") ;;
  esac
  words=$root/tests/fuzz/words/$target
  if [[ -e $words ]]; then more=("-dict=$words" "${more[@]}"); fi
  began=$SECONDS
  nice -n 10 "$root/build/fuzz/bin/fuzz_$target" -runs="$runs" -max_total_time="$longest" -seed="$seed" \
    -timeout=1 -rss_limit_mb=1024 -max_len=16384 -print_final_stats=1 -verbosity=0 \
    -artifact_prefix="$folder/found/$target/" "$folder/corpus/$target" "$root/tests/fuzz/corpus/$target" "${more[@]}" \
    >"$log" 2>&1 </dev/null || { result="found: see $log"; found=1; }
  stat_of() { sed -n "s/^stat::$1: *//p" "$log" | tail -n 1; }
  printf '%-14s %12s %10s %8s  %s\n' "$target" "$(stat_of number_of_executed_units)" "$((SECONDS - began))" \
    "$(stat_of peak_rss_mb)" "$result"
done
exit "$found"
