// SPDX-License-Identifier: Apache-2.0
// cross_bilateral_row for one instruction set: see core/simd_levels.h.
#include "core/guide_lanes.inl.h"

#define Real Lanes
#define LAMBENT_REAL_FN LAMBENT_FORCE_INLINE
#include "shared/relit_blur.inl.h"
#undef Real
#undef LAMBENT_REAL_FN

/// relit_bilateral_weight, for lanes.
LAMBENT_FORCE_INLINE void lane_weights(Lanes& weight, const GuideLanes& here,
                                       const GuideLanes& there, const Lanes& inverse_tolerance) {
  const Lanes cosine = here.nx * there.nx + here.ny * there.ny + here.nz * there.nz;
  const Lanes distance =
      here.nx * (here.x - there.x) + here.ny * (here.y - there.y) + here.nz * (here.z - there.z);
  weight = relit_weight(cosine, distance * inverse_tolerance);
}

/// Light and its reorientation R, unpacked.
struct BlurLanes {
  Lanes light[kLightPlanes], reorientation[kLightPlanes];
};

LAMBENT_FORCE_INLINE void load_blurred(BlurLanes& lanes, const ConstPlanes& planes, int i) {
  for (int c = 0; c < kLightPlanes; ++c) {
    Lanes word;
    load(word, planes.at(c) + i);
    unpack_halves(lanes.light[c], lanes.reorientation[c], word);
  }
}

/// The weighted means of kLanes pixels, from the `i`-th on, and their neighbours.
LAMBENT_FORCE_INLINE void blur(BlurLanes& sums, const GuideLanes& here, const BlurSource& centre,
                               const BlurSource* neighbours, std::size_t neighbour_count,
                               float inverse_tolerance, int i) {
  Lanes tolerance;
  load(tolerance, centre.guide.at(kInverseDepthPlane) + i);
  tolerance *= inverse_tolerance;
  load_blurred(sums, centre.light, i);
  Lanes sum = Lanes{} + 1.0f;
  for (std::size_t k = 0; k < neighbour_count; ++k) {
    const BlurSource& source = neighbours[k];
    GuideLanes there;
    BlurLanes blurred;
    Lanes weight;
    load_guide(there, source.guide, i);
    lane_weights(weight, here, there, tolerance);
    weight *= source.weight;
    sum += weight;
    load_blurred(blurred, source.light, i);
    for (int c = 0; c < kLightPlanes; ++c) {
      sums.light[c] += weight * blurred.light[c];
      sums.reorientation[c] += weight * blurred.reorientation[c];
    }
  }
  const Lanes scale = 1.0f / sum;
  for (int c = 0; c < kLightPlanes; ++c) {
    sums.light[c] *= scale;
    sums.reorientation[c] *= scale;
  }
}

/// Blurs a row; finish(blurred, here, i) stores the pixels from the `i`-th on.
template <class Finish>
LAMBENT_FORCE_INLINE void blur_each(const BlurSource& centre, const BlurSource* neighbours,
                                    std::size_t neighbour_count, int count, float inverse_tolerance,
                                    Finish finish) {
  for (int i = 0; i < count; i += kLanes) {
    GuideLanes here;
    BlurLanes blurred;
    load_guide(here, centre.guide, i);
    blur(blurred, here, centre, neighbours, neighbour_count, inverse_tolerance, i);
    finish(blurred, here, i);
  }
}

static void blur_row(const BlurSource& centre, const BlurSource* neighbours,
                     std::size_t neighbour_count, const Planes& out, int count,
                     float inverse_tolerance) {
  blur_each(centre, neighbours, neighbour_count, count, inverse_tolerance,
            [&](const BlurLanes& blurred, const GuideLanes&, int i) {
              for (int c = 0; c < kLightPlanes; ++c) {
                Lanes word;
                pack_halves(word, blurred.light[c], blurred.reorientation[c]);
                store(out.at(c) + i, word);
              }
            });
}

static void blur_row_relit(const BlurSource& centre, const BlurSource* neighbours,
                           std::size_t neighbour_count, const Planes& out, int count,
                           float inverse_tolerance) {
  blur_each(centre, neighbours, neighbour_count, count, inverse_tolerance,
            [&](const BlurLanes& blurred, const GuideLanes& here, int i) {
              const Lanes light = blurred.light[0] * kRedLuminance +
                                  blurred.light[1] * kGreenLuminance +
                                  blurred.light[2] * kBlueLuminance;
              const Lanes reoriented = blurred.reorientation[0] * here.nx +
                                       blurred.reorientation[1] * here.ny +
                                       blurred.reorientation[2] * here.nz;
              const Lanes share = reoriented_share(reoriented, light);
              for (int c = 0; c < kLightPlanes; ++c) store(out.at(c) + i, blurred.light[c] * share);
            });
}
