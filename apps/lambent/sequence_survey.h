// SPDX-License-Identifier: Apache-2.0
// What must be known of a whole sequence before its first frame is rendered.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "lambent/error.h"
#include "lambent/first_picture.h"
#include "lambent/interrupts.h"
#include "lambent/render_options.h"
#include "lambent/scene.h"
#include "lambent/scene_options.h"
#include "lambent/world.h"

namespace lambent::cli {

/// A scene that an animation poses for each frame of a sequence.
struct PosedScene {
  Scene& scene;
  World& world;    ///< Of `scene`.
  int animation;   ///< Index into Scene::animations; -1: all of them play at once.
  bool first_sky;  ///< The sky is in proportion to the scene's suns, see adjust_first_sky().
};

/// The time of a frame [s]; between frames, too.
double time_of_frame(const RenderOptions& options, double frame);

/// Poses a scene and updates its world.
Expected<WorldChanges> pose_at(const PosedScene& posed, double time_s);

/// A few poses of a sequence, the first frame's first. They refer to both arguments.
Poses poses_of_sequence(const RenderOptions& options, const PosedScene& posed);

/// The view of a pose: a camera of the scene follows the animation; any other does not move, nor
/// does any where nothing is animated.
Expected<Camera> camera_of_pose(const RenderOptions& options, const View& first,
                                const Scene& scene);

/// The light for a sequence without a sky of its own: that of its first frame's `view`, or a sky
/// where one of a few later frames needs it, such as one in which a door is open. The scene is in
/// the first frame's pose, and stays.
Expected<FirstLight> choose_light_of_sequence(const RenderOptions& options, const PosedScene& posed,
                                              const View& view);

struct SequenceSurvey {
  /// The near_box() of places along the camera's path, in order; empty where it does not move, and
  /// where the field needs no finer volumes.
  std::vector<Bounds> path_boxes;
  /// An exposure for all frames [stops], where the options leave it to the program and the first
  /// frame's does not suit the rest: the median of those that suit single frames.
  std::optional<float> stops;
};

/// Looks at a few frames of a sequence; path-traces small pictures of them where the exposure is to
/// be found. `size`: of the frames [pixels]. `view` is that of the first frame, in whose pose the
/// scene is, and stays. An interrupt ends it early.
Expected<SequenceSurvey> survey_sequence(const RenderOptions& options, const PosedScene& posed,
                                         const View& view, const glm::ivec2& size,
                                         const InterruptGuard& guard);

}  // namespace lambent::cli
