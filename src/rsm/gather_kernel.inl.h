// SPDX-License-Identifier: Apache-2.0
// The gathers for one instruction set; see core/simd_levels.h: loops around texel_light.inl.h, for
// lanes of pixels.
#include "core/guide_lanes.inl.h"

#define Real Lanes
#define LAMBENT_REAL_FN LAMBENT_FORCE_INLINE
#include "shared/relit_blur.inl.h"

using PointNumbers = GuideLanes;
/// All pixels read the same texel.
namespace alike {
#define TexelReal float
#include "rsm/texel_light.inl.h"
#undef TexelReal
}  // namespace alike
/// Each pixel reads a texel of its own.
namespace each {
#define TexelReal Lanes
#include "rsm/texel_light.inl.h"
#undef TexelReal
}  // namespace each
#undef Real
#undef LAMBENT_REAL_FN

/// Pixels that gather light, in registers.
struct GatherLanes : GuideLanes {
  Lanes light[kLightPlanes];
  Lanes directions[kDirectionPlanes];
};

LAMBENT_FORCE_INLINE void load_light(GatherLanes& p, const GatherRow& row, int i, bool directions) {
  for (int c = 0; c < kLightPlanes; ++c) load(p.light[c], row.light.at(c) + i);
  for (int c = 0; c < kDirectionPlanes && directions; ++c)
    load(p.directions[c], row.directions.at(c) + i);
}

LAMBENT_FORCE_INLINE void clear_light(GatherLanes& p) {
  for (Lanes& light : p.light) light = Lanes{};
  for (Lanes& direction : p.directions) direction = Lanes{};
}

LAMBENT_FORCE_INLINE void store_light(const GatherLanes& p, const GatherRow& row, int i,
                                      bool directions) {
  for (int c = 0; c < kLightPlanes; ++c) store(row.light.at(c) + i, p.light[c]);
  for (int c = 0; c < kDirectionPlanes && directions; ++c)
    store(row.directions.at(c) + i, p.directions[c]);
}

/// A texel whose flux is over pi; `T` is the type of its numbers.
template <class Numbers, class T>
struct LitTexel {
  Numbers numbers;
  T red, green, blue;
};
using SameTexel = LitTexel<alike::TexelNumbers, float>;
using OwnTexel = LitTexel<each::TexelNumbers, Lanes>;

/// Adds a texel's light to the pixels and, if `directions`, the vectors to it.
template <class Numbers, class T>
LAMBENT_FORCE_INLINE void add_texel(GatherLanes& p, const LitTexel<Numbers, T>& t,
                                    bool directions) {
  const auto sight = see_texel(p, t.numbers);
  const Lanes term = sight.numerator * sight.inverse;
  p.light[0] += term * t.red;
  p.light[1] += term * t.green;
  p.light[2] += term * t.blue;
  if (!directions) return;
  const T flux = t.red * kRedLuminance + t.green * kGreenLuminance + t.blue * kBlueLuminance;
  const Lanes share = sight.above_texel * sight.inverse * flux;
  p.directions[0] += share * sight.x;
  p.directions[1] += share * sight.y;
  p.directions[2] += share * sight.z;
}

LAMBENT_FORCE_INLINE SameTexel same_texel(const RsmTexel& t) {
  return {{t.position_ws.x, t.position_ws.y, t.position_ws.z, t.normal_ws.x, t.normal_ws.y,
           t.normal_ws.z, t.softening},
          t.flux.x * kInvPi,
          t.flux.y * kInvPi,
          t.flux.z * kInvPi};
}

/// Gathers the same texels at all pixels; texel_at(k) returns texel k.
template <class TexelAt>
LAMBENT_FORCE_INLINE void gather_alike(const GatherRow& row, std::size_t count,
                                       const TexelAt& texel_at, bool directions) {
  constexpr std::size_t kStep = kTexelsPerDirection;
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes pixels;
    load_guide(pixels, row.guide, i);
    clear_light(pixels);
    std::size_t k = 0;
    for (; directions && k + kStep <= count; k += kStep) {
      add_texel(pixels, same_texel(texel_at(k)), true);
      for (std::size_t j = 1; j < kStep; ++j) {
        add_texel(pixels, same_texel(texel_at(k + j)), false);
      }
    }
    for (; k < count; ++k) {
      add_texel(pixels, same_texel(texel_at(k)), directions && k % kStep == 0);
    }
    store_light(pixels, row, i, directions);
  }
}

static void contiguous(const GatherRow& row, const RsmTexel* texels, std::size_t count) {
  const auto texel_at = [=](std::size_t k) -> const RsmTexel& { return texels[k]; };
  if (row.directions.first != nullptr) return gather_alike(row, count, texel_at, true);
  gather_alike(row, count, texel_at, false);
}

