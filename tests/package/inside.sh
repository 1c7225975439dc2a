#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# What trial.sh does on the bare system, as root; the package comes by stdin. Each
# thing that is not as promised is told of; exit code 1 where there is one.
set -euo pipefail
work=$(mktemp -d)
cat >"$work/caplet.deb"
version=$(dpkg-deb -f "$work/caplet.deb" Version)
deb=$work/caplet_${version}_$(dpkg --print-architecture).deb
mv "$work/caplet.deb" "$deb"
cd "$work"
say() { echo "package-trial: $*"; }
failures=0
fail() {
  say "FAILED: $*"
  failures=$((failures + 1))
}
# Without what it installs nothing else can be tried.
install() {
  apt-get install -y "$@" >install.log 2>&1 && return
  tail -n 20 install.log
  say "FAILED: apt-get install $*"
  exit 1
}
as_user() { setpriv --reuid 65534 --regid 65534 --clear-groups env HOME="$work/user" "$@"; }
# Without network: in a namespace that has none.
caplet_as_user() { unshare -n setpriv --reuid 65534 --regid 65534 --clear-groups env HOME="$work/user" caplet "$@"; }
export DEBIAN_FRONTEND=noninteractive HOME=$work/home
mkdir -p "$HOME"
mkdir -p "$work/user"
chown 65534:65534 "$work/user"
chmod 755 "$work"

say "$deb ($(stat -c %s "$deb") bytes)"
dpkg-deb -f "$deb"
apt-get update -qq
start=$SECONDS
install "$deb"
say "installed in $((SECONDS - start)) s"
dpkg -L caplet >files.txt

cd "$work/user"
for scene in gallery.pbrt neuron.swc; do
  start=$SECONDS
  rm -f picture.exr picture.jpg
  # The JPEG is OpenImageIO's, of the module.
  caplet_as_user render "/usr/share/caplet/scenes/$scene" -o picture.exr --preview picture.jpg --size 160x90 --spp 4 -q || fail "render"
  [ -s picture.exr ] && [ -s picture.jpg ] || fail "no picture of $scene"
  say "$scene: rendered in $((SECONDS - start)) s, $(stat -c %s picture.exr) bytes of EXR, $(stat -c %s picture.jpg) of JPEG"
done
caplet_as_user verify --rays 10000 -q >verify.txt || fail "verify: $(grep verdict verify.txt)"
cd "$work"

install --no-install-recommends man-db bash-completion
# A page that root reads goes into the cache of man-db.
page=$(as_user MANWIDTH=80 man -P cat caplet)
grep -q -- '--turntable' <<<"$page" || fail "man caplet does not tell of --turntable"
warned=$(LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z /usr/share/man/man1/caplet.1.gz 2>&1 >/dev/null)
[ -z "$warned" ] || fail "man warns: $warned"
say "man caplet: $(wc -l <<<"$page") lines, no warnings"

# As bash does at a TAB: bash-completion loads the file of the command.
completed() {
  bash -c '
    . /usr/share/bash-completion/bash_completion
    if declare -F _comp_load >/dev/null; then _comp_load caplet; else _completion_loader caplet; fi
    function=$(complete -p caplet | sed "s/.*-F \([^ ]*\).*/\1/")
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    $function
    printf "%s\n" "${COMPREPLY[@]}"' bash "$@"
}
[ "$(completed caplet rend)" = render ] || fail "completion of a command"
[ "$(completed caplet render --style st)" = sticks ] || fail "completion of a style"
[ "$(completed caplet render /usr/share/caplet/scenes/neu)" = /usr/share/caplet/scenes/neuron.swc ] || fail "completion of a scene"
grep -qx 0 <<<"$(completed caplet render --device '')" || fail "completion of a device"
say "completion in bash: commands, styles, scenes and devices"

# The library: docs/library.md's program, by the compiler that is installed for it.
install --no-install-recommends g++ cmake make
mkdir example
awk '/^```cmake/ { on = 1; next } /^```/ { if (on) exit } on' /src/project/docs/library.md >example/CMakeLists.txt
awk '/^```cpp/ { on = 1; next } /^```/ { if (on) exit } on' /src/project/docs/library.md >example/main.cpp
if cmake -S example -B example/build >example.log 2>&1 && cmake --build example/build >>example.log 2>&1 &&
  example/build/example /usr/share/caplet/scenes/gallery.pbrt example.exr >>example.log 2>&1 && [ -s example.exr ]; then
  say "the library: docs/library.md's example is built and runs"
else
  tail -n 20 example.log
  fail "the library's example"
fi

install --no-install-recommends lintian
said=$(lintian --allow-root --tag-display-limit 0 "$deb" 2>&1) || true
if [ -z "$said" ]; then
  say "lintian $(lintian --version | sed 's/.* v//') is quiet; answered in overrides: $(grep -cv '^#' /usr/share/lintian/overrides/caplet || true)"
else
  fail "lintian: $said"
fi

before=$failures
apt-get purge -y caplet >purge.log 2>&1 || fail "apt-get purge: $(tail -n 20 purge.log)"
while IFS= read -r file; do
  [ ! -e "$file" ] || [ -d "$file" ] || fail "purge leaves $file"
done <files.txt
left=$(find / -xdev \( -path /src -o -path /proc -o -path /tmp -o -path "$work" \) -prune -o -iname '*caplet*' -print)
[ -z "$left" ] || fail "purge leaves $left"
! dpkg-query -W caplet >/dev/null 2>&1 || fail "dpkg still knows caplet"
[ "$failures" != "$before" ] || say "purge leaves nothing of $(wc -l <files.txt) names"
[ "$failures" = 0 ] || exit 1
say "all is as promised on $(sed -n 's/^PRETTY_NAME=//p' /etc/os-release)"
