// SPDX-License-Identifier: Apache-2.0
#include "raytracing/scene_snapshot.h"

#include <algorithm>
#include <bit>
#include <string>
#include <unordered_map>

#include "scene/animation/pose.h"
#include "scene/attributes.h"
#include "scene/texture.h"
#include "scene/validate.h"

namespace lambent {
namespace {

using Placement = SceneSnapshot::Placement;
using Shape = SceneSnapshot::Shape;

bool same_data(const Shape& shape, const Mesh& mesh) {
  return shape.revision == mesh.revision && shape.vertices == mesh.positions.size() &&
         shape.triangles == mesh.triangles.size();
}

SceneSnapshot::Sky sky_of(const Environment& e) {
  return {e.radiance,  e.rotation,   e.revision,
          e.map.width, e.map.height, e.map.empty() ? nullptr : e.map.pixels.data()};
}

Placement placement_of(const Scene& scene, const Instance& instance) {
  return {instance.mesh, instance.world_from_object, instance.receives_gi, instance.dynamic,
          instance_mask(scene, instance)};
}

std::size_t hash_of(const Placement& placement) {
  std::size_t hash = static_cast<std::size_t>(placement.mesh) * 2 + placement.receives_gi;
  for (int i = 0; i < 16; ++i) {
    // Combine with a multiplier of Knuth's, as each number of the transform must count
    const float value = placement.world_from_object[i / 4][i % 4] + 0.0f;
    hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15ull;
    hash ^= hash >> 29;
  }
  return hash;
}

bool uses_texture(const Material& m, const std::vector<std::uint8_t>& edited) {
  for (const TextureView* view : texture_views(m)) {
    if (view->texture >= 0 && edited[view->texture] != 0) return true;
  }
  return false;
}

/// Whether the materials stop different rays or transmit different light.
bool coverage_differs(const Material& a, const Material& b, bool texture_edited) {
  if (a.alpha_mode != b.alpha_mode) return true;
  if (is_transmissive(a) || is_transmissive(b)) return true;
  if (a.alpha_mode == AlphaMode::opaque) return false;
  return texture_edited || a.base_color.a != b.base_color.a || a.alpha_cutoff != b.alpha_cutoff ||
         a.base_color_texture != b.base_color_texture;
}

bool opaque(const SceneSnapshot& snapshot, int material) {
  return stops_all_rays(snapshot.materials[material]);
}

class Comparison {
 public:
  Comparison(const SceneSnapshot& before, const SceneSnapshot& after)
      : before_(before), after_(after) {}

  SceneEdits run() {
    compare_materials();
    compare_shapes();
    match_instances();
    compare_instances();
    compare_lights();
    edits_.changes.environment = before_.sky != after_.sky;
    edits_.emitters_differ = edits_.emitters_differ || edits_.changes.emission;
    return std::move(edits_);
  }

 private:
  void compare_materials() {
    std::vector<std::uint8_t> edited(after_.textures.size(), 0);
    for (std::size_t i = 0; i < edited.size(); ++i) {
      edited[i] = i >= before_.textures.size() || before_.textures[i] != after_.textures[i];
    }
    see_through_.assign(after_.materials.size(), 0);
    for (std::size_t i = 0; i < after_.materials.size(); ++i) {
      const Material& now = after_.materials[i];
      const bool texture_edited = uses_texture(now, edited);
      if (i < before_.materials.size() && before_.materials[i] == now && !texture_edited) continue;
      edits_.changes.materials.push_back(static_cast<int>(i));
      if (i >= before_.materials.size()) continue;
      see_through_[i] = coverage_differs(before_.materials[i], now, texture_edited);
      if (may_emit(before_.materials[i]) || may_emit(now)) edits_.changes.emission = true;
    }
  }

  void compare_shapes() {
    bent_.assign(after_.shapes.size(), 0);
    for (std::uint32_t i = 0; i < std::min(before_.shapes.size(), after_.shapes.size()); ++i) {
      const Shape& was = before_.shapes[i];
      const Shape& is = after_.shapes[i];
      const bool data = was.revision != is.revision || was.vertices != is.vertices ||
                        was.triangles != is.triangles;
      const bool material = was.material != is.material;
      if (!data && !material && see_through_[is.material] == 0) continue;
      bent_[i] = 1;
      const bool filter = opaque(before_, was.material) != opaque(after_, is.material);
      const bool counts = was.vertices != is.vertices || was.triangles != is.triangles;
      if (counts || filter) {
        edits_.geometry.remade.push_back(i);
      } else if (data) {
        edits_.geometry.deformed.push_back(i);
      }
    }
    edits_.geometry_differs = !edits_.geometry.remade.empty() || !edits_.geometry.deformed.empty();
  }

