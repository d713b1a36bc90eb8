// SPDX-License-Identifier: Apache-2.0
// Refuses work that would not fit into memory before it starts, and suggests what would fit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "field/field_memory.h"
#include "lambent/error.h"
#include "lambent/render_options.h"
#include "lambent/world.h"

namespace lambent::cli {

/// Memory for rendering and writing a picture, without the field and the scene [bytes].
std::uint64_t picture_bytes(const RenderOptions& options, const glm::ivec2& size);

/// The largest size of the same aspect whose picture takes no more than `bytes`.
glm::ivec2 size_that_fits(const RenderOptions& options, const glm::ivec2& size,
                          std::uint64_t bytes);

/// Fails where a picture takes more than `available` [bytes].
Expected<void> check_picture_memory(const RenderOptions& options, const glm::ivec2& size,
                                    std::uint64_t available);

/// Fails where `fields` fields with `rays_per_probe` take more than `available` [bytes].
Expected<void> check_field_memory(const FieldMemory& field, int rays_per_probe, int fields,
                                  std::uint64_t available);
/// The processes that share a field.
struct FieldRanks {
  int all = 1;              ///< Total number.
  int on_this_machine = 1;  ///< Number of them on this machine.
};

/// Fails where the ranks on this machine together take more than `available` for their parts of a
/// shared field.
Expected<void> check_shared_field_memory(const FieldMemory& field, int rays_per_probe,
                                         const FieldRanks& ranks, std::uint64_t available);

/// Fails where comparing two images of that size takes more than `available` [bytes], in addition
/// to the images themselves.
Expected<void> check_comparison_memory(const glm::ivec2& size, std::uint64_t available);

/// Rays per probe whose surfels are in host memory: 0 where a device stores them, which checks its
/// memory itself.
int host_rays(const FieldSettings& settings, const World& world);

/// Makes a field without light, one of `fields` that will exist at a time, for a scene that is
/// first seen by `camera`. Fails where they would not fit into memory. `options` are the source of
/// the settings, which errors name.
Expected<IrradianceField> make_field(const FieldSettings& settings, const FieldOptions& options,
                                     const World& world, const Camera& camera, int fields,
                                     const FieldRanks& ranks = {});

}  // namespace lambent::cli
