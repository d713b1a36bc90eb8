// SPDX-License-Identifier: Apache-2.0
// cross_bilateral_row for one instruction set: see core/simd_levels.h.
#include "core/lanes.inl.h"

/// What a pixel's lanes are compared with.
struct GuideLanes {
  Lanes x, y, z, nx, ny, nz;
};

LAMBENT_FORCE_INLINE void load_guide(GuideLanes& lanes, const GuidePlanes& guide, int i) {
  load(lanes.x, guide.position.at[0] + i);
  load(lanes.y, guide.position.at[1] + i);
  load(lanes.z, guide.position.at[2] + i);
  load(lanes.nx, guide.normal.at[0] + i);
  load(lanes.ny, guide.normal.at[1] + i);
  load(lanes.nz, guide.normal.at[2] + i);
}

/// relit_bilateral_weight, for lanes.
LAMBENT_FORCE_INLINE void lane_weights(Lanes& weight, const GuideLanes& here,
                                       const GuideLanes& there, const Lanes& inverse_tolerance) {
  const Lanes cosine = here.nx * there.nx + here.ny * there.ny + here.nz * there.nz;
  const Lanes square = cosine * cosine;
  const Lanes fourth = square * square;
  const Lanes distance =
      here.nx * (here.x - there.x) + here.ny * (here.y - there.y) + here.nz * (here.z - there.z);
  const Lanes beyond = distance * inverse_tolerance;
  const Lanes near = 1.0f - beyond * beyond;
  const Lanes sixteenth = (fourth * fourth) * (fourth * fourth);
  weight = sixteenth * near;
  keep(weight, (cosine > 0.0f) & (near > 0.0f));
}

static void blur_row(const BlurSource& centre, const BlurSource* neighbours,
                     std::size_t neighbour_count, const LightPlanes& out, int count,
                     float inverse_tolerance) {
  for (int i = 0; i < count; i += kLanes) {
    GuideLanes here, there;
    Lanes tolerance, sums[kLightPlanes];
    load_guide(here, centre.guide, i);
    load(tolerance, centre.guide.inverse_depth + i);
    tolerance *= inverse_tolerance;
    for (int c = 0; c < kLightPlanes; ++c) load(sums[c], centre.value.at[c] + i);

    // Add the neighbours
    Lanes sum = Lanes{} + 1.0f;
    for (std::size_t k = 0; k < neighbour_count; ++k) {
      const BlurSource& source = neighbours[k];
      Lanes weight, value;
      load_guide(there, source.guide, i);
      lane_weights(weight, here, there, tolerance);
      weight *= source.weight;
      sum += weight;
      for (int c = 0; c < kLightPlanes; ++c) {
        load(value, source.value.at[c] + i);
        sums[c] += weight * value;
      }
    }
    const Lanes scale = 1.0f / sum;
    for (int c = 0; c < kLightPlanes; ++c) store(out.at[c] + i, sums[c] * scale);
  }
}
