#!/usr/bin/env bash
# The two commands on a bare Debian: a minimal system of SUITE in a folder, and a clone of HEAD in it.
# As root; takes what the two take on a fresh machine.
#
#     scripts/bare.sh bookworm               # a new system: quickstart.sh, what it says installs the
#                                            # features that it lacks, then test.sh
#     scripts/bare.sh trixie COMMAND …       # a command in the clone, in the system of an earlier run
#
# The systems lie in /var/tmp/fathom-bare, or in FATHOM_BARE. The folder shared/ beside this checkout
# is seen from within, as the tests look for their data there.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

fail() {
  printf 'bare: error: %s\n' "$1" >&2
  exit 1
}

suite=${1:?which suite? bookworm or trixie}
shift
root=${FATHOM_BARE:-/var/tmp/fathom-bare}/$suite
[[ $(id -u) -eq 0 ]] || fail "needs root, for chroot"

if [[ $# -eq 0 ]]; then
  command -v debootstrap > /dev/null || fail "no debootstrap here; apt-get install debootstrap"
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
  debootstrap --variant=minbase "$suite" "$root" > "$root.log" 2>&1 ||
    fail "debootstrap failed: $root.log"
  git clone --quiet . "$root/fathom/main"
  # The commands as a newcomer types them; in between, what the program says of what it lacks.
  set -- bash -euc '
    scripts/quickstart.sh
    build/release/fathom list features
    build/release/fathom list features | grep -o "scripts/build.sh .*" | sort -u |
      while read -r command; do $command --target fathom; done
    build/release/fathom list features
    scripts/test.sh'
fi
[[ -d $root/fathom/main ]] || fail "there is no $root; begin with: scripts/bare.sh $suite"
cp /etc/resolv.conf "$root/etc/resolv.conf"
mkdir -p "$root/fathom/shared"

# In namespaces of its own, so that nothing stays mounted or running.
export root
export shared=$PWD/../shared
exec unshare --mount --pid --fork --kill-child bash -euc '
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
  mount -t proc proc "$root/proc"
  if [[ -d $shared ]]; then mount --bind "$shared" "$root/fathom/shared"; fi
  exec chroot "$root" env --ignore-environment --chdir=/fathom/main HOME=/root LANG=C.UTF-8 \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    ${OPENBLAS_CORETYPE:+OPENBLAS_CORETYPE=$OPENBLAS_CORETYPE} "$@"' bash "$@"
