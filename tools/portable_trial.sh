#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# portable_trial.sh [SUITE...]: installs the portable wheel of build/wheels in bare systems (Debian's bookworm and trixie and Ubuntu's noble,
# or those named) as a user without root, where nothing but python3 and venv were added, and uses it there (portable_trial_inside.sh).
# debootstrap makes the systems, in build/bare (CAPLET_BARE names another folder, with one folder a suite). Needs root. Where
# Ubuntu's archive cannot be reached noble is left out, with a line that says so. Prints the seconds of each step; a
# machine that does other work beside it may be given more of them from the wheel to a picture (CAPLET_TRIAL_SECONDS, 60).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bare=${CAPLET_BARE:-$root/build/bare}
[ "$(id -u)" = 0 ] || { echo "portable_trial.sh: needs root, for chroot" >&2; exit 2; }
wheel=$(ls -t "$root"/build/wheels/caplet-*manylinux*.whl 2>/dev/null | head -n 1)
[ -n "$wheel" ] || { echo "portable_trial.sh: there is no wheel in build/wheels (./run wheel --portable)" >&2; exit 2; }

mounted=()
clean() {
  for folder in "${mounted[@]}"; do umount -l "$folder"; done
  [ -z "${system:-}" ] || rm -rf --one-file-system "$system"
}
trap clean EXIT

# Debian does not have the keys of Ubuntu's archive: they come from that archive, in a package whose hash is known here.
ubuntu=http://archive.ubuntu.com/ubuntu
keyring_package=pool/main/u/ubuntu-keyring/ubuntu-keyring_2023.11.28.1_all.deb
keyring_sha256=36de43b15853ccae0028e9a767613770c704833f82586f28eb262f0311adb8a8
keyring=$bare/ubuntu-keyring/usr/share/keyrings/ubuntu-archive-keyring.gpg
fetch_keyring() {
  [ ! -e "$keyring" ] || return 0
  mkdir -p "$bare"
  python3 -c 'import sys, urllib.request; sys.stdout.buffer.write(urllib.request.urlopen(sys.argv[1], timeout=30).read())' \
    "$ubuntu/$keyring_package" >"$bare/ubuntu-keyring.deb" 2>/dev/null || return 1
  sha256sum --check --quiet <<<"$keyring_sha256  $bare/ubuntu-keyring.deb" && dpkg-deb -x "$bare/ubuntu-keyring.deb" "$bare/ubuntu-keyring"
}
make_bare() {
  local mirror script=() options=(--variant=minbase)
  command -v debootstrap >/dev/null || apt-get install -y -qq --no-install-recommends debootstrap >/dev/null
  mkdir -p "$bare"
  rm -rf --one-file-system "$bare/$1.part"
  if [ "$1" = noble ]; then
    fetch_keyring
    mirror=$ubuntu
    script=(gutsy)  # that of all of Ubuntu's systems: Debian 12's debootstrap is older than noble
    options+=(--components=main,universe --keyring="$keyring")
  else
    mirror=$(awk '$1=="URIs:"{print $2; exit} $1=="deb"{for(i=2;i<=NF;i++) if($i ~ /:\/\//){print $i; exit}}' /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list 2>/dev/null)
  fi
  debootstrap "${options[@]}" "$1" "$bare/$1.part" "$mirror" "${script[@]}" >"$bare/$1.log" 2>&1 || { tail -n 5 "$bare/$1.log" >&2; exit 1; }
  mv "$bare/$1.part" "$bare/$1"
}

if [ -x "$root/build/release/bin/caplet" ]; then
  echo "--- pictures of the wheel and of build/release, on the wheel's driver"
  "$root/tools/portable_equal.py" "$wheel" "$root/build/release/bin/caplet"
fi

suites=("$@")
if [ ${#suites[@]} = 0 ]; then
  suites=(bookworm trixie)
  if [ -d "$bare/noble" ] || fetch_keyring; then
    suites+=(noble)
  else
    echo "**** SKIPPED: Ubuntu 24.04 is NOT tried: there is no $bare/noble, nor the keyring of its archive to make it by ****" >&2
  fi
fi
python=$root/build/portable-env/bin/python
# What the wheel depends on, for the Python of that system, is fetched here: the bare system lacks the certificates for it.
fetch() { # fetch VERSION FOLDER
  local platforms=() version
  for version in manylinux_2_28 manylinux_2_27 manylinux_2_17 manylinux2014; do platforms+=(--platform "${version}_x86_64"); done
  "$python" -m pip download -q --only-binary=:all: --implementation cp --python-version "$1" "${platforms[@]}" -d "$2" numpy nanobind-backend
}

for suite in "${suites[@]}"; do
  [ -d "$bare/$suite" ] || make_bare "$suite"
  system=$(mktemp -d "$bare/trial.XXXXXX")
  chmod 755 "$system"
  cp -a "$bare/$suite/." "$system/"
  cp -L /etc/resolv.conf /etc/hosts "$system/etc/" 2>/dev/null || true
  cp -a /etc/apt/apt.conf.d/99* "$system/etc/apt/apt.conf.d/" 2>/dev/null || true
  mount -t proc proc "$system/proc"; mounted+=("$system/proc")
  mount --rbind /sys "$system/sys"; mount --make-rslave "$system/sys"; mounted+=("$system/sys")
  mount --rbind /dev "$system/dev"; mount --make-rslave "$system/dev"; mounted+=("$system/dev")
  inside() { env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive /usr/sbin/chroot "$system" "$@"; }
  inside apt-get update -qq
  inside apt-get install -y -qq --no-install-recommends python3 python3-venv >/dev/null 2>&1
  inside useradd -m -s /bin/bash user
  mkdir "$system/home/user/given"
  cp "$wheel" "$root/scenes/neuron.swc" "$root/scenes/capsules.pbrt" "$root/tools/portable_trial_inside.sh" "$system/home/user/given/"
  fetch "$(inside python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')" "$system/home/user/given"
  echo "--- $suite: as a user, $(basename "$wheel")"
  env -i HOME=/home/user USER=user PATH=/usr/bin:/bin LANG=C.UTF-8 /usr/sbin/chroot --userspec=user "$system" \
    bash /home/user/given/portable_trial_inside.sh alone "${CAPLET_TRIAL_SECONDS:-60}"
  inside apt-get install -y -qq --no-install-recommends pocl-opencl-icd >/dev/null 2>&1
  echo "--- $suite: beside an installed PoCL"
  env -i HOME=/home/user USER=user PATH=/usr/bin:/bin LANG=C.UTF-8 /usr/sbin/chroot --userspec=user "$system" \
    bash /home/user/given/portable_trial_inside.sh beside
  for folder in "${mounted[@]}"; do umount -l "$folder"; done
  mounted=()
  rm -rf --one-file-system "$system"
  echo "--- $suite: all passed"
done
