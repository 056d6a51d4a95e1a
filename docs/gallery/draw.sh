#!/bin/bash
# Draws the figures of docs/gallery.md.  usage: docs/gallery/draw.sh [CORDIS [FOLDER]]
# CORDIS is the program, ./cordis unless given; FOLDER is where the figures go, docs/gallery unless given.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
cordis=${1:-$root/cordis}
folder=${2:-$root/docs/gallery}

draw() {  # SCENE OPTIONS...: its chronogram
  "$cordis" chronogram "$root/launch_configs/$1.yaml" "${@:2}" --layout grid --width 900 -o "$folder/$1.svg"
}

# The chronograms of the paper, in their order.
draw stacks_shattering --from 1.1s --frames 8 --every 120ms
draw regrouping --from 200ms --frames 8 --every 750ms
draw elementary_solid --frames 8 --every 100ms
draw material_skin --frames 8 --every 400ms

# Its photographs 2 to 6.
draw bodies_meeting --frames 6 --every 700ms
draw collage_and_rupture --frames 6 --every 300ms
draw all_types_together --from 600ms --frames 6 --every 300ms
draw stirred_box --from 1s --frames 4 --every 1200ms

# What README opens with.
draw plasticine --from 200ms --frames 8 --every 250ms
