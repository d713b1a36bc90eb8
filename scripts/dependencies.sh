# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Sourced by the other scripts: installs what Lambent is built from, where it is missing.

# Debian package names (Debian 12 and newer, Ubuntu 24.04 and newer).
lambent_packages=(
  # Tools
  g++ cmake ninja-build ccache git glslc
  # Ray tracing, threads, lanes, mathematics
  libembree-dev libtbb-dev libhwy-dev libglm-dev libeigen3-dev
  # Images and scenes
  libopenexr-dev libpng-dev libjpeg-dev zlib1g-dev libstb-dev libwebp-dev libtinygltf-dev libdraco-dev
  libmeshoptimizer-dev
  nlohmann-json3-dev
  # The server: TLS, H.264; Boost is below
  libssl-dev libopenh264-dev
  # Program and errors
  libcli11-dev libexpected-dev
  # Bakes on several machines
  libopenmpi-dev openmpi-bin
  # Vulkan's headers; its loader is found at run time
  libvulkan-dev
  # Tests and benches
  libgtest-dev libgmock-dev libbenchmark-dev
)

# What LAMBENT_STREAM_H265 and LAMBENT_STREAM_FFMPEG need, which are off by default: the GPL comes with them.
# shellcheck disable=SC2034
lambent_gpl_packages=(pkg-config libx265-dev libavcodec-dev libavutil-dev)

# What LAMBENT_STREAM_NATS needs, which is off by default, and what its tests run.
# shellcheck disable=SC2034
lambent_broker_packages=(pkg-config libnats-dev nats-server)

# The server's HTTP and WebSocket. Debian 12 has a newer Boost beside the one that it calls libboost-dev.
if grep -qs '^VERSION_CODENAME=bookworm' /etc/os-release; then
  lambent_packages+=(libboost1.81-dev)
else
  lambent_packages+=(libboost-dev)
fi

# Prints the packages of the list that are not installed.
lambent_missing_packages() {
  local package
  for package in "${lambent_packages[@]}"; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null |
      grep -qx installed || echo "$package"
  done
}

# Installs the missing packages, naming them first. Returns 1 with a message where it cannot.
lambent_install_dependencies() {
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    {
      echo "lambent: this script installs packages with apt-get, which is not here."
      echo "lambent: install the equivalents of these by other means, then see README.md:"
      printf '  %s\n' "${lambent_packages[@]}"
    } >&2
    # Somebody may have done so already: go on where the tools are there, and let CMake judge the rest.
    command -v cmake >/dev/null && command -v ninja >/dev/null
    return
  fi

  local missing
  mapfile -t missing < <(lambent_missing_packages)
  if ((${#missing[@]} == 0)); then
    return 0
  fi
  echo "lambent: installing ${missing[*]}" >&2

  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      echo "lambent: these packages are missing, and neither root nor sudo is here to install them:" >&2
      echo "lambent:   apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q ||
    ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -q -y --no-install-recommends "${missing[@]}"; then
    echo "lambent: apt-get could not install: ${missing[*]}" >&2
    return 1
  fi
}

# Debian 12's own drivers cannot trace rays; its backports' can.
lambent_vulkan_driver_version=25

# The version of Mesa's Vulkan drivers that is installed ("Installed") or could be ("Candidate"): its first number.
lambent_mesa_version() {
  LC_ALL=C apt-cache policy mesa-vulkan-drivers 2>/dev/null | sed -n "s/^ *$1: \([0-9]*\).*/\1/p"
}

# Installs a Vulkan driver that runs on any processor, and the validation layer, so that tests of the Vulkan backend
# need no GPU. Where that cannot be done, says so and returns 1: those tests are skipped then.
lambent_install_vulkan_driver() {
  command -v apt-get >/dev/null || return 1
  local as_root=() installed from=()
  ((EUID == 0)) || as_root=(sudo)
  installed=$(lambent_mesa_version Installed)
  if ((${installed:-0} >= lambent_vulkan_driver_version)); then return 0; fi
  if (($(lambent_mesa_version Candidate || echo 0) + 0 < lambent_vulkan_driver_version)) &&
    grep -q '^VERSION_CODENAME=bookworm' /etc/os-release; then
    echo "lambent: taking mesa-vulkan-drivers from bookworm-backports" >&2
    echo 'deb http://deb.debian.org/debian bookworm-backports main' |
      "${as_root[@]}" tee /etc/apt/sources.list.d/lambent-backports.list >/dev/null
    from=(-t bookworm-backports)
  fi
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q ||
    ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -q -y --no-install-recommends "${from[@]}" mesa-vulkan-drivers; then
    echo "lambent: no Vulkan driver could be installed: tests of the Vulkan backend are skipped" >&2
    return 1
  fi
}