  /// Finds the previous index of each instance: that of an equal instance, perhaps at another place
  /// in the list; else that of one with the same mesh, which has then moved.
  void match_instances() {
    const std::vector<Placement>& was = before_.placements;
    const std::vector<Placement>& is = after_.placements;
    std::vector<std::int32_t>& previous = edits_.geometry.previous;
    previous.assign(is.size(), GeometryEdits::kNew);
    std::vector<std::uint8_t> taken(was.size(), 0);
    const auto match = [&](std::size_t now, std::size_t then) {
      previous[now] = static_cast<std::int32_t>(then);
      taken[then] = 1;
    };
    const std::size_t common = std::min(was.size(), is.size());
    const bool same_length = was.size() == is.size();
    for (std::size_t i = 0; i < common; ++i) {
      // In lists of the same length, instances of one mesh at the same index count as the same
      if (was[i] == is[i] || (same_length && was[i].mesh == is[i].mesh)) match(i, i);
    }
    std::unordered_multimap<std::size_t, std::size_t> same;
    std::unordered_map<int, std::vector<std::size_t>> of_mesh;
    for (std::size_t i = 0; i < was.size(); ++i) {
      if (taken[i] == 0) same.emplace(hash_of(was[i]), i);
    }
    for (std::size_t i = 0; i < is.size() && !same.empty(); ++i) {
      if (previous[i] != GeometryEdits::kNew) continue;
      auto [found, end] = same.equal_range(hash_of(is[i]));
      while (found != end && !(was[found->second] == is[i])) ++found;
      if (found == end) continue;
      match(i, found->second);
      same.erase(found);
    }
    for (std::size_t i = was.size(); i-- > 0;) {
      if (taken[i] == 0) of_mesh[was[i].mesh].push_back(i);
    }
    for (std::size_t i = 0; i < is.size() && !of_mesh.empty(); ++i) {
      if (previous[i] != GeometryEdits::kNew) continue;
      const auto found = of_mesh.find(is[i].mesh);
      if (found == of_mesh.end() || found->second.empty()) continue;
      match(i, found->second.back());
      found->second.pop_back();
    }
    for (std::size_t i = 0; i < was.size(); ++i) {
      if (taken[i] != 0) continue;
      edits_.geometry_differs = true;
      add_box(before_, was[i]);
    }
  }

  void compare_instances() {
    GeometryEdits& geometry = edits_.geometry;
    for (std::uint32_t i = 0; i < after_.placements.size(); ++i) {
      const Placement& is = after_.placements[i];
      if (geometry.previous[i] == GeometryEdits::kNew) {
        edits_.geometry_differs = true;
        add_box(after_, is);
        continue;
      }
      const auto then = static_cast<std::uint32_t>(geometry.previous[i]);
      const Placement& was = before_.placements[then];
      if (then != i) {
        edits_.geometry_differs = true;
        // Tables of emitters refer to instances by index
        if (emits(after_, is)) edits_.emitters_differ = true;
      }
      const bool moved = was.world_from_object != is.world_from_object;
      const bool masked = was.mask != is.mask;
      if (moved) geometry.moved.push_back(i);
      if (masked) geometry.masked.push_back(i);
      if (moved || masked) edits_.geometry_differs = true;
      const bool differs = moved || masked || was.receives_gi != is.receives_gi;
      if (!differs && bent_[is.mesh] == 0) continue;
      add_box(before_, was);
      add_box(after_, is);
    }
  }

  /// Pairs lights by index, counted from the end for those after an insertion or removal.
  void compare_lights() {
    const std::vector<Light>& was = before_.lights;
    const std::vector<Light>& is = after_.lights;
    std::size_t first = 0, was_end = was.size(), is_end = is.size();
    while (first < std::min(was_end, is_end) && was[first] == is[first]) ++first;
    while (was_end > first && is_end > first && was[was_end - 1] == is[is_end - 1]) {
      --was_end;
      --is_end;
    }
    for (std::size_t i = first; i < std::max(was_end, is_end); ++i) {
      WorldChanges::LightChange change;
      if (i < was_end) change.before = was[i];
      if (i < is_end) change.after = is[i];
      if (change.before != change.after) edits_.changes.lights.push_back(std::move(change));
    }
  }

  static bool emits(const SceneSnapshot& snapshot, const Placement& placement) {
    return may_emit(snapshot.materials[snapshot.shapes[placement.mesh].material]);
  }

  void add_box(const SceneSnapshot& snapshot, const Placement& placement) {
    if (emits(snapshot, placement)) edits_.changes.emission = true;
    const Bounds box = world_box(snapshot, placement);
    std::vector<Bounds>& moved = edits_.changes.moved;
    if (!box.empty() && (moved.empty() || moved.back() != box)) moved.push_back(box);
    if (!box.empty() && !placement.dynamic) edits_.changes.rebuilt.push_back(box);
  }

