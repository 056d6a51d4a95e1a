#!/bin/bash
# clang-tidy has nothing to say about the programs and their libraries. What was found clean is looked at again when it was
# compiled again, or when the rules have changed. Tests are left out: that would take as long again.
#
# usage: tidy_test.sh SOURCE_FOLDER BUILD_FOLDER [beginning of a path]
set -euo pipefail

source=$(readlink -f -- "$1")
build=$(readlink -f -- "$2")
beginning=${3-}
clean=$build/clang-tidy
mkdir -p "$clean"

# Prints `source object` for each source that the tree compiles: once each, though two libraries compile the engine.
compiled() {
  local file='' object='' line
  while read -r line; do
    case $line in
      '"file": "'*) file=${line#*\": \"}; file=${file%\"*} ;;
      '"command": "'*) object=${line##* -o }; object=${object%% *} ;;
      '}'*) [[ $file == "$source/$beginning"* && $file != "$build"/* && $file != "$source"/tests/* && $file == *.cpp ]] && echo "${file#"$source"/} $object" ;;
    esac
  done <"$build/compile_commands.json" | sort -u -k1,1
}

check() {  # FILE OBJECT: says what is wrong
  local stamp=$clean/${1//\//,}
  [[ $stamp -nt $build/$2 && $stamp -nt $source/.clang-tidy ]] && return
  # Options of g++ alone stand in the commands that clang-tidy reads.
  if clang-tidy --quiet -p "$build" --extra-arg=-Wno-unknown-warning-option "$source/$1" 2>"$stamp.err"; then
    rm -f "$stamp.err"
    touch "$stamp"
  else
    cat "$stamp.err"
    echo "clang-tidy is not content with $1"
    return 1
  fi
}

export -f check
export source build clean
mapfile -t files < <(compiled)
((${#files[@]} > 0)) || { echo "no source of $source is compiled in $build"; exit 1; }
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -L 1 bash -c 'check "$@"' check
echo "${#files[@]} files"
