// SPDX-License-Identifier: Apache-2.0
// The gathers for one instruction set: see core/simd_levels.h. bounded_geometry_term for lanes of
// pixels, and what surrounds it.
#include "core/lanes.inl.h"

/// Pixels that gather, in registers.
struct GatherLanes {
  Lanes x, y, z, nx, ny, nz;
  Lanes light[kLightPlanes];
};

LAMBENT_FORCE_INLINE void load_points(GatherLanes& p, const GuidePlanes& guide, int i) {
  load(p.x, guide.position.at[0] + i);
  load(p.y, guide.position.at[1] + i);
  load(p.z, guide.position.at[2] + i);
  load(p.nx, guide.normal.at[0] + i);
  load(p.ny, guide.normal.at[1] + i);
  load(p.nz, guide.normal.at[2] + i);
}

/// `directed` is known where this is inlined: without it, the ways to the light are left alone.
LAMBENT_FORCE_INLINE void load_pixels(GatherLanes& p, const GatherRow& row, int i, bool directed) {
  load_points(p, row.guide, i);
  for (int c = 0; c < (directed ? kLightPlanes : 3); ++c) load(p.light[c], row.light.at[c] + i);
}

LAMBENT_FORCE_INLINE void store_light(const GatherLanes& p, const GatherRow& row, int i,
                                      bool directed) {
  for (int c = 0; c < (directed ? kLightPlanes : 3); ++c) store(row.light.at[c] + i, p.light[c]);
}

/// A texel as a gather reads it; flux is over pi. `T` is a float where all pixels ask the same
/// texel, or Lanes where each asks one of its own.
template <class T>
struct TexelFields {
  T x, y, z, nx, ny, nz, softening, red, green, blue;
};

/// From pixels to a texel.
struct Way {
  Lanes x, y, z;         // [m]
  Lanes below_texel;     // of its plane [m]
  Lanes inverse_fourth;  // of the softened distance [1/m^4]
};

/// bounded_geometry_term times pi.
template <class T>
LAMBENT_FORCE_INLINE void texel_term(Lanes& term, Way& way, const GatherLanes& p,
                                     const TexelFields<T>& t) {
  way.x = t.x - p.x;
  way.y = t.y - p.y;
  way.z = t.z - p.z;
  way.below_texel = t.nx * way.x + t.ny * way.y + t.nz * way.z;
  const Lanes above_point = p.nx * way.x + p.ny * way.y + p.nz * way.z;
  const Lanes c = -(p.nx * t.nx + p.ny * t.ny + p.nz * t.nz);
  const Lanes square = way.x * way.x + way.y * way.y + way.z * way.z + t.softening;
  const Lanes compensation =
      kSofteningCorner + c * (kSofteningLinear + c * (kSofteningSquare + c * kSofteningCube));
  way.inverse_fourth = 1.0f / (square * square);
  keep(way.inverse_fourth, (way.below_texel < 0.0f) & (above_point > 0.0f));
  term = (t.softening * compensation - way.below_texel * above_point) * way.inverse_fourth;
}

/// Adds what a texel brings to the pixels, and the ways to it.
template <class T>
LAMBENT_FORCE_INLINE void add_texel(GatherLanes& p, const TexelFields<T>& t, bool directed) {
  Lanes term;
  Way way;
  texel_term(term, way, p, t);
  p.light[0] += term * t.red;
  p.light[1] += term * t.green;
  p.light[2] += term * t.blue;
  if (!directed) return;
  const T flux = t.red * kRedLuminance + t.green * kGreenLuminance + t.blue * kBlueLuminance;
  const Lanes share = way.below_texel * way.inverse_fourth * -flux;
  p.light[3] += share * way.x;
  p.light[4] += share * way.y;
  p.light[5] += share * way.z;
}

LAMBENT_FORCE_INLINE TexelFields<float> fields_of(const RsmTexel& t) {
  return {t.position_ws.x,    t.position_ws.y,    t.position_ws.z,   t.normal_ws.x,
          t.normal_ws.y,      t.normal_ws.z,      t.softening,       t.flux.x * kInvPi,
          t.flux.y * kInvPi, t.flux.z * kInvPi};
}

/// Adds texels that all pixels ask alike; texel_at(k) finds the k-th.
template <class TexelAt>
LAMBENT_FORCE_INLINE void gather_alike(const GatherRow& row, std::size_t count,
                                       const TexelAt& texel_at, bool directed) {
  constexpr std::size_t kStep = kTexelsPerDirection;
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes pixels;
    load_pixels(pixels, row, i, directed);
    std::size_t k = 0;
    for (; directed && k + kStep <= count; k += kStep) {
      add_texel(pixels, fields_of(texel_at(k)), true);
      for (std::size_t j = 1; j < kStep; ++j) {
        add_texel(pixels, fields_of(texel_at(k + j)), false);
      }
    }
    for (; k < count; ++k) {
      add_texel(pixels, fields_of(texel_at(k)), directed && k % kStep == 0);
    }
    store_light(pixels, row, i, directed);
  }
}

