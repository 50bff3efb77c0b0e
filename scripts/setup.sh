#!/bin/sh
# Installs the Debian packages that Sinew needs, if any are missing.
#   scripts/setup.sh [NEED...]      packages for the named needs, or for all of them
#   scripts/setup.sh --minimal      packages for the library, the program and the Python package: build wheel
#   scripts/setup.sh --list [...]   prints the packages, one a line, and installs nothing
# NEED is one or more of: build demo render sweep wheel test validate bench docs format lint fuzz.
# Run it as root or with sudo. With SINEW_SKIP_SETUP=1 it changes nothing.
set -eu

needs_known="build demo render sweep wheel test validate bench docs format lint fuzz"

# The packages that each need adds to those of the needs that it includes (packages_for).
build="build-essential cmake ninja-build
  libeigen3-dev libmetis-dev libsuitesparse-dev libtbb-dev libhdf5-dev libyaml-cpp-dev
  libpugixml-dev libassimp-dev libqhull-dev liburdfdom-dev libcli11-dev libfmt-dev nlohmann-json3-dev zlib1g-dev
  libceres-dev coinor-libipopt-dev libboost-dev
  python3 python3-dev python3-numpy pybind11-dev"
# Node.js bundles the page of the view. Any installed version is used: one that is not from Debian
# brings its own npm, which conflicts with Debian's.
command -v node >/dev/null || build="$build nodejs"
command -v npm >/dev/null || build="$build npm"
demo="python3-matplotlib"
render="python3-moderngl python3-pil python3-yaml python3-h5py libegl1 libgl1-mesa-dri fonts-dejavu-core"
sweep="python3-distributed python3-pandas python3-h5py python3-scipy python3-matplotlib"
wheel="python3-pip python3-venv python3-setuptools python3-wheel"
test="libgtest-dev libgmock-dev gmsh chromium ffmpeg python3-pytest python3-scipy python3-meshio
  python3-h5py python3-distributed python3-pandas python3-yaml python3-cvxopt python3-jsonschema
  zsh fish"
validate="calculix-ccx gmsh python3-scipy python3-meshio"
bench="libbenchmark-dev chromium"
docs="doxygen python3-sphinx python3-myst-parser furo"
format="git clang-format"
lint="clang clang-tidy doxygen"
fuzz="clang libclang-rt-dev"

packages_for() {
  case $1 in
    build)    echo $build ;;
    demo)     echo $build $demo $render ;;
    render)   echo $build $render ;;
    sweep)    echo $build $sweep ;;
    wheel)    echo $build $wheel ;;
    test)     echo $build $demo $render $test ;;
    validate) echo $build $demo $validate ;;
    bench)    echo $build $demo $validate $bench ;;
    docs)     echo $build $render $sweep $docs ;;
    format)   echo $format ;;
    lint)     echo $build $render $test $bench $format $lint ;;
    fuzz)     echo $build $fuzz ;;
    *) echo "setup: unknown need '$1'; known are: $needs_known" >&2; return 2 ;;
  esac
}

needs=""
list_only=no
for argument in "$@"; do
  case $argument in
    --minimal) needs="$needs build wheel" ;;
    --list) list_only=yes ;;
    -h|--help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "setup: unknown option '$argument'; see scripts/setup.sh --help" >&2; exit 2 ;;
    *) needs="$needs $argument" ;;
  esac
done
packages=""
for need in ${needs:-$needs_known}; do
  own=$(packages_for "$need")
  packages="$packages $own"
done
packages=$(printf '%s\n' $packages | awk '!seen[$0]++')

if [ "$list_only" = yes ]; then
  printf '%s\n' $packages
  exit 0
fi
if [ "${SINEW_SKIP_SETUP:-0}" = 1 ]; then
  echo "setup: skipped (SINEW_SKIP_SETUP=1)"
  exit 0
fi
if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "setup: this is not a Debian system, so nothing is installed. Sinew needs what these Debian"
  echo "setup: 12 packages hold; the build names what it does not find:"
  printf '%s\n' $packages | sed 's/^/  /'
  exit 0
fi

installed=$(dpkg-query -W -f='${binary:Package} ${db:Status-Status}\n' $packages 2>/dev/null |
            sed -n 's/^\([^ :]*\)[^ ]* installed$/\1/p' || true)
missing=""
for package in $packages; do
  printf '%s\n' "$installed" | grep -qx "$package" || missing="$missing $package"
done
if [ -z "$missing" ]; then
  echo "setup: all $(printf '%s\n' $packages | wc -l) packages are installed (for:${needs:- everything})"
  exit 0
fi

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: these packages are missing, and there is neither root nor sudo to install them:" >&2
    echo "  apt-get install$missing" >&2
    echo "setup: SINEW_SKIP_SETUP=1 goes on without them" >&2
    exit 1
  fi
  as_root="sudo"
fi

# apt-get's output is shown only when it fails.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  if ! $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -y \
      -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 "$@" >"$log" 2>&1; then
    cat "$log" >&2
    echo "setup: 'apt-get $*' failed; its output is above" >&2
    exit 1
  fi
}
echo "setup: installing$missing"
apt update
apt install --no-install-recommends $missing
echo "setup: done"
