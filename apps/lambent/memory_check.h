// SPDX-License-Identifier: Apache-2.0
// Work that cannot fit into memory is refused before it starts, with what would fit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "field/field_memory.h"
#include "lambent/error.h"
#include "lambent/render_options.h"
#include "lambent/world.h"

namespace lambent::cli {

/// Memory that rendering and writing a picture takes, the field and the scene aside [bytes].
std::uint64_t picture_bytes(const RenderOptions& options, const glm::ivec2& size);

/// The largest size of the same shape whose picture takes no more than `bytes`.
glm::ivec2 size_that_fits(const RenderOptions& options, const glm::ivec2& size,
                          std::uint64_t bytes);

/// Fails where a picture takes more than is available [bytes].
Expected<void> check_picture_memory(const RenderOptions& options, const glm::ivec2& size,
                                    std::uint64_t available);

/// Fails where so many fields of that many rays a probe take more than is available [bytes].
Expected<void> check_field_memory(const FieldMemory& field, int rays_per_probe, int fields,
                                  std::uint64_t available);
/// The processes that a field is made for.
struct FieldRanks {
  int all = 1;              ///< That share it.
  int on_this_machine = 1;  ///< Of these.
};

/// Fails where what ranks on this machine take of a field that they share is more than that.
Expected<void> check_shared_field_memory(const FieldMemory& field, int rays_per_probe,
                                         const FieldRanks& ranks, std::uint64_t available);

/// Fails where comparing two images of that size takes more than is available [bytes], beside the
/// images themselves.
Expected<void> check_comparison_memory(const glm::ivec2& size, std::uint64_t available);

/// Rays of a probe whose surfels will be in the processor's memory: none where a device keeps them,
/// which tells on its own what it can hold.
int host_rays(const FieldSettings& settings, const World& world);

/// A field without light, one of so many that there will be at a time, for a scene that is first
/// seen by `camera`. Fails where they would not fit. `options` are those that the settings came
/// from: errors name them.
Expected<IrradianceField> make_field(const FieldSettings& settings, const FieldOptions& options,
                                     const World& world, const Camera& camera, int fields,
                                     const FieldRanks& ranks = {});

}  // namespace lambent::cli
