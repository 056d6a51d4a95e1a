#!/bin/bash
# Every source has a header of its own name, but main.cpp, the variants of a kernel by vector width, and scene_file.cpp, whose header is
# installed.  usage: own_header_test.sh SOURCE_FOLDER
set -euo pipefail

cd "$1"
mapfile -t files < <(find sim_node device_node viz_node record_node node cli -name node_modules -prune -o -name '*.cpp' -print | sort)
((${#files[@]} > 100)) || { echo "only ${#files[@]} files found in $1"; exit 1; }
bad=0
for file in "${files[@]}"; do
  header=${file%.cpp}.h
  [[ $file == */main.cpp ]] && continue
  [[ $file == *_kernel_@(sse2|avx2|avx512).cpp ]] && header=${file%_*}.h
  [[ $file == sim_node/scene_file.cpp ]] && header=include/cordis/scene_file.h
  if [[ ! -e $header ]]; then
    echo "$file has no $header"
    bad=1
  fi
done
((bad == 0)) && echo "${#files[@]} files"
