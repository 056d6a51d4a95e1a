#!/bin/bash
# The installed engine is found, compiled against and run by a project outside of this tree.
# usage: install_test.sh BUILD_FOLDER SCRATCH_FOLDER
set -euo pipefail

build=$1
scratch=$2
outside=$(dirname -- "$(readlink -f -- "$0")")/outside

rm -rf -- "$scratch"
mkdir -p "$scratch"
cmake --install "$build" --prefix "$scratch/first"
mv "$scratch/first" "$scratch/usr"  # an installed tree can be moved
cp -r "$outside" "$scratch/project"
cmake -G Ninja -S "$scratch/project" -B "$scratch/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/usr"
cmake --build "$scratch/build"
"$scratch/build/oscillator"
if grep -rF -- "$build" "$scratch/usr"/lib/cmake; then
  echo "the installed package points into the build tree"
  exit 1
fi
