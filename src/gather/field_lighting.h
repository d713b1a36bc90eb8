// SPDX-License-Identifier: Apache-2.0
// The field's light at the hits of rays that gather it.
#pragma once

#include <cstdint>
#include <span>

#include "field/correction/correction_use.h"
#include "field/field_access.h"
#include "field/secondary/gathering_rays.h"

namespace lambent {

/// How a field lights the hits of gathering rays. `grids`: those of its volumes. All must outlive
/// what is returned.
inline HitLighting lit_by_field(const World& world, const IrradianceField& field,
                                std::span<const ProbeGrid> grids, const ShadeHitsSettings& shading,
                                int max_secondary_rays) {
  HitLighting by{world, grids, shading, max_secondary_rays, {}};
  by.look_up = [&world, &field](std::span<const FieldQuery> queries,
                                std::span<glm::vec3> irradiance) {
    look_up_irradiance(field, queries, CorrectionUse::picked, irradiance, world);
    return std::uint64_t{0};
  };
  return by;
}

}  // namespace lambent