  const SceneSnapshot& before_;
  const SceneSnapshot& after_;
  SceneEdits edits_;
  std::vector<std::uint8_t> see_through_;  // by material: stops other rays than before
  std::vector<std::uint8_t> bent_;         // by mesh: its look or the rays it stops differ
};

std::string place(const char* list, std::size_t index) {
  return std::string(list) + "[" + std::to_string(index) + "]";
}

/// Whether instances that moved, and those of deformed meshes, are within the permitted range.
Expected<void> check_reach(const Scene& scene, const SceneSnapshot& before) {
  std::vector<Bounds> bounds(scene.meshes.size());
  std::vector<std::uint8_t> bent(scene.meshes.size(), 0);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    bent[i] = i >= before.shapes.size() || !same_data(before.shapes[i], scene.meshes[i]);
    bounds[i] = bent[i] != 0 ? mesh_bounds(scene.meshes[i]) : before.shapes[i].bounds;
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const bool still = bent[instance.mesh] == 0 && i < before.placements.size() &&
                       before.placements[i] == placement_of(scene, instance);
    const char* flaw = still ? nullptr : flaw_of_reach(instance, bounds[instance.mesh]);
    if (flaw != nullptr) return fail(scene.source.path, place("instances", i), flaw);
  }
  return {};
}

}  // namespace

Bounds world_box(const SceneSnapshot& snapshot, const SceneSnapshot::Placement& placement) {
  const Bounds& box = snapshot.shapes[placement.mesh].bounds;
  Bounds result;
  if (box.empty()) return result;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p((corner & 1) != 0 ? box.max.x : box.min.x,
                      (corner & 2) != 0 ? box.max.y : box.min.y,
                      (corner & 4) != 0 ? box.max.z : box.min.z);
    result.add(glm::vec3(placement.world_from_object * glm::vec4(p, 1.0f)));
  }
  return result;
}

SceneSnapshot take_snapshot(const Scene& scene, const SceneSnapshot* before) {
  SceneSnapshot snapshot;
  snapshot.placements.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    snapshot.placements.push_back(placement_of(scene, instance));
  }
  snapshot.shapes.reserve(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    Shape shape{mesh.revision, mesh.positions.size(), mesh.triangles.size(), mesh.material, {}};
    if (before != nullptr && i < before->shapes.size() && same_data(before->shapes[i], mesh)) {
      shape.bounds = before->shapes[i].bounds;
    } else {
      shape.bounds = mesh_bounds(mesh);
    }
    snapshot.shapes.push_back(shape);
  }
  for (const Texture& texture : scene.textures) snapshot.textures.push_back(texture.revision);
  snapshot.materials = scene.materials;
  snapshot.lights = scene.lights;
  snapshot.sky = sky_of(scene.environment);
  return snapshot;
}

SceneEdits compare(const SceneSnapshot& before, const SceneSnapshot& after) {
  return Comparison(before, after).run();
}

Expected<void> validate_edits(const Scene& scene, const SceneSnapshot& before) {
  const std::string& file = scene.source.path;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& texture = scene.textures[i];
    if (i < before.textures.size() && before.textures[i] == texture.revision) continue;
    if (const char* flaw = flaw_of(texture)) return fail(file, place("textures", i), flaw);
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const char* flaw = flaw_of(scene.materials[i], scene.textures.size());
    if (flaw != nullptr) return fail(file, place("materials", i), flaw);
  }
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const auto material = static_cast<std::size_t>(mesh.material);
    const bool known = i < before.shapes.size() && same_data(before.shapes[i], mesh);
    if (known && mesh.material >= 0 && material < scene.materials.size()) continue;
    const char* flaw = flaw_of(mesh, scene.materials.size());
    if (flaw != nullptr) return fail(file, place("meshes", i), flaw);
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const bool known = i < before.placements.size() && instance.mesh >= 0 &&
                       static_cast<std::size_t>(instance.mesh) < scene.meshes.size() &&
                       before.placements[i] == placement_of(scene, instance);
    if (known) continue;
    const char* flaw = flaw_of(instance, scene.meshes.size());
    if (flaw != nullptr) return fail(file, place("instances", i), flaw);
  }
  if (const Expected<void> reach = check_reach(scene, before); !reach) return reach;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (const char* flaw = flaw_of(scene.lights[i])) return fail(file, place("lights", i), flaw);
  }
  if (before.sky == sky_of(scene.environment)) return {};
  if (const char* flaw = flaw_of(scene.environment)) return fail(file, "environment", flaw);
  return {};
}

}  // namespace lambent
