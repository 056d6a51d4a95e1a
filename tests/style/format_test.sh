#!/bin/bash
# Every C++ file of ours (the firmware is C for small processors, in a style of its own) stands as clang-format would write it.  usage: format_test.sh SOURCE_FOLDER
set -euo pipefail

cd "$1"
mapfile -t files < <(find sim_node device_node viz_node record_node node cli include examples tests \( -name node_modules -o -name firmware \) -prune -o \
  \( -name '*.cpp' -o -name '*.h' \) -print 2>/dev/null | sort)
((${#files[@]} > 100)) || { echo "only ${#files[@]} files found in $1"; exit 1; }
clang-format --dry-run -Werror "${files[@]}" || { echo "mend it with: clang-format -i FILE"; exit 1; }
# A comment that is too long for its line pushes the value before it to the next one: the table of values is lost.
if grep -Pzo '(?<=\n)[^\n]* =\n +[\w:.{}-]+; +//[^\n]*\n' "${files[@]}" | tr '\0' '\n'; then
  echo "wrap these comments"
  exit 1
fi
echo "${#files[@]} files"
