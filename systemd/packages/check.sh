#!/usr/bin/env bash
# Judges the packages in a folder without installing anything on this machine: check.sh PACKAGES WORK.
# ./dev test-package calls it. dpkg installs, removes and purges them below WORK, as in README.md, "What is tested".
set -euo pipefail
packages=$(cd "$1" && pwd)
rm -rf "$2"
mkdir -p "$2"
work=$(cd "$2" && pwd)
root="$work/root"
instance="package-$$"
daemon=
trap '[ -z "$daemon" ] || { kill "$daemon" 2>/dev/null || true; wait "$daemon" || true; }' EXIT

fail() { echo "test-package: $*" >&2; exit 1; }

# dpkg on a root of its own. What the packages depend on is not there, so only this machine's libraries serve.
dpkg_below() {
  dpkg --root="$root" --force-script-chrootless --force-depends --force-not-root --force-confold \
    --log="$work/dpkg.log" "$@" >"$work/dpkg.out" 2>&1 || { cat "$work/dpkg.out" >&2; fail "dpkg $* failed"; }
}

# Files below the root that no package manager or user database owns.
left() { (cd "$root" && find . -mindepth 1 ! -path './var/lib/dpkg*' ! -name 'passwd*' ! -name 'group*' \
  ! -name '*shadow*' ! -name '.pwd.lock' ! -type d -print | sort); }

check_contents() {
  local package="$packages"/merlin_*.deb line
  dpkg-deb --contents $package >"$work/contents"
  for line in '-rwxr-xr-x root/root .* ./usr/bin/merlind$' '-rw-r--r-- root/root .* ./etc/merlin/merlin.json$' \
    '-rw-r--r-- root/root .* ./usr/share/merlin/ankylosaurus.mrm$' '-rw-r--r-- root/root .* ./usr/share/man/man8/merlind.8.gz$'; do
    grep -q -e "^$line" "$work/contents" || fail "no line $line in the contents of $package"
  done
  for package in "$packages"/merlin*.deb; do
    dpkg-deb --contents "$package" >"$work/contents"
    ! grep -v ' root/root ' "$work/contents" || fail "$package has files that do not belong to root"
    ! grep -e '^.....w' -e '^........w' "$work/contents" | grep -v '^l' ||
      fail "$package has files that others may write"
    dpkg-deb --control "$package" "$work/control"
    for line in preinst postinst prerm postrm; do
      [ ! -e "$work/control/$line" ] || sh -n "$work/control/$line"
    done
    (dpkg-deb --fsys-tarfile "$package" | tar -t | sed -n 's|^\.\(/etc/.*[^/]\)$|\1|p' | sort) >"$work/etc"
    diff "$work/etc" <(cat "$work/control/conffiles" 2>/dev/null || true) || fail "$package: files in /etc that are no conffiles"
    rm -r "$work/control"
  done
}

check_documents() {
  local page
  for page in man1/merlin.1 man8/merlind.8 man5/merlin.json.5; do
    if command -v groff >/dev/null; then
      [ -z "$(zcat "$root/usr/share/man/$page.gz" | groff -man -Tutf8 -ww -z 2>&1)" ] || fail "groff has warnings on $page"
    fi
    [ "$(zcat "$root/usr/share/man/$page.gz" | wc -l)" -gt 40 ] || fail "$page is too short"
  done
  local offered
  offered=$(bash -c "source '$root/usr/share/bash-completion/completions/merlin'; COMP_WORDS=(merlin mesh red) COMP_CWORD=2; _merlin; echo \${COMPREPLY[@]}")
  [ "$offered" = reduce ] || fail "completion offers \"$offered\" for \"merlin mesh red\", not reduce"
}

# The installed daemon with the installed configuration, whose model is below the root here, too.
check_wall() {
  "$root/usr/bin/merlin" --version >/dev/null
  sed -e "s|/usr/share|$root/usr/share|; s|{|{\"instance\": \"$instance\", \"run_directory\": \"$work/run\", \"state_file\": \"$work/state.json\",|" \
    -e 's|"connector": "\*"|"card": "/dev/dri/none", "connector": "*"|; s|"after_s": [0-9.]*|"after_s": 0.2|' \
    "$root/etc/merlin/merlin.json" | sed -e '2,$s|{"instance[^,]*, "run_directory[^,]*, "state_file[^,]*,|{|g' >"$root/etc/merlin/check.json"
  mkdir -p "$work/run"
  "$root/usr/bin/merlind" --check-config "$root/etc/merlin/check.json" >/dev/null || fail "the installed configuration is not valid"
  "$root/usr/bin/merlind" --config "$root/etc/merlin/check.json" 2>"$work/merlind.log" &
  daemon=$!
  local try
  for try in $(seq 200); do
    grep -q ready "$work/merlind.log" && break
    sleep 0.1
  done
  "$root/usr/bin/merlin" watch --instance "$instance" --for 2 >/dev/null
  "$root/usr/bin/merlin" status --instance "$instance" --json >"$work/status.json"
  "$root/usr/bin/merlin" snapshot --instance "$instance" -o "$work/frame.png"
  kill "$daemon"
  wait "$daemon" || fail "merlind ended with status $?"
  daemon=
  grep -q '"playlist": *"running"' "$work/status.json" || fail "the playlist does not run"
  ! grep -E ' (warning|error): ' "$work/merlind.log" || fail "merlind raised an alarm"
  rm "$root/etc/merlin/check.json"
}

check_contents
mkdir -p "$root"/var/lib/dpkg/{info,updates} "$root"/etc "$root"/run
touch "$root/var/lib/dpkg/status" "$root/var/lib/dpkg/available"
left >"$work/before"
dpkg_below --install "$packages"/merlin*.deb
grep -q '^merlin:' "$root/etc/passwd" && grep -q '^merlin-page:' "$root/etc/passwd" &&
  grep -q '^merlin-alarms:' "$root/etc/passwd" || fail "the users were not made"
[ "$(stat -c %U:%a "$root/var/lib/merlin")" != root:755 ] || fail "/var/lib/merlin does not belong to the user merlin"
[ ! -e "$root/etc/systemd/system" ] || fail "installation enabled a unit"
check_documents
check_wall
echo '{"instance": "mine"}' >"$root/etc/merlin/merlin.json"
echo kept >"$root/var/lib/merlin/model.mrm"
dpkg_below --install "$packages"/merlin*.deb  # the same again, as an upgrade does
grep -q mine "$root/etc/merlin/merlin.json" || fail "an upgrade replaced the configuration"
mapfile -t names < <(for package in "$packages"/merlin*.deb; do dpkg-deb --field "$package" Package; done)
dpkg_below --remove "${names[@]}"
[ -e "$root/var/lib/merlin/model.mrm" ] && grep -q mine "$root/etc/merlin/merlin.json" ||
  fail "removal took configuration or state"
[ ! -e "$root/usr/bin/merlind" ] || fail "removal left the program"
dpkg_below --purge "${names[@]}"
diff "$work/before" <(left) || fail "purge left these files"
[ ! -e "$root/var/lib/merlin" ] && [ ! -e "$root/etc/merlin" ] || fail "purge left a folder"
echo "test-package: ${#names[@]} packages are installed, run, replaced, removed and purged below $work"
