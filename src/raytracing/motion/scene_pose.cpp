// SPDX-License-Identifier: Apache-2.0
#include "raytracing/motion/scene_pose.h"

#include <optional>
#include <unordered_map>

#include "raytracing/raytracer.h"

namespace lambent {
namespace {

using Shape = ScenePose::Shape;
using Positions = std::shared_ptr<const std::vector<glm::vec3>>;

bool same_data(const Shape& a, const Shape& b) {
  return a.revision == b.revision && a.vertices == b.vertices && a.triangles == b.triangles;
}

Shape shape_of(const Mesh& mesh) {
  return {mesh.revision, mesh.positions.size(), mesh.triangles.size(), nullptr};
}

Positions copy_of(const Mesh& mesh) {
  return std::make_shared<const std::vector<glm::vec3>>(mesh.positions);
}

/// By mesh: 1 where an animation deforms it.
std::vector<std::uint8_t> animated_meshes(const Scene& scene) {
  std::vector<std::uint8_t> animated(scene.meshes.size(), 0);
  if (scene.animations.empty()) return animated;
  for (const RigMesh& mesh : scene.rig.meshes) animated[mesh.mesh] = 1;
  return animated;
}

/// A mesh's positions in an earlier pose; none where they are unknown, or their number differed.
std::optional<Positions> positions_before(const ScenePose& before, const ScenePose& now,
                                          std::size_t index) {
  if (index >= before.shapes.size()) return std::nullopt;
  const Shape& was = before.shapes[index];
  const Shape& is = now.shapes[index];
  if (same_data(was, is)) return Positions();
  const bool same_counts = was.vertices == is.vertices && was.triangles == is.triangles;
  if (!same_counts || was.positions == nullptr) return std::nullopt;
  return was.positions;
}

}  // namespace

std::shared_ptr<const ScenePose> first_pose(const Scene& scene) {
  auto pose = std::make_shared<ScenePose>();
  for (const Instance& instance : scene.instances) {
    pose->placements.push_back({pose->identities++, instance.world_from_object});
  }
  const std::vector<std::uint8_t> animated = animated_meshes(scene);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    pose->shapes.push_back(shape_of(scene.meshes[i]));
    if (animated[i] != 0) pose->shapes.back().positions = copy_of(scene.meshes[i]);
  }
  return pose;
}

std::shared_ptr<const ScenePose> next_pose(const Scene& scene, const GeometryEdits& edits,
                                           const ScenePose& before) {
  auto pose = std::make_shared<ScenePose>();
  pose->identities = before.identities;
  pose->placements.reserve(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const std::int32_t then = edits.previous[i];
    const std::uint64_t identity =
        then == GeometryEdits::kNew ? pose->identities++ : before.placements[then].identity;
    pose->placements.push_back({identity, scene.instances[i].world_from_object});
  }
  const std::vector<std::uint8_t> animated = animated_meshes(scene);
  pose->shapes.reserve(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    Shape shape = shape_of(mesh);
    const Shape* was = i < before.shapes.size() ? &before.shapes[i] : nullptr;
    if (was != nullptr && same_data(*was, shape)) {
      shape.positions = was->positions;
    } else if (was != nullptr || animated[i] != 0) {
      // A mesh that was deformed once is likely to be deformed again
      shape.positions = copy_of(mesh);
    }
    pose->shapes.push_back(std::move(shape));
  }
  return pose;
}

std::vector<InstanceBefore> instances_before(const ScenePose& before, const ScenePose& now,
                                             const Scene& scene) {
  std::vector<std::optional<Positions>> of_mesh(now.shapes.size());
  for (std::size_t i = 0; i < now.shapes.size(); ++i) {
    of_mesh[i] = positions_before(before, now, i);
  }
  std::unordered_map<std::uint64_t, std::size_t> places;  // indices in `before`, if any differ
  std::vector<InstanceBefore> result(now.placements.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::uint64_t identity = now.placements[i].identity;
    std::size_t then = i;
    if (i >= before.placements.size() || before.placements[i].identity != identity) {
      if (places.empty()) {
        for (std::size_t k = 0; k < before.placements.size(); ++k) {
          places.emplace(before.placements[k].identity, k);
        }
      }
      const auto found = places.find(identity);
      if (found == places.end()) continue;
      then = found->second;
    }
    const std::optional<Positions>& positions = of_mesh[scene.instances[i].mesh];
    if (!positions) continue;
    result[i] = {before.placements[then].world_from_object, *positions, true};
  }
  return result;
}

}  // namespace lambent
