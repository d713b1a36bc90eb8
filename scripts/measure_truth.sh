#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the reference against images of an independent path tracer.
#
# usage: scripts/measure_truth.sh SHARED_DIR [BUILD_DIR] [SAMPLES]
#   SHARED_DIR  holds scenes/ and truth/, as the tests expect them beside the repository
#   BUILD_DIR   holds the program (default: build/release)
#   SAMPLES     paths a pixel (default: 256)
# Prints, for every set and layer, the ratio of means and the error of 8x8 block means; writes heat maps beside
# the images it renders, under BUILD_DIR/truth.
set -euo pipefail

shared=${1:?usage: scripts/measure_truth.sh SHARED_DIR [BUILD_DIR] [SAMPLES]}
build=${2:-build/release}
samples=${3:-256}
out=$build/truth
pi=3.14159265358979
mkdir -p "$out"

# render SET SCENE SIZE OPTIONS...
render() {
  local set=$1 scene=$2 size=$3
  shift 3
  echo "== $set"
  "$build/lambent" render "$shared/scenes/$scene" -o "$out/$set.exr" --method reference --layers \
    --size "$size" --samples "$samples" "$@"
}

# compare SET OUR_LAYER PASS SCALE: ours, scaled, with a pass of the truth
compare() {
  local set=$1 layer=$2 pass=$3 scale=$4
  local noise=()
  if [[ -f $shared/truth/$set/$set.${pass}_se.exr ]]; then
    noise=(--noise "$shared/truth/$set/$set.${pass}_se.exr")
  fi
  "$build/lambent" compare "$out/$set.exr" "$shared/truth/$set/$set.$pass.exr" --layer "$layer=" \
    --scale "$scale" --block 8 "${noise[@]}" --heatmap "$out/$set.$pass.png"
}

sponza=(--eye=-10.2,1.7,4.0 --target=-9.0,1.4,-3 --fov 70 --sun=-0.62,-0.8,0.10 --sun-irradiance 20,18,15
        --sky 1.5,2,2.6)

render cornell cornell_box/cornell_box.glb 256x256 --camera cornell --materials lambert
render cornell_1bounce cornell_box/cornell_box.glb 256x256 --camera cornell --materials lambert --bounces 1
render two_rooms_B two_rooms/two_rooms.glb 320x180 --camera roomB --materials lambert
render sponza Sponza/Sponza.gltf 320x180 "${sponza[@]}" --materials lambert --no-normal-maps
render sponza_gltf Sponza/Sponza.gltf 320x180 "${sponza[@]}"

for set in cornell cornell_1bounce two_rooms_B; do
  echo "== $set: picture, albedo, indirect irradiance over pi"
  compare "$set" "" Combined 1
  compare "$set" albedo DiffCol 1
  compare "$set" irradiance DiffInd "$(awk "BEGIN { print 1 / $pi }")"
done
for set in sponza sponza_gltf; do
  echo "== $set: picture, albedo"
  compare "$set" "" Combined 1
  compare "$set" albedo DiffCol 1
done

# The layers that are products of the truth's passes
if [[ -x $build/tests/golden_tests ]]; then
  LAMBENT_TRUTH_SAMPLES=$samples "$build/tests/golden_tests" --gtest_filter='TruthReference.*'
fi
