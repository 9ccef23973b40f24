#!/usr/bin/env bash
# Installs the packages that Fathom needs and that are missing, on Debian 12, Debian 13 or
# Ubuntu 24.04; with nothing missing it does nothing. The other scripts call it.
#
#     scripts/setup.sh                  # what the build needs, its tests and benchmarks included
#     scripts/setup.sh import python    # and what these groups need:
#     scripts/setup.sh --list adapters  # says what that is on this system, and installs nothing
#
#     import    bags of ROS, maps on Earth    adapters  other people's solvers that the system packs
#     python    the Python module             docs      the site of docs/ and the reference
#     lint      scripts/lint.sh               cluster   a SLURM, for the test of docs/cluster.md
#     cross     a compiler for aarch64, for the test of portability
set -euo pipefail

fail() {
  printf 'setup: error: %s\n' "$1" >&2
  exit 1
}

system=$(. /etc/os-release 2> /dev/null && printf '%s %s' "${ID:-}" "${VERSION_ID:-}") || system=unknown

# libopencv-dev and not OpenCV's smaller packages: it alone holds OpenCVConfig.cmake, which refuses
# to load unless every module is there.
base=(
  build-essential cmake ninja-build git
  libeigen3-dev libopencv-dev libceres-dev libsuitesparse-dev libgoogle-glog-dev
  libboost-dev libopenblas-dev libopenblas0-pthread
  libyaml-cpp-dev libsqlitecpp-dev libsqlite3-dev libcli11-dev libfmt-dev nlohmann-json3-dev
  libcairo2-dev libexif-dev libscotch-dev pkg-config libjs-vega
  libgtest-dev libgmock-dev libbenchmark-dev python3 man-db
)
# Ubuntu's chromium is no package: the tests that open a page are skipped there.
[[ $system == ubuntu* ]] || base+=(chromium)
# The first four read bags; the libraries of messages and gdal-bin are for the tests alone: they
# write bags and read maps independently of Fathom.
import=(
  librosbag-storage-dev libfastcdr-dev liblz4-dev libzstd-dev libgeotiff-dev libproj-dev
  libsensor-msgs-dev libnav-msgs-dev libgeometry-msgs-dev libstd-msgs-dev gdal-bin
)
python=(pybind11-dev python3-dev python3-numpy python3-pandas python3-scipy)
case "$system" in
  'debian 12') adapters=(libmrpt-graphslam-dev) ;;
  ubuntu*) adapters=(libgtsam-dev libg2o-dev) ;;
  *) adapters=(libmrpt-graphslam-dev libgtsam-dev libg2o-dev) ;;
esac
# clang needs an omp.h of its own to read what g++ compiles with -fopenmp.
lint=(clang clang-tidy clang-format libomp-dev python3-clang python3-autopep8 flake8)
docs=(mkdocs mkdocs-material libjs-katex doxygen)
cluster=(slurm-wlm munge)
cross=(g++-aarch64-linux-gnu)

packages=("${base[@]}")
is_list=
for group in "$@"; do
  case "$group" in
    --list) is_list=yes ;;
    base) ;;
    import | python | adapters | lint | docs | cluster | cross)
      declare -n chosen=$group
      packages+=("${chosen[@]}")
      ;;
    *) fail "unknown group '$group'; there are import, python, adapters, docs, lint, cluster, cross" ;;
  esac
done

if [[ -n $is_list ]]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

# Those of which the package manager does not say that they are installed whole.
missing() {
  if ! command -v dpkg-query > /dev/null; then
    printf '%s\n' "${packages[@]}"
    return
  fi
  local installed
  # dpkg-query fails where it does not know a package: that one is missing, which is no error here.
  installed=$(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' \
    "${packages[@]}" 2> /dev/null | sed -n 's/^installed //p') || true
  comm -23 <(printf '%s\n' "${packages[@]}" | sort -u) <(sort -u <<< "$installed")
}

mapfile -t wanted < <(missing)
[[ ${#wanted[@]} -gt 0 ]] || exit 0

command -v apt-get > /dev/null ||
  fail "no apt-get here to install with; on a system that is not Debian install the like of: ${wanted[*]}"
# What an interrupted installation left stops every further one.
broken=$(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' |
  sed -n -E 's/^(half-installed|unpacked|half-configured|triggers-[a-z]+) //p')
[[ -z $broken ]] ||
  fail "installed by half: ${broken//$'\n'/ }; as root: dpkg --configure -a && apt-get install --fix-broken"
as_root=()
if [[ $(id -u) -ne 0 ]]; then
  command -v sudo > /dev/null ||
    fail "neither root nor sudo here; as root: apt-get install --no-install-recommends ${wanted[*]}"
  as_root=(sudo)
fi
apt_get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y)

printf 'setup: installing %s\n' "${wanted[*]}"
"${apt_get[@]}" update || fail "apt-get update failed; is there a network?"
"${apt_get[@]}" install --no-install-recommends "${wanted[@]}" ||
  fail "apt-get could not install: ${wanted[*]} (its own words are above; Debian 12 and 13 have them all)"
