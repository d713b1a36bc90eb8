// SPDX-License-Identifier: Apache-2.0
// Common parts of the measurements of pictures in motion: sequences of frames, their references,
// and the differences.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/scene.h"
#include "lambent/world.h"

namespace lambent::motion {

inline constexpr int kWidth = 160, kHeight = 90;
inline constexpr int kFrames = 32;

/// A lit scene that can be edited.
struct Subject {
  explicit Subject(const std::string& name);
  /// Updates world and field after edits of the scene.
  void apply_edits();

  Scene scene;
  World world;
  IrradianceField field;
  Camera camera;  ///< The scene's first; for files, one that shows the scene.
};

/// Returns the camera of a frame, and may edit the scene.
using Step = std::function<Camera(int frame, Subject& subject)>;

/// Errors of a frame, relative to the mean of many samples of the same light.
struct FrameError {
  double per_pixel = 0.0, blocks = 0.0;  ///< Relative RMSE, of pixels and of 8x8 means.
  double flip = 0.0;
  double mean_ratio = 0.0;
};
FrameError error_of(const Image& picture, const Image& truth);
FrameError mean_of(const std::vector<FrameError>& errors);

/// The reference: a frame with many samples.
Image truth_of(const Subject& subject, const Camera& camera);

/// Settings of the frame with this number, with one sample per pixel.
FrameSettings settings_of(int frame, bool antialiased);

/// The rows, each a function that prints a table. If LAMBENT_PICTURES names a folder, the frames
/// are written there, too.
void measure_walk();    ///< A walk and a turn, compared to a camera at rest.
void measure_still();   ///< Flicker where nothing moves.
void measure_ghosts();  ///< Ghosts of objects that moved and lights that went out.

/// Writes a frame as a .png if LAMBENT_PICTURES names a folder.
void keep_picture(const Image& picture, const std::string& name, int frame);

}  // namespace lambent::motion
