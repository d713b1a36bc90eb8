// SPDX-License-Identifier: Apache-2.0
// The motion of a scene: lambent::Scene is its state at one moment, and tracks describe how its
// nodes move.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

namespace lambent::scenes {

/// The transform of a node at a time. Between keyframes, positions are interpolated linearly and
/// rotations spherically. Nodes that move have no scale.
struct Keyframe {
  float time = 0.0f;                           ///< [s], ascending within a track.
  glm::vec3 translation{0.0f};                 ///< [m].
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< Unit; (w, x, y, z).
};

/// The motion of one instance or light. A light's direction is its node's -Z.
struct Track {
  enum class Target { instance, light };
  Target target = Target::instance;
  int index = 0;                    ///< Into Scene::instances or Scene::lights.
  std::vector<Keyframe> keyframes;  ///< Never empty; the first agrees with the scene's rest pose.
};

struct Animation {
  std::string name;
  std::vector<Track> tracks;
};

using Animations = std::vector<Animation>;

}  // namespace lambent::scenes
