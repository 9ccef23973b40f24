#!/usr/bin/env bash
# Makes the Debian packages in build/package/packages (docs/packages.md). What they have beyond the
# program follows what is installed, and the groups that are named:
#
#     scripts/package.sh import python adapters
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

# No group may write into a folder that is packed.
umask 022
# Packages that were made from other sources are none of this build.
rm -rf build/package/packages
scripts/build.sh --preset package "$@"
cpack --preset package
rm -rf build/package/packages/_CPack_Packages
# A program that looks for code in a folder of who built it would run what somebody else puts there.
for package in build/package/packages/*.deb; do
  if [[ $(dpkg-deb --fsys-tarfile "$package" | grep --count --fixed-strings "$PWD/") != 0 ]]; then
    printf 'package: error: %s names %s\n' "$package" "$PWD" >&2
    exit 1
  fi
done
printf '\n'
ls -l build/package/packages/*.deb
