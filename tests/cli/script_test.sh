#!/bin/bash
# tests/cli/script_test.sh SOURCE_DIRECTORY -- runs ./cordis with every tool that it calls replaced by this file, which
# notes the call in $PLACE/calls and does as little as it can. Files in $PLACE say what is the matter: offline,
# broken, cmake-changed.
set -euo pipefail

note() { printf '%s\n' "$*" >>"$PLACE/calls"; }

fake_apt_get() {
  note "apt-get $*"
  [[ ! -e $PLACE/offline ]] || exit 100
  [[ $1 == install ]] || return 0
  for word in "$@"; do printf '%s\n' "$word" >>"$PLACE/installed"; done
  [[ " $* " != *" npm "* ]] || ln -sf "$PLACE/fake" "$PLACE/tools/npm"
}

fake_ninja() {  # -C TREE, then -n or -j N, then targets
  local tree=$2 targets=${*:5}
  [[ $3 != -n ]] || targets=${*:4}
  local built="$tree/built ${targets//\//-}"
  if [[ $3 == -n ]]; then
    [[ ! -e $PLACE/cmake-changed ]] || printf '[0/1] Re-running CMake...\n'
    [[ ! -e $built ]] || printf 'ninja: no work to do.\n'
    return
  fi
  note "ninja ${tree##*/}: $targets"
  printf '[1/2, 0s] Building a part\n'
  [[ ! -e $PLACE/broken ]] || { printf 'error: broken code\n'; exit 1; }
  mkdir -p "$tree/bin"
  ln -sf "$PLACE/fake" "$tree/bin/cordis"
  printf x >"$built"
}

fake_ctest() {  # ... --output-log LOG: one test passes, one is skipped and one fails
  local log=${*: -1}
  {
    printf '    Start 1: good\n1/3 Test #1: good ....   Passed    0.01 sec\n'
    printf '    Start 2: left\n2/3 Test #2: left ....***Skipped   0.01 sec\nwords of left\n'
    printf '    Start 3: bad\n3/3 Test #3: bad ....***Failed   0.01 sec\na_test.cpp:3: Failure\nwords of bad\n'
    printf '\n66%% tests passed, 1 tests failed out of 3\n'
  } >"$log"
}

fake_cmake() {  # --fresh -S SOURCE --preset PRESET
  note "cmake $5"
  [[ $1 == --fresh ]] || exit 1  # without it the real one refuses a cache of another folder, and forgets options with another compiler
  mkdir -p "$3/build/$5"
  printf '%s\n' "$3" >"$3/build/$5/CMakeCache.txt"
}

case ${0##*/} in
  apt-get) fake_apt_get "$@"; exit ;;
  cmake) fake_cmake "$@"; exit ;;
  cordis) printf 'program:'; printf ' [%s]' "$@"; printf '\n'; [[ $1 != test ]] || fake_ctest "$@"; [[ $* == *until-pass* ]] || exit 7; exit 0 ;;
  dpkg-query) while read -r package; do printf '=installed=%s=' "$package"; done <"$PLACE/installed"; exit ;;
  ninja) fake_ninja "$@"; exit ;;
  npm) note "npm $1"; [[ ! -e $PLACE/offline ]] || exit 1; mkdir -p "$3/node_modules"; printf x >"$3/node_modules/.package-lock.json"; exit ;;
  sudo) while [[ $1 == -n || $1 == *=* ]]; do shift; done; exec "$@" ;;
esac

