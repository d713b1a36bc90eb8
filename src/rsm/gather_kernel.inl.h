// SPDX-License-Identifier: Apache-2.0
// The gathers for one instruction set: see core/simd_levels.h. bounded_geometry_term for lanes of
// pixels, and what surrounds it.
#include "core/lanes.inl.h"

/// Pixels that gather, in registers.
struct GatherLanes {
  Lanes x, y, z, nx, ny, nz;
  Lanes red, green, blue;
};

LAMBENT_FORCE_INLINE void load_points(GatherLanes& p, const GuidePlanes& guide, int i) {
  load(p.x, guide.position.at[0] + i);
  load(p.y, guide.position.at[1] + i);
  load(p.z, guide.position.at[2] + i);
  load(p.nx, guide.normal.at[0] + i);
  load(p.ny, guide.normal.at[1] + i);
  load(p.nz, guide.normal.at[2] + i);
}

LAMBENT_FORCE_INLINE void load_pixels(GatherLanes& p, const GatherRow& row, int i) {
  load_points(p, row.guide, i);
  load(p.red, row.light.at[0] + i);
  load(p.green, row.light.at[1] + i);
  load(p.blue, row.light.at[2] + i);
}

LAMBENT_FORCE_INLINE void store_light(const GatherLanes& p, const GatherRow& row, int i) {
  store(row.light.at[0] + i, p.red);
  store(row.light.at[1] + i, p.green);
  store(row.light.at[2] + i, p.blue);
}

/// bounded_geometry_term times pi. `T` is a float where all pixels ask the same texel, or Lanes
/// where each asks one of its own.
template <class T>
LAMBENT_FORCE_INLINE void texel_term(Lanes& term, const GatherLanes& p, const T& x, const T& y,
                                     const T& z, const T& nx, const T& ny, const T& nz,
                                     const T& softening) {
  const Lanes dx = x - p.x, dy = y - p.y, dz = z - p.z;
  const Lanes below_texel = nx * dx + ny * dy + nz * dz;
  const Lanes above_point = p.nx * dx + p.ny * dy + p.nz * dz;
  const Lanes c = -(p.nx * nx + p.ny * ny + p.nz * nz);
  const Lanes square = dx * dx + dy * dy + dz * dz + softening;
  const Lanes compensation =
      kSofteningCorner + c * (kSofteningLinear + c * (kSofteningSquare + c * kSofteningCube));
  term = (softening * compensation - below_texel * above_point) / (square * square);
  keep(term, (below_texel < 0.0f) & (above_point > 0.0f));
}

/// Adds what texels bring to the pixels; flux is over pi.
template <class T>
LAMBENT_FORCE_INLINE void add_texel(GatherLanes& p, const T& x, const T& y, const T& z, const T& nx,
                                    const T& ny, const T& nz, const T& softening, const T& red,
                                    const T& green, const T& blue) {
  Lanes term;
  texel_term<T>(term, p, x, y, z, nx, ny, nz, softening);
  p.red += term * red;
  p.green += term * green;
  p.blue += term * blue;
}

/// Adds texels that all pixels ask alike; texel_at(k) finds the k-th.
template <class TexelAt>
LAMBENT_FORCE_INLINE void gather_alike(const GatherRow& row, std::size_t count,
                                       const TexelAt& texel_at) {
  for (int i = 0; i < row.count; i += kLanes) {
    GatherLanes pixels;
    load_pixels(pixels, row, i);
    for (std::size_t k = 0; k < count; ++k) {
      const RsmTexel& t = texel_at(k);
      add_texel(pixels, t.position_ws.x, t.position_ws.y, t.position_ws.z, t.normal_ws.x,
                t.normal_ws.y, t.normal_ws.z, t.softening, t.flux.x * kInvPi, t.flux.y * kInvPi,
                t.flux.z * kInvPi);
    }
    store_light(pixels, row, i);
  }
}

static void contiguous(const GatherRow& row, const RsmTexel* texels, std::size_t count) {
  gather_alike(row, count, [=](std::size_t k) -> const RsmTexel& { return texels[k]; });
}

static void scattered(const GatherRow& row, const RsmTexel* rendered, const std::uint32_t* places,
                      std::size_t count) {
  gather_alike(row, count, [=](std::size_t k) -> const RsmTexel& { return rendered[places[k]]; });
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
    load_pixels(pixels, row, i);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t* at = places + k * kLanes;
      Lanes x, y, z, nx, ny, nz, softening, red, green, blue;
      fetch(x, &texels->position_ws.x, at);
      fetch(y, &texels->position_ws.y, at);
      fetch(z, &texels->position_ws.z, at);
      fetch(nx, &texels->normal_ws.x, at);
      fetch(ny, &texels->normal_ws.y, at);
      fetch(nz, &texels->normal_ws.z, at);
      fetch(softening, &texels->softening, at);
      fetch(red, &texels->flux.x, at);
      fetch(green, &texels->flux.y, at);
      fetch(blue, &texels->flux.z, at);
      add_texel<Lanes>(pixels, x, y, z, nx, ny, nz, softening, red * kInvPi, green * kInvPi,
                       blue * kInvPi);
    }
    store_light(pixels, row, i);
  }
}

/// Adds the light of one texel a pixel, its fields already fetched: position, normal, softening,
/// flux over pi.
static void add_fetched(const GatherRow& row, int first, const float (*fields)[kLanes]) {
  GatherLanes pixels;
  load_pixels(pixels, row, first);
  Lanes f[kTexelFields];
  for (int k = 0; k < kTexelFields; ++k) load(f[k], fields[k]);
  add_texel<Lanes>(pixels, f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9]);
  store_light(pixels, row, first);
}

/// For each texel, the sums over points of its term and of the term's square.
static void add_terms(const GuidePlanes& points, int count, const RsmTexel* texels,
                      std::size_t texel_count, TermSums* sums) {
  for (std::size_t k = 0; k < texel_count; ++k) {
    const RsmTexel& t = texels[k];
    Lanes terms = Lanes{}, squares = Lanes{};
    for (int i = 0; i < count; i += kLanes) {
      Lanes term;
      GatherLanes p;
      load_points(p, points, i);
      texel_term(term, p, t.position_ws.x, t.position_ws.y, t.position_ws.z, t.normal_ws.x,
                 t.normal_ws.y, t.normal_ws.z, t.softening);
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
