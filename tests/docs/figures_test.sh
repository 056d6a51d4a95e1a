#!/bin/bash
# The figures of docs/gallery.md are what docs/gallery/draw.sh draws.  usage: figures_test.sh SOURCE_FOLDER CORDIS
set -euo pipefail

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
"$1/docs/gallery/draw.sh" "$2" "$place" >"$place/log" 2>&1 || { cat "$place/log"; exit 1; }
count=0
for figure in "$1"/docs/gallery/*.svg; do
  cmp "$figure" "$place/$(basename "$figure")" || { echo "draw it again: docs/gallery/draw.sh"; exit 1; }
  count=$((count + 1))
done
((count >= 8)) || { echo "only $count figures"; exit 1; }
echo "$count figures"
