#!/bin/bash
# Every source begins with its path: `// path -- what it is`, a .cpp file `// path` at least. The line has at most 100 columns. The firmware is C
# in a style of its own.  usage: header_test.sh SOURCE_FOLDER
set -euo pipefail

cd "$1"
mapfile -t files < <(find sim_node device_node viz_node record_node node cli idl include tests \( -name node_modules -o -name firmware \) -prune -o \
  \( -name '*.cpp' -o -name '*.h' -o -name '*.ts' -o -name '*.mjs' -o -name '*.idl' \) -print 2>/dev/null | sort)
((${#files[@]} > 100)) || { echo "only ${#files[@]} files found in $1"; exit 1; }
bad=0
for file in "${files[@]}"; do
  IFS= read -r line < "$file" || true
  case $line in
    "// $file -- "?*) ;;
    "// $file") [[ $file == *.cpp ]] || line='' ;;
    *) line='' ;;
  esac
  if [[ -z $line ]] || ((${#line} > 100)); then
    echo "$file:1: the first line must be \`// $file -- what it is\`, at most 100 columns"
    bad=1
  fi
done
((bad == 0)) && echo "${#files[@]} files"
