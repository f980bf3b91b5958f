#!/usr/bin/env bash
# Makes Debian packages of a build: make.sh BUILD OUT. ./dev package calls it. Each package is an install
# component of its own; here are its control file, its scripts and lintian's findings that stay.
set -euo pipefail
umask 022
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
build=$(cd "$1" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Packages of later commits are newer, and one commit's packages are the same bytes at any time.
commit_time=$(git -C "$source" show -s --format=%ct HEAD 2>/dev/null || stat -c %Y "$source/CHANGELOG.md")
export SOURCE_DATE_EPOCH=$commit_time
release=$(sed -n 's/^project(merlin VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
version="$release+$(date --utc --date="@$commit_time" +%Y%m%d%H%M%S)-1"
maintainer="${DEBFULLNAME:-The MERLIN authors} <${DEBEMAIL:-merlin@localhost.localdomain}>"
architecture=$(dpkg --print-architecture)

# What of the component is a program or a module.
binaries() { # ROOT
  find "$1/usr/bin" "$1/usr/lib" -type f \( -perm -u+x -o -name '*.so' \) 2>/dev/null || true
}

# The packages of the libraries that these files were linked with.
libraries() { # ROOT
  mkdir -p "$work/debian"
  printf 'Source: merlin\n\nPackage: merlin\nArchitecture: any\n' >"$work/debian/control"
  binaries "$1" | (cd "$work" && xargs -d '\n' dpkg-shlibdeps -O 2>"$work/shlibdeps.log") |
    sed 's/^shlibs:Depends=//' || { cat "$work/shlibdeps.log" >&2; exit 1; }
}

# Every licence that what is in the packages has, from the files that state it.
copyright() { # PACKAGE
  echo "MERLIN: display wall daemon. The source of this package is MERLIN's repository."
  if [ "$1" = merlin-rfb ]; then
    printf '\n%s\n' "The program merlin-rfb links LibVNCServer and is therefore distributed under the GNU General Public License, version 2 or later
(/usr/share/common-licenses/GPL-2). Its source is under this licence:" | fold -s -w 100
  fi
  printf '\n'
  cat "$source/LICENSE"
  [ "$1" = merlin ] || return 0
  printf '\nThe font in merlind:\n\n'
  cat "$source/render/text/font/DejaVuSans.LICENSE"
  printf '\nThe model /usr/share/merlin/ankylosaurus.mrm was made of a scan from pyntcloud:\n\n'
  cat "$source/config/models/ankylosaurus.LICENSE"
  printf '\nThe calibration of the glove that merlind has by default:\n\n'
  fold -s -w 100 "$source/drivers/cyberglove/CALIBRATION-LICENSE.txt"
}

documents() { # PACKAGE ROOT
  local doc="$2/usr/share/doc/$1"
  mkdir -p "$doc"
  rm -f "$doc/LICENSE" "$doc/DejaVuSans.LICENSE" "$2/usr/share/merlin/ankylosaurus.LICENSE" "$doc/CHANGELOG.md"
  copyright "$1" >"$doc/copyright"
  gzip -9nc "$source/CHANGELOG.md" >"$doc/changelog.gz"
  printf 'merlin (%s) unstable; urgency=medium\n\n  * What changed is in changelog.gz, beside this file.\n\n -- %s  %s\n' \
    "$version" "$maintainer" "$(date --utc --rfc-email --date="@$commit_time")" | gzip -9nc >"$doc/changelog.Debian.gz"
  if [ -e "$here/$1.lintian" ]; then
    install -D -m 644 "$here/$1.lintian" "$2/usr/share/lintian/overrides/$1"
  fi
}

control() { # PACKAGE ROOT
  local control="$2/DEBIAN"
  mkdir "$control"
  (cd "$2" && find etc -type f 2>/dev/null | sed 's|^|/|' | sort) >"$control/conffiles" || true
  [ -s "$control/conffiles" ] || rm "$control/conffiles"
  (cd "$2" && find usr -type f -print0 | sort -z | xargs -0 md5sum) >"$control/md5sums"
  local script
  for script in preinst postinst prerm postrm; do
    [ ! -e "$here/$1.$script" ] || install -m 755 "$here/$1.$script" "$control/$script"
  done
  sed -e "s|@VERSION@|$version|; s|@MAINTAINER@|$maintainer|; s|@ARCHITECTURE@|$architecture|" \
    -e "s|@LIBRARIES@|$(libraries "$2")|" \
    -e "s|@SIZE@|$(du -k -s --exclude=DEBIAN "$2" | cut -f1)|" "$here/$1.control" >"$control/control"
}

package() { # PACKAGE
  local root="$work/$1"
  DESTDIR="$root" cmake --install "$build" --prefix /usr --component "$1" --strip >/dev/null
  if [ ! -d "$root" ]; then
    echo "make.sh: $1 is left out: $build was configured without it"
    return
  fi
  documents "$1" "$root"
  control "$1" "$root"
  find "$root" -newermt "@$commit_time" -print0 | xargs -0 touch --no-dereference --date="@$commit_time"
  dpkg-deb --root-owner-group -Zxz --build "$root" "$out" >/dev/null
}

rm -f "$out"/merlin*.deb
for control_file in "$here"/*.control; do package "$(basename "$control_file" .control)"; done
(cd "$out" && du -k --apparent-size -- merlin*.deb | awk '{printf "%8d kB  %s\n", $1, $2}')
