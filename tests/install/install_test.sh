#!/bin/bash
# The installed tree works away from the build tree and from its first place: a project outside compiles against its
# headers, steps a network, reads a scene; the installed programs run a session with the installed launch file.
# usage: install_test.sh BUILD_FOLDER SCRATCH_FOLDER
set -euo pipefail

build=$1
scratch=$2
outside=$(dirname -- "$(readlink -f -- "$0")")/outside

fail() {
  echo "$*"
  exit 1
}

rm -rf -- "$scratch"
mkdir -p "$scratch"
cmake --install "$build" --prefix "$scratch/first"
mv "$scratch/first" "$scratch/usr"  # an installed tree can be moved

# A user gets the headers of the public interface, and each compiles by itself.
headers=$(find "$scratch/usr/include" -name '*.h' | wc -l)
((headers <= 26)) || fail "$headers headers are installed: which of them does a user need?"
find "$scratch/usr/include" -name '*.h' | while read -r header; do
  echo "#include \"$header\"" >"$scratch/alone.cpp"
  c++ -std=c++20 -fsyntax-only -I"$scratch/usr/include" -I"$scratch/usr/include/cordis" -isystem /usr/include/eigen3 \
    "$scratch/alone.cpp" || fail "$header does not compile by itself"
done

cp -r "$outside" "$scratch/project"
cmake -G Ninja -S "$scratch/project" -B "$scratch/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/usr"
cmake --build "$scratch/build"
"$scratch/build/oscillator"

scenes=$scratch/usr/share/cordis/launch_configs/scenes
"$scratch/build/play_scene" "$scenes/plucked_string.yaml" >"$scratch/played"
grep -q '^string: [0-9]* MATs' "$scratch/played" || fail "play_scene printed: $(<"$scratch/played")"
echo 'cordis: 2' >"$scratch/wrong.yaml"
if "$scratch/build/play_scene" "$scratch/wrong.yaml" 2>"$scratch/refused"; then fail "a wrong scene was taken"; fi
grep -q 'wrong.yaml:1:[0-9]*: error: ' "$scratch/refused" || fail "no place was named: $(<"$scratch/refused")"

# The programs find one another, and the page.
export CORDIS_RUNTIME_DIR=$scratch/runtime
"$scratch/usr/bin/cordis" check "$scenes/plucked_string.yaml" >/dev/null
"$scratch/usr/bin/cordis" run "$scratch/usr/share/cordis/launch_configs/plucked_string.yaml" clock=lockstep --duration 1s \
  >"$scratch/run" 2>&1 || fail "the installed session failed: $(<"$scratch/run")"
if [[ -f $build/share/cordis/page/index.html ]]; then
  [[ -f $scratch/usr/share/cordis/page/index.html ]] || fail "the page is not installed"
  if grep -q 'page not built' "$scratch/run"; then fail "viz_node does not find the installed page"; fi
fi
"$scratch/usr/bin/cordis" new launch "$scratch/begun" >/dev/null
schema=$(sed -n '1s/.*schema=//p' "$scratch/begun.yaml")
[[ $schema == */usr/share/cordis/* && -s $schema ]] || fail "no schema for editors is installed: $schema"
[[ -f $scratch/usr/share/cordis/idl/gesture.idl ]] || fail "the messages are not installed"
example=$scratch/usr/share/cordis/examples/foreign_device
[[ -f $example/device.c ]] || fail "the device of another vendor is not installed"
if command -v idlc >/dev/null; then
  cmake -G Ninja -S "$example" -B "$scratch/foreign"
  cmake --build "$scratch/foreign"
  if "$scratch/foreign/foreign_device" 2>/dev/null; then fail "foreign_device wants no words"; fi
fi

if grep -rF -- "$build" "$scratch/usr"/lib/cmake; then
  fail "the installed package points into the build tree"
fi
