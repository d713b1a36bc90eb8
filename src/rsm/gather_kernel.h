// SPDX-License-Identifier: Apache-2.0
// bounded_geometry_term for lanes of pixels, and what surrounds it in every gather.
#pragma once

#include "core/lanes.h"
#include "core/simd.h"
#include "rsm/gather.h"
#include "rsm/geometry.h"

namespace lambent {

/// Pixels that gather, in registers.
struct GatherLanes {
  Lanes x, y, z, nx, ny, nz;
  Lanes red, green, blue;
};

LAMBENT_FORCE_INLINE void load_pixels(GatherLanes& p, const GatherRow& row, int i) {
  load(p.x, row.guide.position.at[0] + i);
  load(p.y, row.guide.position.at[1] + i);
  load(p.z, row.guide.position.at[2] + i);
  load(p.nx, row.guide.normal.at[0] + i);
  load(p.ny, row.guide.normal.at[1] + i);
  load(p.nz, row.guide.normal.at[2] + i);
  load(p.red, row.light.at[0] + i);
  load(p.green, row.light.at[1] + i);
  load(p.blue, row.light.at[2] + i);
}

LAMBENT_FORCE_INLINE void store_light(const GatherLanes& p, const GatherRow& row, int i) {
  store(row.light.at[0] + i, p.red);
  store(row.light.at[1] + i, p.green);
  store(row.light.at[2] + i, p.blue);
}

/// Adds what texels bring to the pixels. `T` is a float where all pixels ask the same texel, or
/// Lanes where each asks one of its own.
template <class T>
LAMBENT_FORCE_INLINE void add_texel(GatherLanes& p, const T& x, const T& y, const T& z, const T& nx,
                                    const T& ny, const T& nz, const T& softening, const T& red,
                                    const T& green, const T& blue) {
  const Lanes dx = x - p.x, dy = y - p.y, dz = z - p.z;
  const Lanes below_texel = nx * dx + ny * dy + nz * dz;
  const Lanes above_point = p.nx * dx + p.ny * dy + p.nz * dz;
  const Lanes c = -(p.nx * nx + p.ny * ny + p.nz * nz);
  const Lanes square = dx * dx + dy * dy + dz * dz + softening;
  const Lanes compensation =
      kSofteningCorner + c * (kSofteningLinear + c * (kSofteningSquare + c * kSofteningCube));
  Lanes term = (softening * compensation - below_texel * above_point) / (square * square);
  keep(term, (below_texel < 0.0f) & (above_point > 0.0f));
  p.red += term * red;
  p.green += term * green;
  p.blue += term * blue;
}

}  // namespace lambent
