// SPDX-License-Identifier: Apache-2.0
#include "core/cross_bilateral.h"

#include "core/lanes.h"
#include "core/simd.h"
#include "shared/cross_bilateral.h"

namespace lambent {
namespace {

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

/// cross_bilateral_weight, for lanes.
LAMBENT_FORCE_INLINE void lane_weights(Lanes& weight, const GuideLanes& here,
                                       const GuideLanes& there, const Lanes& inverse_tolerance) {
  const Lanes cosine = here.nx * there.nx + here.ny * there.ny + here.nz * there.nz;
  const Lanes square = cosine * cosine;
  const Lanes fourth = square * square;
  const Lanes distance =
      here.nx * (here.x - there.x) + here.ny * (here.y - there.y) + here.nz * (here.z - there.z);
  const Lanes beyond = distance * inverse_tolerance;
  const Lanes near = 1.0f - beyond * beyond;
  weight = fourth * fourth * near;
  keep(weight, (cosine > 0.0f) & (near > 0.0f));
}

LAMBENT_SIMD_CLONES void blur_row(const BlurSource& centre, const BlurSource* neighbours,
                                  std::size_t neighbour_count, const Planes3& out, int count,
                                  float inverse_tolerance) {
  for (int i = 0; i < count; i += kLanes) {
    GuideLanes here, there;
    Lanes tolerance, r, g, b;
    load_guide(here, centre.guide, i);
    load(tolerance, centre.guide.inverse_depth + i);
    tolerance *= inverse_tolerance;
    load(r, centre.value.at[0] + i);
    load(g, centre.value.at[1] + i);
    load(b, centre.value.at[2] + i);

    // Add the neighbours
    Lanes sum = Lanes{} + 1.0f;
    for (std::size_t k = 0; k < neighbour_count; ++k) {
      const BlurSource& source = neighbours[k];
      Lanes weight, value;
      load_guide(there, source.guide, i);
      lane_weights(weight, here, there, tolerance);
      weight *= source.weight;
      sum += weight;
      load(value, source.value.at[0] + i);
      r += weight * value;
      load(value, source.value.at[1] + i);
      g += weight * value;
      load(value, source.value.at[2] + i);
      b += weight * value;
    }
    const Lanes scale = 1.0f / sum;
    store(out.at[0] + i, r * scale);
    store(out.at[1] + i, g * scale);
    store(out.at[2] + i, b * scale);
  }
}

}  // namespace

PlaneLayout::PlaneLayout(int picture_width, int picture_height, int guard_width)
    : width(picture_width), height(picture_height), guard(guard_width) {
  // A guard between rows serves the end of one and the start of the next
  stride = (width + guard + kLanes - 1) / kLanes * kLanes;
  size = row(height + guard) + kLanes;
}

std::vector<BlurTap> box_taps(int radius) {
  std::vector<BlurTap> taps;
  for (int i = 1; i <= radius; ++i) taps.push_back({i, 1.0f});
  return taps;
}

std::vector<BlurTap> period_taps(int period) {
  // Of an even period the outermost two share a place
  std::vector<BlurTap> taps = box_taps(period / 2);
  if (period % 2 == 0) taps.back().weight = 0.5f;
  return taps;
}

void cross_bilateral_row(const BlurSource& here, std::span<const BlurSource> neighbours,
                         const Planes3& out, int count, float plane_tolerance) {
  blur_row(here, neighbours.data(), neighbours.size(), out, count, 1.0f / plane_tolerance);
}

}  // namespace lambent
