// SPDX-License-Identifier: Apache-2.0
// filter_row for one instruction set; see core/simd_levels.h.
#include "core/lanes.inl.h"

/// Three-component vectors of several pixels, one component of all pixels after the other.
struct Lanes3 {
  Lanes x, y, z;
  Lanes3() = default;
  LAMBENT_FORCE_INLINE Lanes3(Lanes a, Lanes b, Lanes c) : x(a), y(b), z(c) {}
};

LAMBENT_FORCE_INLINE Lanes3 operator-(Lanes3 a, Lanes3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LAMBENT_FORCE_INLINE Lanes3 operator+(Lanes3 a, Lanes3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
LAMBENT_FORCE_INLINE Lanes3 operator*(Lanes3 a, Lanes b) {
  return {a.x * b, a.y * b, a.z * b};
}
LAMBENT_FORCE_INLINE void operator+=(Lanes3& a, Lanes3 b) {
  a.x += b.x;
  a.y += b.y;
  a.z += b.z;
}
LAMBENT_FORCE_INLINE Lanes dot(Lanes3 a, Lanes3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
LAMBENT_FORCE_INLINE Lanes max(Lanes a, float b) {
  const Lanes other = Lanes{} + b;
  return a > other ? a : other;
}
LAMBENT_FORCE_INLINE Lanes min(Lanes a, float b) {
  const Lanes other = Lanes{} + b;
  return a < other ? a : other;
}

/// Pixels of a row, with access to their neighbours.
struct PixelLanes {
  using Real = Lanes;
  using Real3 = Lanes3;
#define LAMBENT_REAL_FN LAMBENT_FORCE_INLINE
// Without unrolling, the loop takes 1.5 times as many instructions
#ifdef __clang__
#define LAMBENT_UNROLL_TAPS _Pragma("unroll")
#else
#define LAMBENT_UNROLL_TAPS _Pragma("GCC unroll 9")
#endif

  LAMBENT_FORCE_INLINE static Lanes zero_unless_positive(Lanes condition, Lanes value) {
    return condition > 0.0f ? value : Lanes{};
  }
  LAMBENT_FORCE_INLINE static Lanes larger(Lanes a, Lanes b) {
    return a > b ? a : b;
  }
  LAMBENT_FORCE_INLINE static Lanes smaller(Lanes a, Lanes b) {
    return a < b ? a : b;
  }
  LAMBENT_FORCE_INLINE Lanes fetch_guide(int plane, int x, int y) const {
    Lanes lanes;
    load(lanes, guide.at(plane) + y * guide_row + x);
    return lanes;
  }
  LAMBENT_FORCE_INLINE Lanes fetch_light(int plane, int x, int y) const {
    Lanes lanes;
    load(lanes, light.at(plane) + y * light_row + x);
    return lanes;
  }
  LAMBENT_FORCE_INLINE Lanes fetch_lobe(int plane, int x, int y) const {
    Lanes lanes;
    load(lanes, lobes.at(plane) + y * lobe_row + x);
    return lanes;
  }

#include "denoise/atrous.inl.h"
#undef LAMBENT_REAL_FN
#undef LAMBENT_UNROLL_TAPS

  LAMBENT_FORCE_INLINE void filter(const AtrousPass& by, const Planes& out) {
    const AtrousLight filtered = filtered_pixel(by);
    store(out.at(0), filtered.light.x);
    store(out.at(1), filtered.light.y);
    store(out.at(2), filtered.light.z);
    store(out.at(kSpreadPlane), filtered.spread);
    store(out.at(kSharePlane), filtered.share);
    if (by.has_base != 0) {
      store(out.at(kBasePlane), filtered.base.x);
      store(out.at(kBasePlane + 1), filtered.base.y);
      store(out.at(kBasePlane + 2), filtered.base.z);
    }
  }

  ConstPlanes guide, light, lobes;
  std::ptrdiff_t guide_row, light_row, lobe_row;  // floats from a row to the next one
};

/// Filters a row with flags that are compile-time constants, so that loops have no branches.
LAMBENT_FORCE_INLINE void filter_lanes(AtrousPass by, const AtrousRow& row, uint geometric,
                                       uint has_base, uint has_levels, uint has_lobes,
                                       uint checks_steps = 0, uint far_lobes = kNoFarLobes) {
  by.geometric = geometric;
  by.checks_steps = checks_steps;
  by.has_base = has_base;
  by.has_levels = has_levels;
  by.has_lobes = has_lobes;
  by.far_lobes = far_lobes;
  for (int i = 0; i < row.count; i += kLanes) {
    const float* lobes = has_lobes != 0 ? row.lobes.first + i : nullptr;
    PixelLanes pixels{{row.guide.first + i, row.guide.stride},
                      {row.in.first + i, row.in.stride},
                      {lobes, row.lobes.stride},
                      row.guide_row,
                      row.light_row,
                      row.lobe_row};
    pixels.filter(by, {row.out.first + i, row.out.stride});
  }
}

/// Filters a row of a pass that checks steps and compares no light, which no lobe reflects.
LAMBENT_FORCE_INLINE void filter_steps(const AtrousPass& by, const AtrousRow& row) {
  if (by.has_base != 0) return filter_lanes(by, row, 1, 1, 0, 0, 1);
  if (by.has_levels != 0) return filter_lanes(by, row, 1, 0, 1, 0, 1);
  filter_lanes(by, row, 1, 0, 0, 0, 1);
}

/// Filters a row of a pass that checks steps and compares no light, or that of far lobes alone.
LAMBENT_FORCE_INLINE void filter_reflections(const AtrousPass& by, const AtrousRow& row) {
  if (by.far_lobes == kFarLobes) return filter_lanes(by, row, 1, 0, 0, 1, 1, kFarLobes);
  if (by.far_lobes == kFarLobesWithinNoise) {
    return filter_lanes(by, row, 1, 0, 0, 1, 1, kFarLobesWithinNoise);
  }
  filter_lanes(by, row, 1, 0, 0, 1, 1);
}

static void filter_row(const AtrousPass& by, const AtrousRow& row) {
  if (by.checks_steps != 0) {
    by.has_lobes != 0 ? filter_reflections(by, row) : filter_steps(by, row);
  } else if (by.has_lobes != 0) {
    by.geometric != 0 ? filter_lanes(by, row, 1, 0, 0, 1) : filter_lanes(by, row, 0, 0, 0, 1);
  } else if (by.has_base != 0) {
    by.geometric != 0 ? filter_lanes(by, row, 1, 1, 0, 0) : filter_lanes(by, row, 0, 1, 0, 0);
  } else if (by.has_levels != 0) {
    by.geometric != 0 ? filter_lanes(by, row, 1, 0, 1, 0) : filter_lanes(by, row, 0, 0, 1, 0);
  } else {
    by.geometric != 0 ? filter_lanes(by, row, 1, 0, 0, 0) : filter_lanes(by, row, 0, 0, 0, 0);
  }
}
