// SPDX-License-Identifier: Apache-2.0
// A scene in which everything moves that can: an instance that turns and travels, a mesh that its
// joints bend, one that morphs, and a pane that is seen through.
#pragma once

#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "lambent/scene.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::test {

/// Instances of moving_scene, and their meshes.
enum class Mover : int { floor = 0, turning = 1, skinned = 2, morphing = 3, pane = 4 };

/// A channel of two keys, at 0 s and 1 s.
inline Channel channel(Channel::Target target, int index, int components,
                       std::vector<float> values) {
  Channel made;
  made.target = target;
  made.index = index;
  made.curve.components = components;
  made.curve.times = {0.0f, 1.0f};
  made.curve.values = std::move(values);
  return made;
}

/// All sizes and ways in units of `size` [m]. The movers stand side by side along x, between -3 and
/// 3, on a floor; the pane stands between them and a viewer on the side of +z.
inline Scene moving_scene(float size) {
  using Target = Channel::Target;
  const auto box = [size](const glm::vec3& low, const glm::vec3& high) {
    return box_mesh(size * low, size * high);
  };
  const float reach = 6.0f * size;
  Scene scene = scene_of(
      {quad({-reach, 0.0f, reach}, {2.0f * reach, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f * reach}, 0),
       box({-0.5f, 0.0f, -0.5f}, {0.5f, 1.5f, 0.5f}), box({-0.4f, 0.0f, -0.4f}, {0.4f, 2.0f, 0.4f}),
       box({2.0f, 0.0f, -0.5f}, {3.0f, 1.0f, 0.5f}),
       quad({-size, 0.5f * size, 1.5f * size}, {2.0f * size, 0.0f, 0.0f}, {0.0f, 0.6f * size, 0.0f},
            1)});
  Material glass = scene.materials[0];
  glass.alpha_mode = AlphaMode::blend;
  glass.base_color.a = 0.5f;
  scene.materials.push_back(glass);
  scene.environment.radiance = glm::vec3(1.0f);

  // Nodes: 0 the turning box, 1 and 2 the joints, 3 what morphs, 4 the pane
  Rig& rig = scene.rig;
  rig.nodes.resize(5);
  rig.nodes[0].translation = size * glm::vec3(-2.0f, 0.0f, 0.0f);
  rig.nodes[2].parent = 1;
  rig.nodes[2].translation = size * glm::vec3(0.0f, 1.0f, 0.0f);
  rig.nodes[3].weights = {0.0f};
  rig.instances = {{static_cast<int>(Mover::turning), 0, glm::mat4(1.0f)},
                   {static_cast<int>(Mover::pane), 4, glm::mat4(1.0f)}};

  RigMesh skinned;
  skinned.mesh = static_cast<int>(Mover::skinned);
  skinned.skin = 0;
  skinned.positions = scene.meshes[skinned.mesh].positions;
  skinned.normals = scene.meshes[skinned.mesh].normals;
  skinned.influences = 2;
  for (const glm::vec3& position : skinned.positions) {
    const float upper = position.y > 0.0f ? 0.8f : 0.1f;
    skinned.joints.insert(skinned.joints.end(), {0u, 1u});
    skinned.weights.insert(skinned.weights.end(), {1.0f - upper, upper});
  }
  rig.skins.push_back(
      {{1, 2}, {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0.0f, -size, 0.0f})}});

  RigMesh morphing;
  morphing.mesh = static_cast<int>(Mover::morphing);
  morphing.node = 3;
  morphing.positions = scene.meshes[morphing.mesh].positions;
  morphing.normals = scene.meshes[morphing.mesh].normals;
  morphing.targets.resize(1);
  for (const glm::vec3& position : morphing.positions) {
    const bool top = position.y > 0.0f;
    morphing.targets[0].positions.push_back(top ? size * glm::vec3(-0.6f, 0.8f, 0.4f)
                                                : glm::vec3(0.0f));
  }
  rig.meshes = {skinned, morphing};

  Animation moves;
  moves.channels = {
      channel(Target::node_rotation, 0, 4, {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.6f, 0.0f, 0.8f}),
      channel(Target::node_translation, 0, 3,
              {-2.0f * size, 0.0f, 0.0f, -1.6f * size, 0.3f * size, 0.4f * size}),
      channel(Target::node_rotation, 2, 4, {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.38f, 0.925f}),
      channel(Target::node_weights, 3, 1, {0.0f, 1.0f}),
      channel(Target::node_translation, 4, 3, {0.0f, 0.0f, 0.0f, size, 0.0f, 0.0f})};
  scene.animations.push_back(std::move(moves));
  return scene;
}

}  // namespace lambent::test