PLACE=$(mktemp -d "${TMPDIR:-/tmp}/cordis script test XXXXXX")
export PLACE
trap 'rm -rf "$PLACE"' EXIT
tree="$PLACE/a tree"
mkdir -p "$tree"/{cmake,idl,include,node,sim_node,device_node,viz_node/web,record_node,cli} "$PLACE/tools"
cp "$1/cordis" "$1/packages.txt" "$tree"
touch "$tree"/CMakeLists.txt "$tree/node/a.cpp"
touch -d '1 hour ago' "$tree/CMakePresets.json" "$tree/viz_node/web/package-lock.json"
touch "$PLACE/installed" "$PLACE/calls"
cp "$0" "$PLACE/fake"
chmod +x "$PLACE/fake"
for name in apt-get cmake dpkg-query ninja sudo; do ln -s "$PLACE/fake" "$PLACE/tools/$name"; done
for name in awk bash cksum dirname env find flock ln mkdir mv nproc readlink rm sleep tail; do
  ln -s "$(type -P "$name")" "$PLACE/tools/$name"
done

# call WORD...: ./cordis from another folder; its output, exit code and calls of tools go to $output, $code and $calls.
call() {
  : >"$PLACE/calls"
  code=0
  output=$(cd / && PATH=$PLACE/tools "$tree/cordis" "$@" 2>&1 </dev/null) || code=$?
  calls=$(<"$PLACE/calls")
}

# start_and_wait_for_words: ./cordis run in the background as $waiting, until the first words are in $PLACE/output.
start_and_wait_for_words() {
  : >"$PLACE/output"
  PATH=$PLACE/tools "$tree/cordis" run >"$PLACE/output" 2>&1 </dev/null {held}>&- &
  waiting=$!
  until [[ -s $PLACE/output ]]; do sleep 0.05; done
}

failures=0
# expect WHAT ACTUAL PATTERN
expect() {
  # shellcheck disable=SC2053  # a pattern on purpose
  [[ $2 == $3 ]] && return
  printf 'FAILED: %s\n--- expected\n%s\n--- got\n%s\n' "$1" "$3" "$2"
  failures=$((failures + 1))
}

touch "$PLACE/offline"
call run 'a b'
expect 'without network it builds all the same' "$output" "cordis: installing Debian packages: g++ *
cordis: these packages could not be installed (build/packages-build.log); going on without: g++ *
cordis: installing Debian packages: *
cordis: these packages could not be installed (build/packages-page.log); going on without: * npm *
cordis: there will be no page: npm is missing
cordis: configuring (release)
cordis: building (release)*
program: \[run\] \[a b\]"
expect 'the exit code is that of the program' "$code" 7

call run
expect 'what failed a moment ago is not tried again' "$calls" ""

rm "$PLACE/offline"
rm "$tree"/build/.failed-*
call run
expect 'with network it installs, fetches the page and configures again' "$output" "cordis: installing Debian packages: g++ *
cordis: installing Debian packages: *npm*
cordis: fetching the packages of the page with npm
cordis: configuring (release)
program: \[run\]"
expect 'asks nothing' "$calls" "apt-get update
apt-get install -y * g++ *"

call run
expect 'a second call says nothing' "$output" 'program: \[run\]'
expect 'a second call touches nothing' "$calls" ''

touch "$PLACE/cmake-changed"
call run
expect 'a change in a CMakeLists.txt is not overlooked' "$calls" 'ninja release: all'
rm "$PLACE/cmake-changed"

touch "$tree/viz_node/web/package-lock.json" -d 'next hour'
touch "$PLACE/offline"
call run
expect 'a page that cannot be fetched is no reason to stop' "$output" "cordis: fetching the packages of the page with npm
cordis: there will be no page: npm ci failed (build/npm.log)
program: \[run\]"
rm "$PLACE/offline"
touch "$tree/viz_node/web/package-lock.json" -d '1 hour ago'

call test -R 'a b'
expect 'test builds the tests and the sanitized ones, and hands its words on' "$output" "cordis: installing Debian packages: *chromium*
cordis: configuring (release)
cordis: building (release)*
cordis: configuring (asan)
cordis: building (asan)*
cordis: configuring (tsan)
cordis: building (tsan)*
program: \[test\] \[-R\] \[a b\] \[--output-log\] \[*/build/tests.log\]
cordis: once more, what the tests that failed have printed (all: build/tests.log)
3/3 Test #3: bad ....\*\*\*Failed   0.01 sec
a_test.cpp:3: Failure
words of bad

