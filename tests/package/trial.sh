#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# trial.sh [SUITE [DEB]]: installs, uses and purges the package on a bare Debian of that suite (bookworm, trixie). Without DEB it is made
# before on another such system by `./run package`, from what is committed. ../shared/tools/fresh-machine, beside the repository, makes
# the systems (CAPLET_FRESH_MACHINE names another). It needs root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export SUITE=${1:-bookworm}
deb=${2:-}
tool=${CAPLET_FRESH_MACHINE:-../shared/tools/fresh-machine}
[ -x "$tool" ] || { echo "package-trial: there is no $tool, which makes bare systems" >&2; exit 2; }
[ "$(id -u)" = 0 ] || { echo "package-trial: needs root" >&2; exit 2; }

if [ -z "$deb" ]; then
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  # stdout is the package itself.
  "$tool" bash -euc './run package >&2; cat build/packages/*.deb' </dev/null >"$folder/caplet.deb"
  deb=$folder/caplet.deb
fi
exec "$tool" bash tests/package/inside.sh <"$deb"