static void contiguous(const GatherRow& row, const RsmTexel* texels, std::size_t count) {
  const auto texel_at = [=](std::size_t k) -> const RsmTexel& { return texels[k]; };
  if (row.directed) return gather_alike(row, count, texel_at, true);
  gather_alike(row, count, texel_at, false);
}

static void scattered(const GatherRow& row, const RsmTexel* rendered, const std::uint32_t* places,
                      std::size_t count) {
  const auto texel_at = [=](std::size_t k) -> const RsmTexel& { return rendered[places[k]]; };
  if (row.directed) return gather_alike(row, count, texel_at, true);
  gather_alike(row, count, texel_at, false);
}

/// A field of the texels that lanes ask for: `floats` points to that field of the first texel.
LAMBENT_FORCE_INLINE void fetch(Lanes& lanes, const float* floats, const std::uint32_t* places) {
  constexpr std::size_t kStride = sizeof(RsmTexel) / sizeof(float);
  float values[kLanes];
  for (int l = 0; l < kLanes; ++l) values[l] = floats[places[l] * kStride];
  load(lanes, values);
}

static void per_pixel(const GatherRow& row, const RsmTexel* texels, const std::uint32_t* places,
                      std::size_t count) {
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes pixels;
    load_pixels(pixels, row, i, row.directed);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t* at = places + k * kLanes;
      TexelFields<Lanes> t;
      fetch(t.x, &texels->position_ws.x, at);
      fetch(t.y, &texels->position_ws.y, at);
      fetch(t.z, &texels->position_ws.z, at);
      fetch(t.nx, &texels->normal_ws.x, at);
      fetch(t.ny, &texels->normal_ws.y, at);
      fetch(t.nz, &texels->normal_ws.z, at);
      fetch(t.softening, &texels->softening, at);
      fetch(t.red, &texels->flux.x, at);
      fetch(t.green, &texels->flux.y, at);
      fetch(t.blue, &texels->flux.z, at);
      t.red *= kInvPi;
      t.green *= kInvPi;
      t.blue *= kInvPi;
      add_texel(pixels, t, row.directed && k % kTexelsPerDirection == 0);
    }
    store_light(pixels, row, i, row.directed);
  }
}

/// Adds the light of one texel a pixel, its fields already fetched: position, normal, softening,
/// flux over pi.
static void add_fetched(const GatherRow& row, int first, const float (*fields)[kLanes],
                        bool directed) {
  GatherLanes pixels;
  load_pixels(pixels, row, first, directed);
  Lanes f[kTexelFields];
  for (int k = 0; k < kTexelFields; ++k) load(f[k], fields[k]);
  add_texel(pixels,
            TexelFields<Lanes>{f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9]},
            directed);
  store_light(pixels, row, first, directed);
}

LAMBENT_FORCE_INLINE void luminance_of(Lanes& result, const GatherLanes& p) {
  result = p.light[0] * kRedLuminance + p.light[1] * kGreenLuminance +
           p.light[2] * kBlueLuminance;
}

/// relighting, for lanes.
static void direct(const GatherRow& row) {
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes p;
    load_pixels(p, row, i, true);
    Lanes light;
    luminance_of(light, p);
    const Lanes across = p.light[3] * p.nx + p.light[4] * p.ny + p.light[5] * p.nz;
    const Lanes square =
        p.light[3] * p.light[3] + p.light[4] * p.light[4] + p.light[5] * p.light[5];
    Lanes least;
    for (int l = 0; l < kLanes; ++l) least[l] = kLeastDirectedCosine * std::sqrt(square[l]);
    const Lanes bound = across > least ? across : least;
    Lanes scale = light / bound;
    keep(scale, bound > 0.0f);
    const Lanes rest = light * (1.0f - kHorizonLight) - across * scale;
    p.light[3] = p.light[3] * scale + p.nx * rest;
    p.light[4] = p.light[4] * scale + p.ny * rest;
    p.light[5] = p.light[5] * scale + p.nz * rest;
    store_light(p, row, i, true);
  }
}

/// relit_share, for lanes.
static void relight(const GuidePlanes& guide, const LightPlanes& planes, int count) {
  const GatherRow row{guide, planes, count, true};
  for (int i = 0; i < count; i += kLanes) {
    GatherLanes p;
    load_pixels(p, row, i, true);
    Lanes light;
    luminance_of(light, p);
    Lanes ratio = (p.light[3] * p.nx + p.light[4] * p.ny + p.light[5] * p.nz) / light;
    ratio += kHorizonLight;
    keep(ratio, (ratio > 0.0f) & (light > 0.0f));
    for (int c = 0; c < 3; ++c) p.light[c] *= ratio;
    store_light(p, row, i, false);
  }
}

/// For each texel, the sums over points of its term and of the term's square.
static void add_terms(const GuidePlanes& points, int count, const RsmTexel* texels,
                      std::size_t texel_count, TermSums* sums) {
  for (std::size_t k = 0; k < texel_count; ++k) {
    const TexelFields<float> t = fields_of(texels[k]);
    Lanes terms = Lanes{}, squares = Lanes{};
    for (int i = 0; i < count; i += kLanes) {
      Lanes term;
      Way way;
      GatherLanes p;
      load_points(p, points, i);
      texel_term(term, way, p, t);
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
