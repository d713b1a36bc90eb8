// SPDX-License-Identifier: Apache-2.0
// What the measurements of pictures in motion share: sequences of frames beside what each should
// show, and how far the two are apart.
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

/// A scene that is lit, and may be edited.
struct Subject {
  explicit Subject(const std::string& name);
  /// The scene as it is; field and world follow.
  void apply_edits();

  Scene scene;
  World world;
  IrradianceField field;
  Camera camera;  ///< The scene's first; of files, one that shows the scene.
};

/// A frame of a sequence: puts the camera, and may edit the scene.
using Step = std::function<Camera(int frame, Subject& subject)>;

/// Errors of a frame against the mean of many samples of the same light.
struct FrameError {
  double per_pixel = 0.0, blocks = 0.0;  ///< Relative RMSE, of pixels and of 8x8 means.
  double flip = 0.0;
  double mean_ratio = 0.0;
};
FrameError error_of(const Image& picture, const Image& truth);
FrameError mean_of(const std::vector<FrameError>& errors);

/// The picture that one frame of many samples shows.
Image truth_of(const Subject& subject, const Camera& camera);

/// Settings of the frame with this number, one sample a pixel.
FrameSettings settings_of(int frame, bool antialiased);

/// The rows, each a function that prints a table. Where LAMBENT_PICTURES names a folder, the frames
/// are written there as well.
void measure_walk();    ///< A walk and a turn against the camera at rest.
void measure_still();   ///< What flickers where nothing moves.
void measure_ghosts();  ///< What is left behind of what moved or went out.

/// Writes a frame as a .png, where LAMBENT_PICTURES names a folder.
void keep_picture(const Image& picture, const std::string& name, int frame);

}  // namespace lambent::motion
