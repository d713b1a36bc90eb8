// SPDX-License-Identifier: Apache-2.0
// Highway compiles this file once for each instruction set and picks the best one that the machine
// supports. Products and sums are not fused, so that all of them compute the same bits.
#include "glossy/reuse_lanes.h"

// Instruction sets that differ in nothing that is used here
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "glossy/reuse_lanes.cpp"
// clang-format off: foreach_target has to come first
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace lambent {
namespace HWY_NAMESPACE {
namespace {

#include "core/highway_lanes.inl.h"

// The types and functions that the formulas require.
struct CoatRay {
  Lanes3 direction_ws;
  Lanes distance;
  Lanes3 radiance;
  Lanes pdf;
  Lanes3 apart;
  Lanes apart_luminance;
};
struct Reflectance {
  Lanes3 f0;
  Lanes f90;
};

HWY_INLINE Lanes::Mask left_scene(Lanes distance) {
  return distance == infinity();
}

HWY_INLINE Lanes luminance(Lanes3 light) {
  return light.x * kRedLuminance + light.y * kGreenLuminance + light.z * kBlueLuminance;
}

#define Real Lanes
#define Real3 Lanes3
#define LAMBENT_REAL_FN HWY_INLINE
#include "shared/microfacet.inl.h"
#include "shared/mis_weights.inl.h"
#include "shared/relit_blur.inl.h"

#include "glossy/coat_sums.inl.h"
#undef Real
#undef Real3
#undef LAMBENT_REAL_FN

/// Planes of numbers, at the pixels of the lanes.
struct Planes {
  const float* first;
  std::size_t pitch;

  HWY_INLINE Lanes at(int plane) const {
    return load_lanes(first + static_cast<std::size_t>(plane) * pitch);
  }
  HWY_INLINE Lanes3 three_at(int plane) const { return {at(plane), at(plane + 1), at(plane + 2)}; }
};

HWY_INLINE CoatLobe lobe_at(const Planes& coats) {
  return {coats.three_at(kLobePosition), coats.three_at(kLobeGeometricNormal),
          coats.three_at(kLobeNormal),   coats.three_at(kLobeViewer),
          coats.at(kLobeSquareAlpha),    coats.at(kLobePdfScale),
          coats.at(kLobeLambda)};
}

HWY_INLINE CoatRay ray_at(const Planes& coats) {
  return {coats.three_at(kRayDirection), coats.at(kRayDistance),
          coats.three_at(kRayRadiance),  coats.at(kRayPdf),
          coats.three_at(kRayEmission),  coats.at(kRayEmissionLuminance)};
}

HWY_INLINE CoatReceiver receiver_at(const Planes& coats, const Planes& more) {
  return {lobe_at(coats),
          {more.three_at(kF0), more.at(kF90)},
          more.at(kInverseTolerance),
          ray_at(coats),
          {more.at(kOwnValue), more.at(kOwnLobePdf), {}},
          more.three_at(kMirror),
          more.at(kInverseMirrorPdf),
          more.at(kDensityScale)};
}

/// Planes of sums, at the pixels of the lanes.
struct SumPlanes {
  float* first;
  std::size_t pitch;

  HWY_INLINE void put(int plane, Lanes value) const {
    store_lanes(first + static_cast<std::size_t>(plane) * pitch, value);
  }
  HWY_INLINE void put(int plane, Lanes3 value) const {
    put(plane, value.x);
    put(plane + 1, value.y);
    put(plane + 2, value.z);
  }
};

HWY_INLINE void store_sums(const CoatSums& from, const SumPlanes& sums) {
  sums.put(kSumLight, from.light);
  sums.put(kSumEmission, from.emission);
  sums.put(kSumWeight, from.weight);
  sums.put(kSumSchlick, from.schlick);
  sums.put(kSumOwnWeight, from.own_weight);
  sums.put(kSumPixels, from.pixels);
  sums.put(kSumFitting, from.fitting);
  sums.put(kSumBrightest, from.brightest);
  sums.put(kSumBrightestWeight, from.brightest_weight);
  sums.put(kSumSquaredWeights, from.squared_weights);
  sums.put(kSumSquares, from.squares);
}

}  // namespace

void reuse_in_lanes(const ReuseRow& row, RowPlanes& sums) {
  const auto lanes = static_cast<int>(hn::Lanes(Lanes::D()));
  const std::size_t pitch = row.coats.pitch();
  for (int x = 0; x < row.width; x += lanes) {
    const Planes own{row.coats.at(row.row, 0) + x, pitch};
    const Planes more{row.receivers.at(row.receiver_row, 0) + x, pitch};
    const Lanes receives = more.at(kReceives);
    if (all_zero(receives)) continue;
    const CoatReceiver at = receiver_at(own, more);
    CoatSums found = no_coat_sums();
    for (const NeighbourRow& neighbours : row.around) {
      for (int dx = -kReuse; dx <= kReuse; ++dx) {
        if (neighbours.own && dx == 0) continue;
        const Planes there{row.coats.at(neighbours.row, 0) + x + dx, pitch};
        const CoatRay ray = ray_at(there);
        const float outermost = dx == -kReuse || dx == kReuse ? 0.5f : 1.0f;
        const Lanes weight = receives * (outermost * neighbours.weight);
        add_coat_ray(at, lobe_at(there), ray, select(ray.pdf != 0.0f, weight, 0.0f), found);
      }
    }
    store_sums(found, {sums.at(row.receiver_row, 0) + x, sums.pitch()});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lambent
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lambent {
namespace {

HWY_EXPORT(reuse_in_lanes);

}  // namespace

void reuse_row(const ReuseRow& row, RowPlanes& sums) {
  HWY_DYNAMIC_DISPATCH(reuse_in_lanes)(row, sums);
}

}  // namespace lambent
#endif  // HWY_ONCE
