#!/usr/bin/env bash
# Installs the Debian packages of packages.txt that are missing, as root or through sudo. Does nothing when none is.
set -euo pipefail
cd "$(dirname "$0")/.."

stop() {
  echo "install.sh: $*" >&2
  exit 1
}

command -v apt-get >/dev/null || stop "this is no Debian system: install what scripts/packages.txt lists by hand"

missing=()
while read -r package; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) || true
  [[ $status == installed ]] || missing+=("$package")
done < <(grep -v -e '^#' -e '^$' scripts/packages.txt)
((${#missing[@]})) || exit 0

as_root=(env DEBIAN_FRONTEND=noninteractive)
if ((EUID != 0)); then
  command -v sudo >/dev/null || stop "no root and no sudo; as root: apt-get install ${missing[*]}"
  as_root=(sudo "${as_root[@]}")
fi
echo "installing ${missing[*]}"
"${as_root[@]}" apt-get update --quiet
"${as_root[@]}" apt-get install --quiet --yes --no-install-recommends "${missing[@]}"