static void scattered(const GatherRow& row, const RsmTexel* rendered, const std::uint32_t* places,
                      std::size_t count) {
  const auto texel_at = [=](std::size_t k) -> const RsmTexel& { return rendered[places[k]]; };
  if (row.directions.first != nullptr) return gather_alike(row, count, texel_at, true);
  gather_alike(row, count, texel_at, false);
}

/// Loads a field of each lane's texel: `floats` points to that field of the first texel.
LAMBENT_FORCE_INLINE void fetch(Lanes& lanes, const float* floats, const std::uint32_t* places) {
  constexpr std::size_t kStride = sizeof(RsmTexel) / sizeof(float);
  float values[kLanes];
  for (int l = 0; l < kLanes; ++l) values[l] = floats[places[l] * kStride];
  load(lanes, values);
}

static void per_pixel(const GatherRow& row, const RsmTexel* texels, const std::uint32_t* places,
                      std::size_t count) {
  const bool directions = row.directions.first != nullptr;
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes pixels;
    load_guide(pixels, row.guide, i);
    clear_light(pixels);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t* at = places + k * kLanes;
      OwnTexel t;
      fetch(t.numbers.x, &texels->position_ws.x, at);
      fetch(t.numbers.y, &texels->position_ws.y, at);
      fetch(t.numbers.z, &texels->position_ws.z, at);
      fetch(t.numbers.nx, &texels->normal_ws.x, at);
      fetch(t.numbers.ny, &texels->normal_ws.y, at);
      fetch(t.numbers.nz, &texels->normal_ws.z, at);
      fetch(t.numbers.softening, &texels->softening, at);
      fetch(t.red, &texels->flux.x, at);
      fetch(t.green, &texels->flux.y, at);
      fetch(t.blue, &texels->flux.z, at);
      t.red *= kInvPi;
      t.green *= kInvPi;
      t.blue *= kInvPi;
      add_texel(pixels, t, directions && k % kTexelsPerDirection == 0);
    }
    store_light(pixels, row, i, directions);
  }
}

/// Adds the light of one texel for each pixel, given its fields: position, normal, softening, flux
/// over pi.
static void add_fetched(const GatherRow& row, int first, const float (*fields)[kLanes],
                        bool directions) {
  GatherLanes pixels;
  load_guide(pixels, row.guide, first);
  load_light(pixels, row, first, directions);
  Lanes f[kTexelFields];
  for (int k = 0; k < kTexelFields; ++k) load(f[k], fields[k]);
  add_texel(pixels, OwnTexel{{f[0], f[1], f[2], f[3], f[4], f[5], f[6]}, f[7], f[8], f[9]},
            directions);
  store_light(pixels, row, first, directions);
}

/// reorientation() of shared/reorient_irradiance.h for lanes.
static void reorientable(const GatherRow& row) {
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes p;
    load_guide(p, row.guide, i);
    load_light(p, row, i, true);
    const Lanes light =
        p.light[0] * kRedLuminance + p.light[1] * kGreenLuminance + p.light[2] * kBlueLuminance;
    const Lanes across = p.directions[0] * p.nx + p.directions[1] * p.ny + p.directions[2] * p.nz;
    const Lanes square = p.directions[0] * p.directions[0] + p.directions[1] * p.directions[1] +
                         p.directions[2] * p.directions[2];
    Lanes length;
    for (int l = 0; l < kLanes; ++l) length[l] = std::sqrt(square[l]);
    const Lanes scale = direction_scale(light, across, length);
    const Lanes rest = reorientation_along_normal(light, across, scale);
    const Lanes normal[] = {p.nx, p.ny, p.nz};
    for (int c = 0; c < kLightPlanes; ++c) {
      Lanes word;
      pack_halves(word, p.light[c], p.directions[c] * scale + normal[c] * rest);
      store(row.light.at(c) + i, word);
    }
  }
}

/// For each texel, the sums over points of its term and of the term's square.
static void add_terms(const ConstPlanes& points, int count, const RsmTexel* texels,
                      std::size_t texel_count, TermSums* sums) {
  for (std::size_t k = 0; k < texel_count; ++k) {
    const SameTexel t = same_texel(texels[k]);
    Lanes terms = Lanes{}, squares = Lanes{};
    for (int i = 0; i < count; i += kLanes) {
      GuideLanes p;
      load_guide(p, points, i);
      const auto sight = see_texel(p, t.numbers);
      const Lanes term = sight.numerator * sight.inverse;
      terms += term;
      squares += term * term;
    }
    sums[k] = {0.0f, 0.0f};
    for (int l = 0; l < kLanes; ++l) {
      sums[k].terms += terms[l] * kInvPi;
      sums[k].squares += squares[l] * (kInvPi * kInvPi);
    }
  }
}
