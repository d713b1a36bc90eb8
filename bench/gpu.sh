#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the Vulkan backend on a machine with a GPU and little else.
#
# usage: bench/gpu.sh prepare DIR [--texture-size N]
#          where everything can be built: fills DIR with what the other machine lacks: a scene (Sponza, where
#          ../shared/scenes has it, else the atrium), what the CPU backend finds of it, shaders as SPIR-V, and
#          libraries that are headers alone. N: longest side of textures, 128 unless told.
#        bench/gpu.sh run DIR [OPTION...]
#          where there is a C++ compiler, CMake, a Vulkan driver, DIR and this repository: builds without the CPU backend,
#          checks against what it found and prints one table. Options go to lambent_gpu_bench.
# LAMBENT_BENCH_SCENE, a path or a built-in name, is the scene in place of these; LAMBENT_BUILD a build folder where
# lambent and lambent_gpu_bench lie already; LAMBENT_CMAKE_OPTIONS go to CMake.
set -euo pipefail

usage() {
  sed -n 's/^# \{0,1\}//; 5,13p' "$0" >&2
  exit 2
}
(($# >= 2)) || usage
command=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
shift 2
cd "$(dirname "${BASH_SOURCE[0]}")/.."

read -r -a cmake_options <<<"${LAMBENT_CMAKE_OPTIONS:-}"

# copy_headers NAME...: each from where the compiler looks for it, or from Eigen's own folder
copy_headers() {
  local name place
  for name in "$@"; do
    for place in /usr/local/include /usr/include /usr/include/eigen3 ''; do
      [[ -d $place/$name ]] && break
    done
    if [[ -z $place ]]; then
      echo "bench/gpu.sh: no folder $name among the compiler's headers" >&2
      exit 1
    fi
    rm -rf "$folder/headers/$name"
    cp -rL "$place/$name" "$folder/headers/$name"
  done
}

prepare() {
  local texture_size=128 scene light=()
  if (($#)); then
    [[ $1 == --texture-size && $# == 2 ]] || usage
    texture_size=$2
  fi
  local build=${LAMBENT_BUILD:-build/gpu_prepare}
  if [[ ! -v LAMBENT_BUILD ]]; then
    cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DLAMBENT_BUILD_BENCHES=ON -DLAMBENT_BUILD_TESTS=OFF \
      "${cmake_options[@]}" >/dev/null
    cmake --build "$build" --parallel "$(nproc)" --target lambent_cli lambent_gpu_bench
  fi

  scene=${LAMBENT_BENCH_SCENE:-atrium}
  if [[ ! -v LAMBENT_BENCH_SCENE && -f ../shared/scenes/Sponza/Sponza.gltf ]]; then
    scene=../shared/scenes/Sponza/Sponza.gltf
    light=(--eye=-10.2,1.7,4.0 --target=-9.0,1.4,-3 --fov 70
      --sun=-0.62,-0.8,0.10 --sun-irradiance 20,18,15 --sky 1.5,2,2.6)
  fi
  "$build/lambent" prepare "$scene" "${light[@]}" --texture-size "$texture_size" -o "$folder/scene"
  "$build/lambent_gpu_bench" "$folder/scene" --save "$folder/expected"

  mkdir -p "$folder/headers" "$folder/spirv"
  copy_headers glm tl Eigen vulkan vk_video
  rm -f "$folder"/headers/vulkan/*.hpp # most of that folder, and not used
  cp "$build"/spirv/*.inc "$folder/spirv/"
  du -sh "$folder"
}

run() {
  local build=$folder/build
  cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DLAMBENT_CPU=OFF -DLAMBENT_BUILD_BENCHES=ON \
    -DLAMBENT_HEADERS_DIR="$folder/headers" -DLAMBENT_SPIRV_DIR="$folder/spirv" "${cmake_options[@]}" >/dev/null
  cmake --build "$build" --parallel "$(nproc)" --target lambent_gpu_bench
  "$build/lambent_gpu_bench" "$folder/scene" --check "$folder/expected" "$@"
}

case $command in
  prepare | run) "$command" "$@" ;;
  *) usage ;;
esac