their failed assertions:
3/3 Test #3: bad ....\*\*\*Failed   0.01 sec
a_test.cpp:3: Failure
words of bad

cordis: building and testing took 0 min * s"
expect 'tests are built only for test' "$calls" "*
ninja release: tests/all
*
ninja asan: tests/all
*
ninja tsan: tests/all"
expect 'one CTest covers all' "$(<"$tree/build/CTestTestfile.cmake")" 'subdirs(release asan tsan)'
expect 'the exit code is that of the tests' "$code" 7

call test --repeat until-pass:2
expect 'a test that passed when it ran again is named' "$output" "program: *
3/3 Test #3: bad *
*
cordis: each of them passed when it ran a second time
cordis: building and testing took 0 min * s"
expect 'and is no failure' "$code" 0

exec {held}>"$tree/build/.lock"
flock "$held"  # as another ./cordis does that builds
call run 'a b'
expect 'a program that is current starts at once while another ./cordis builds' "$output" 'program: \[run\] \[a b\]'
expect 'and asks no tool' "$calls" ''

mv "$tree/build/release/bin/cordis" "$PLACE/being linked"
(sleep 0.3; mv "$PLACE/being linked" "$tree/build/release/bin/cordis") {held}>&- &
call ctl pause
expect 'ctl waits a moment for a program that is just being linked' "$output" 'program: \[ctl\] \[pause\]'
wait

touch "$tree/node/a.cpp"
call ctl pause
expect 'ctl never waits: what it talks to runs already' "$output" 'program: \[ctl\] \[pause\]'
expect 'nor does it build' "$calls" ''

start_and_wait_for_words
expect 'a program that is older than a source waits for who builds' "$(<"$PLACE/output")" \
  'cordis: waiting for another ./cordis that builds'
rm "$tree"/build/release/built*
flock --unlock "$held"
wait "$waiting" || true
expect 'and is built then' "$(<"$PLACE/output")" "cordis: waiting for another ./cordis that builds
cordis: building (release)*
program: \[run\]"
call ctl pause
expect 'a source that changes while no build runs does not keep ctl either' "$output" 'program: \[ctl\] \[pause\]'
call run
flock "$held"
call run
expect 'what was built is current from then on' "$output" 'program: \[run\]'
touch "$tree/node/b.cpp"
start_and_wait_for_words
expect 'a new source is noticed' "$(<"$PLACE/output")" 'cordis: waiting for another ./cordis that builds'
exec {held}>&-
wait "$waiting" || true

if type -P script >/dev/null; then
  rm "$tree"/build/release/built*
  printf -v line '%q ' env "PATH=$PLACE/tools" "$tree/cordis" run
  output=$(script -qec "$line" /dev/null </dev/null | tr -d '\r') || true
  expect 'on a terminal a build shows the newest line of ninja' "$output" "cordis: building (release)
\[1/2, 0s\] Building a part*program: \[run\]"
  expect 'and keeps all of them' "$(<"$tree/build/build-release.log")" '\[1/2, 0s\] Building a part'
  rm "$tree"/build/release/built*
  touch "$PLACE/broken"
  output=$(script -qec "$line" /dev/null </dev/null | tr -d '\r') || true
  expect 'and its errors' "$output" "*
error: broken code
cordis: failed; the whole output is in build/build-release.log"
  rm "$PLACE/broken"
  call run
fi

mv "$tree" "$PLACE/moved tree"
tree="$PLACE/moved tree"
call run
expect 'a tree that was moved is configured again' "$output" "cordis: configuring (release)
program: \[run\]"

rm "$tree"/build/release/built*
touch "$PLACE/broken"
call run
expect 'a failed build shows its errors' "$output" "cordis: building (release)*
error: broken code
cordis: failed; the whole output is in build/build-release.log"
expect 'and ends with 1' "$code" 1

((failures == 0)) && printf 'all well\n'
exit $((failures > 0))
