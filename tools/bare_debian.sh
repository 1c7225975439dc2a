#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# bare_debian.sh SUITE: README's first command and `verify`, from a clone of what is committed, on a system of that suite that has nothing
# else. ../shared/tools/fresh-machine, beside the repository, makes the system (CAPLET_FRESH_MACHINE names another). Where it cannot, this
# says so and is content; a system on which a command then fails is an error.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export SUITE=$1
tool=${CAPLET_FRESH_MACHINE:-../shared/tools/fresh-machine}

skip() {
  printf '\n%s\n' "**** SKIPPED: Debian $SUITE was NOT tried: $* ****" >&2
  exit 0
}

[ -x "$tool" ] || skip "there is no $tool"
[ "$(id -u)" = 0 ] || skip "that needs root"
git rev-parse --verify -q HEAD >/dev/null || skip "this is no git repository with a commit"
if ! said=$("$tool" apt-get update -qq -o APT::Update::Error-Mode=any 2>&1 </dev/null); then
  skip "a bare system with its package lists is not to be had: $(tail -n 3 <<<"$said")"
fi

first=$(sed -n '/^```$/,/^```$/ { /^\.\/run /p }' README.md | head -n 1)
case $first in
  "./run render "*" --preview "*) ;;
  *) echo "README.md does not begin with ./run render ... --preview ..." >&2; exit 1 ;;
esac
start=$SECONDS
"$tool" bash -euxc "$first; ls -l *.exr *.png; ./run verify --rays 100000" </dev/null
echo "bare Debian $SUITE: README's first command and verify pass ($((SECONDS - start)) s)" >&2
