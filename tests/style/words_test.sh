#!/bin/bash
# No source, document or test uses a word of retired_words.txt, whose lines name the word in its place.  usage: words_test.sh SOURCE_FOLDER
set -euo pipefail

cd "$1"
list=tests/style/retired_words.txt
mapfile -t files < <(find sim_node device_node viz_node record_node node cli idl include examples deploy cmake cordis tests docs launch_configs README.md CONTRIBUTING.md \
  \( -name node_modules -o -path tests/style -o -path tests/reference -o -path docs/glossary.md \) -prune -o \
  \( -name '*.cpp' -o -name '*.h' -o -name '*.c' -o -name '*.ts' -o -name '*.mjs' -o -name '*.html' -o -name '*.idl' -o -name '*.md' -o -name '*.yaml' \
  -o -name '*.sh' -o -name '*.py' -o -name '*.cmake' -o -path cordis -o -name CMakeLists.txt \) -print 2>/dev/null | sort)
((${#files[@]} > 100)) || { echo "only ${#files[@]} files found in $1"; exit 1; }
count=0
bad=0
while IFS= read -r line; do
  [[ $line != '#'* ]] || continue
  pattern=${line% |*}
  pattern=${pattern%"${pattern##*[! ]}"}
  count=$((count + 1))
  status=0
  found=$(grep -nP -- "$pattern" "${files[@]}") || status=$?
  if ((status == 0)); then
    echo "$found" | sed "s/\$/   <- now:${line##* |}/"
    bad=1
  elif ((status > 1)); then
    echo "no pattern: $line"
    bad=1
  fi
done < "$list"
((count > 30)) || { echo "only $count patterns in $list"; exit 1; }
((bad == 0)) && echo "$count patterns, ${#files[@]} files"
