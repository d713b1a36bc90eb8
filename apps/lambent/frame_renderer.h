// SPDX-License-Identifier: Apache-2.0
// Pictures by each method of `lambent render`, and what they cost.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "lambent/error.h"
#include "lambent/field.h"
#include "lambent/image.h"
#include "lambent/progress.h"
#include "lambent/render_options.h"
#include "lambent/renderer.h"
#include "lambent/world.h"

namespace lambent::cli {

/// Paints pictures of a world, one after the other, lit by one field that follows the world.
class FrameRenderer {
 public:
  /// The options must outlive it.
  FrameRenderer(const RenderOptions& options, const glm::ivec2& size);

  /// Of its pictures [pixels].
  const glm::ivec2& size() const { return size_; }

  /// The world as it is now, whole. Times and counts go into `stats`.
  Expected<LayeredImage> paint(const World& world, const Camera& camera,
                               nlohmann::ordered_json& stats);

  /// The same into a file. Pictures of many pixels are made and written some rows at a time, where
  /// the method can. `stops` as of PictureFile.
  Expected<void> paint_to_file(const World& world, const Camera& camera, const std::string& path,
                               std::optional<float>& stops, nlohmann::ordered_json& stats);

  /// Path-traces the same view and prints the picture's error beside it.
  Expected<void> verify(const World& world, const Camera& camera, const LayeredImage& image,
                        nlohmann::ordered_json& stats) const;

 private:
  Expected<void> light(const World& world, const Camera& camera, nlohmann::ordered_json& stats);
  Expected<RenderedFrame> render(const World& world, const Camera& camera,
                                 const FrameSettings& frame, const ProgressFn& progress) const;
  FrameSettings frame_settings() const;
  Expected<void> follow(const World& world, const Camera& camera, nlohmann::ordered_json& stats);
  Expected<void> split_bounces(const World& world, const Camera& camera,
                               nlohmann::ordered_json& stats);
  LayeredImage paint_by_reference(const World& world, const Camera& camera,
                                  nlohmann::ordered_json& stats) const;

  const RenderOptions& options_;
  glm::ivec2 size_;
  ProgressFn progress_;
  std::optional<IrradianceField> field_;         // after the first picture
  std::optional<IrradianceField> first_bounce_;  // what is taken out of it, of rsm+field
};

}  // namespace lambent::cli
