// SPDX-License-Identifier: Apache-2.0
// Renders pictures by each method of `lambent render`, and records their costs.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lambent/error.h"
#include "lambent/field.h"
#include "lambent/image.h"
#include "lambent/progress.h"
#include "lambent/render_options.h"
#include "lambent/renderer.h"
#include "lambent/world.h"

namespace lambent::cli {

/// The size of a preview of a view from which its brightness is found, with a longer side of at
/// most `side` [pixels].
glm::ivec2 preview_of(const glm::ivec2& size, int side);

/// Renders pictures of a world, one after the other, lit by one field that follows the world.
class FrameRenderer {
 public:
  /// The options and the world must outlive it.
  FrameRenderer(const RenderOptions& options, const World& world, const glm::ivec2& size);

  /// Size of its pictures [pixels].
  const glm::ivec2& size() const { return size_; }

  /// Gives places along the path of a camera that moves finer probes, in their near_box(). To be
  /// called before the first picture; fields that are made anew for each frame do without.
  void set_path_boxes(std::vector<Bounds> path_boxes) { path_boxes_ = std::move(path_boxes); }

  /// Renders the current state of the world to a file. Large pictures are rendered and written some
  /// rows at a time, where the method supports it. For `stops`, see PictureFile. Adds times and
  /// counts to `stats`.
  Expected<void> paint_to_file(const Camera& camera, const std::string& path,
                               std::optional<float>& stops, nlohmann::ordered_json& stats);

  /// Path-traces the view that was rendered last, in a world on the processor, and prints the
  /// picture's error relative to it.
  Expected<void> verify(const World& world, const Camera& camera,
                        nlohmann::ordered_json& stats) const;

 private:
  Expected<void> expose_unlit(const Camera& camera, const std::string& path,
                              std::optional<float>& stops);
  Expected<void> paint(const Camera& camera, nlohmann::ordered_json& stats);
  Expected<void> light(const Camera& camera, nlohmann::ordered_json& stats);
  Expected<IndirectSources> sources() const;
  Expected<void> render(const Camera& camera, const FrameSettings& settings,
                        const ProgressFn& progress);
  Expected<void> follow(const Camera& camera, nlohmann::ordered_json& stats);
  Expected<void> split_bounces(const Camera& camera, nlohmann::ordered_json& stats);
  void paint_by_reference(const Camera& camera, nlohmann::ordered_json& stats);

  const RenderOptions& options_;
  const World& world_;
  glm::ivec2 size_;
  ProgressFn progress_;
  std::vector<Bounds> path_boxes_;
  std::optional<IrradianceField> field_;         // set with the first picture
  std::optional<IrradianceField> first_bounce_;  // subtracted from field_, for the method rsm+field
  std::optional<Renderer> renderer_;             // refers to both
  RenderedFrame frame_;
  float unlit_radiance_ = 1.0f;
  std::uint32_t painted_ = 0;  // frames
};

}  // namespace lambent::cli
