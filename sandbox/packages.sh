# What Debian 12 must have for building and testing; sourced by sandbox/quickstart.sh and tests/run.sh.

# The engine alone needs these; its tests libgmp-dev too, for exact oracles.
ENGINE_PACKAGES=(g++ cmake ninja-build libeigen3-dev libtbb-dev libmetis-dev catch2)

BUILD_PACKAGES=("${ENGINE_PACKAGES[@]}" pkg-config libosmesa6-dev libglm-dev libstb-dev python3-glad
  libavcodec-dev libavformat-dev libavutil-dev libswscale-dev
  libtomlplusplus-dev nlohmann-json3-dev libcli11-dev libfmt-dev libtinyobjloader-dev libgoogle-perftools-dev)

# EGL is the second way to draw (--gl egl): tests hold both to the same bits. glmark2-data has the bunny.
TEST_PACKAGES=("${BUILD_PACKAGES[@]}" libegl-dev libgl1-mesa-dri ffmpeg gnuplot-nox libgmp-dev mold glmark2-data)

# install_packages WHAT-FOR NAME...: installs those that are missing; says how where it cannot.
install_packages() {
  local purpose=$1
  shift
  local missing=() name
  for name in "$@"; do
    dpkg-query -W -f '${Status}' "$name" 2>/dev/null | grep -q 'install ok installed' || missing+=("$name")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "== installing what the $purpose needs: ${missing[*]}"
  if ! command -v apt-get >/dev/null; then
    echo "there is no apt-get here: install the equivalents of these Debian packages by hand" >&2
    return 2
  fi
  local root=()
  [ "$(id -u)" -eq 0 ] || root=(sudo)
  "${root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}
