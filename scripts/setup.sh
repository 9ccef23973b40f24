#!/usr/bin/env bash
# Installs the Debian 12 packages that Fathom needs and that are missing; with nothing missing it
# does nothing. quickstart.sh, test.sh and lint.sh call it.
#
#     scripts/setup.sh          # what the build needs, its tests and benchmarks included
#     scripts/setup.sh lint     # and what scripts/lint.sh needs
#     scripts/setup.sh docs     # and what scripts/docs.sh needs
#     scripts/setup.sh import   # and what reads bags and writes maps for geographic programs
#     scripts/setup.sh adapters # and the solvers of others that Debian has, for docs/adapters.md
#     scripts/setup.sh python   # and what the Python module is built with
#     scripts/setup.sh cluster  # and a SLURM for the test of docs/cluster.md
set -euo pipefail

# libopencv-dev and not OpenCV's smaller packages: it alone holds OpenCVConfig.cmake, which refuses
# to load unless every module is there.
packages=(
  build-essential cmake ninja-build
  libeigen3-dev libopencv-dev libceres-dev libsuitesparse-dev libgoogle-glog-dev
  libboost-dev libopenblas-dev libopenblas0-pthread
  libyaml-cpp-dev libsqlitecpp-dev libsqlite3-dev libcli11-dev nlohmann-json3-dev
  libcairo2-dev pkg-config libjs-vega
  libgtest-dev libgmock-dev libbenchmark-dev chromium
  clang-format python3
)
# clang needs an omp.h of its own to read what g++ compiles with -fopenmp.
lint_packages=(clang clang-tidy libomp-dev)
docs_packages=(mkdocs mkdocs-material doxygen)
# librosbag-storage-dev and libfastcdr-dev read bags, the libraries of messages and gdal-bin are for
# the tests alone: they write bags and read maps independently of Fathom.
import_packages=(
  librosbag-storage-dev libfastcdr-dev libexif-dev libgeotiff-dev libproj-dev
  libsensor-msgs-dev libnav-msgs-dev libgeometry-msgs-dev libstd-msgs-dev gdal-bin
)
cluster_packages=(slurm-wlm munge)
adapter_packages=(libmrpt-graphslam-dev)
python_packages=(pybind11-dev python3-dev python3-numpy python3-pandas)

fail() {
  printf 'setup: error: %s\n' "$1" >&2
  exit 1
}

case "${1:-}" in
  '') ;;
  lint) packages+=("${lint_packages[@]}") ;;
  docs) packages+=("${docs_packages[@]}") ;;
  import) packages+=("${import_packages[@]}") ;;
  adapters) packages+=("${adapter_packages[@]}") ;;
  python) packages+=("${python_packages[@]}") ;;
  cluster) packages+=("${cluster_packages[@]}") ;;
  *) fail "unknown argument '$1'; use none, lint, docs, import, adapters, python or cluster" ;;
esac

missing() {
  if ! command -v dpkg-query > /dev/null; then
    printf '%s\n' "${packages[@]}"
    return
  fi
  local installed
  # dpkg-query fails where it does not know a package: that one is missing, which is no error here.
  installed=$(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' \
    "${packages[@]}" 2> /dev/null | sed -n 's/^installed //p') || true
  comm -23 <(printf '%s\n' "${packages[@]}" | sort) <(sort -u <<< "$installed")
}

mapfile -t wanted < <(missing)
[[ ${#wanted[@]} -gt 0 ]] || exit 0

command -v apt-get > /dev/null ||
  fail "no apt-get here to install with; on a system that is not Debian install the like of: ${wanted[*]}"
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
  fail "apt-get could not install: ${wanted[*]} (Debian 12 has them all)"
