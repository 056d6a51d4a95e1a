#!/bin/bash
# What deploy/ promises: systemd accepts the unit, and the container has the libraries that the programs need.
# usage: deploy_test.sh SOURCE_FOLDER PROGRAM_FOLDER
set -uo pipefail

deploy=$1/deploy
programs=$2
failures=0
fail() {
  printf 'FAILED: %s\n' "$*"
  failures=$((failures + 1))
}

scratch=$(mktemp -d)
trap 'rm -rf -- "$scratch"' EXIT

# The unit. Its program is installed elsewhere: that of this build stands for it.
unit=$scratch/cordis@.service
sed "s|/usr/local/bin/cordis |$programs/cordis |" "$deploy/cordis@.service" >"$unit"
grep -q "^ExecStart=$programs/cordis run " "$unit" || fail 'the unit does not start cordis run'
for wanted in LimitRTPRIO=90 LimitMEMLOCK=infinity KillMode=mixed Restart=on-failure; do
  grep -qx "$wanted" "$unit" || fail "the unit lacks $wanted"
done
if type -P systemd-analyze >/dev/null; then
  complaints=$(systemd-analyze verify "$unit" 2>&1) || fail "systemd-analyze ends with $?"
  [[ -z $complaints ]] || fail "systemd says: $complaints"
else
  printf 'not checked by systemd, which is absent\n'
fi

# The commands of the README exist.
for file in cordis@.service sysctl.conf; do
  grep -q "deploy/$file " "$deploy/README.md" || fail "README.md does not install $file"
done

# The registry of the service is the service's own: another user, root too, is refused.
line=$(grep 'cordis list' "$deploy/README.md")
[[ $line == 'sudo -u cordis env CORDIS_RUNTIME_DIR=/run/cordis cordis list' ]] || fail "README.md says: $line"
grep -qx 'User=cordis' "$unit" || fail 'the unit does not run as cordis'
if ((EUID == 0)) && type -P setpriv >/dev/null; then
  chmod 755 "$scratch"
  mkdir -m 700 "$scratch/run" && chown 65534:65534 "$scratch/run"
  setpriv --reuid 65534 --regid 65534 --clear-groups env CORDIS_RUNTIME_DIR="$scratch/run" "$programs/cordis" list >/dev/null ||
    fail 'the user of the service cannot list its sessions'
  CORDIS_RUNTIME_DIR=$scratch/run "$programs/cordis" list >/dev/null 2>&1 && fail 'another user lists the sessions of the service'
fi

# The container: every library that a program names itself comes with a package of the last stage.
stage=$(sed -n '/^FROM .*bookworm-slim/,$p' "$deploy/Containerfile")
if type -P dpkg readelf >/dev/null; then
  for program in cordis sim_node device_node viz_node record_node; do
    for library in $(readelf -d "$programs/$program" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p'); do
      path=$(ldd "$programs/$program" | awk -v name="$library" '$1 == name {print $3}')
      path=$(readlink -f -- "$path")
      # A package that names /lib is found there alone, where /lib is a link to /usr/lib.
      package=$( (dpkg -S "$path" || dpkg -S "${path#/usr}") 2>/dev/null | cut -d: -f1 | head -n 1)
      [[ -n $package ]] || continue  # of no package here
      case $package in libc6 | libstdc++6 | libgcc-s1) continue ;; esac  # of Debian's smallest system
      [[ $stage =~ (^|[[:space:]])$package([[:space:]]|$) ]] || fail "the container lacks $package ($library of $program)"
    done
  done
fi

((failures == 0)) && printf 'all well\n'
exit $((failures > 0))
