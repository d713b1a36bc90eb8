// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.h"

#include <cmath>
#include <string>

#include "shared/constants.h"

namespace lambent {
namespace {

// Deviation from 1 up to which a stored direction counts as unit length: several steps of float
// noise and of hand-written constants, far below what shading could show.
constexpr float kUnitTolerance = 1e-3f;

bool finite(float v) {
  return std::isfinite(v);
}
bool finite(const glm::vec2& v) {
  return finite(v.x) && finite(v.y);
}
bool finite(const glm::vec3& v) {
  return finite(v.x) && finite(v.y) && finite(v.z);
}
bool finite(const glm::vec4& v) {
  return finite(glm::vec3(v)) && finite(v.w);
}
bool finite(const glm::mat4& m) {
  return finite(m[0]) && finite(m[1]) && finite(m[2]) && finite(m[3]);
}
bool unit(const glm::vec3& v) {
  return finite(v) && std::abs(glm::length(v) - 1.0f) <= kUnitTolerance;
}
bool non_negative(const glm::vec3& v) {
  return finite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}
bool in_unit_range(float v) {
  return v >= 0.0f && v <= 1.0f;
}
bool affine(const glm::mat4& m) {
  return finite(m) && m[0].w == 0.0f && m[1].w == 0.0f && m[2].w == 0.0f && m[3].w == 1.0f;
}

std::string entry(const char* array, std::size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

template <class T, class Check>
bool all_of(const std::vector<T>& values, Check check) {
  for (const T& value : values) {
    if (!check(value)) return false;
  }
  return true;
}

const char* flaw_of(const TextureView& view, std::size_t textures) {
  if (view.texture < -1) return "refers to a texture by a negative index";
  if (view.texture >= 0 && static_cast<std::size_t>(view.texture) >= textures) {
    return "refers to a texture that does not exist";
  }
  if (view.uv_set != 0 && view.uv_set != 1) return "uses texture coordinates other than 0 or 1";
  if (!finite(view.uv_offset) || !finite(view.uv_scale) || !finite(view.uv_rotation)) {
    return "transforms texture coordinates by numbers that are not finite";
  }
  return nullptr;
}

}  // namespace

const char* flaw_of(const Texture& texture) {
  if (texture.levels.empty()) return "has no levels";
  int width = texture.levels[0].width;
  int height = texture.levels[0].height;
  for (const TextureLevel& level : texture.levels) {
    if (level.width < 1 || level.height < 1) return "has a level without pixels";
    if (level.width != width || level.height != height) return "has a level of the wrong size";
    if (level.rgba.size() != static_cast<std::size_t>(width) * height * 4) {
      return "has a level whose pixels do not fill its size";
    }
    width = width > 1 ? width / 2 : 1;
    height = height > 1 ? height / 2 : 1;
  }
  const TextureLevel& last = texture.levels.back();
  return last.width == 1 && last.height == 1 ? nullptr : "lacks MIP levels down to 1x1";
}

const char* flaw_of(const Material& m, std::size_t textures) {
  for (int k = 0; k < 4; ++k) {
    if (!in_unit_range(m.base_color[k])) return "base_color is not within 0 to 1";
  }
  if (!in_unit_range(m.metallic)) return "metallic is not within 0 to 1";
  if (!in_unit_range(m.roughness)) return "roughness is not within 0 to 1";
  if (!non_negative(m.emission)) return "emission is negative or not finite";
  if (!finite(m.normal_scale)) return "normal_scale is not finite";
  if (!finite(m.ior) || m.ior < 1.0f) return "ior is not a number of 1 or more";
  if (!in_unit_range(m.specular)) return "specular is not within 0 to 1";
  if (!non_negative(m.specular_color)) return "specular_color is negative or not finite";
  if (!finite(m.alpha_cutoff)) return "alpha_cutoff is not finite";
  for (const TextureView* view :
       {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
        &m.emission_texture, &m.specular_texture, &m.specular_color_texture}) {
    if (const char* flaw = flaw_of(*view, textures)) return flaw;
  }
  return nullptr;
}

const char* flaw_of(const Mesh& mesh, std::size_t materials) {
  const std::size_t vertices = mesh.positions.size();
  const auto fits = [vertices](std::size_t size) { return size == 0 || size == vertices; };
  if (mesh.material < 0 || static_cast<std::size_t>(mesh.material) >= materials) {
    return "refers to a material that does not exist";
  }
  if (mesh.normals.size() != vertices) return "has not one normal a vertex";
  if (!fits(mesh.tangents.size())) return "has not one tangent a vertex";
  if (!fits(mesh.uvs[0].size()) || !fits(mesh.uvs[1].size())) {
    return "has not one texture coordinate a vertex";
  }
  if (!fits(mesh.colors.size())) return "has not one color a vertex";
  if (!all_of(mesh.positions, [](const glm::vec3& p) { return finite(p); })) {
    return "has a position that is not finite";
  }
  if (!all_of(mesh.normals, unit)) return "has a normal that is not of unit length";
  if (!all_of(mesh.tangents, [](const glm::vec4& t) {
        return unit(glm::vec3(t)) && (t.w == 1.0f || t.w == -1.0f);
      })) {
    return "has a tangent that is not of unit length with w = +1 or -1";
  }
  for (const auto& uvs : mesh.uvs) {
    if (!all_of(uvs, [](const glm::vec2& uv) { return finite(uv); })) {
      return "has a texture coordinate that is not finite";
    }
  }
  if (!all_of(mesh.colors, [](const glm::vec4& c) { return finite(c); })) {
    return "has a color that is not finite";
  }
  if (!all_of(mesh.triangles, [vertices](const glm::uvec3& t) {
        return t.x < vertices && t.y < vertices && t.z < vertices;
      })) {
    return "has a triangle with a vertex index out of range";
  }
  return nullptr;
}

const char* flaw_of(const Instance& instance, std::size_t meshes) {
  if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= meshes) {
    return "refers to a mesh that does not exist";
  }
  if (!affine(instance.world_from_object)) return "has a transform that is not finite and affine";
  if (!finite(glm::inverse(instance.world_from_object))) return "has a transform without inverse";
  return nullptr;
}

const char* flaw_of(const Light& light) {
  if (!non_negative(light.intensity)) return "has an intensity that is negative or not finite";
  if (!finite(light.position_ws)) return "has a position that is not finite";
  if (light.type != Light::Type::point && !unit(light.direction_ws)) {
    return "has a direction that is not of unit length";
  }
  if (!finite(light.range) || light.range < 0.0f) return "has a range that is negative";
  if (light.type == Light::Type::spot) {
    const bool ordered = light.inner_cone_angle >= 0.0f &&
                         light.inner_cone_angle <= light.outer_cone_angle &&
                         light.outer_cone_angle <= 0.5f * kPi + kUnitTolerance;
    if (!ordered) return "has cone angles that are not 0 <= inner <= outer <= pi/2";
  }
  return nullptr;
}

const char* flaw_of(const Camera& camera) {
  const glm::mat4& m = camera.world_from_view;
  if (!affine(m)) return "has a transform that is not finite and affine";
  if (!unit(glm::vec3(m[0])) || !unit(glm::vec3(m[1])) || !unit(glm::vec3(m[2]))) {
    return "has a transform with scale";
  }
  if (!finite(camera.aspect) || camera.aspect < 0.0f)
    return "has an aspect ratio that is negative or not finite";
  if (camera.orthographic) {
    return finite(camera.vertical_extent) && camera.vertical_extent > 0.0f
               ? nullptr
               : "has an extent that is not positive";
  }
  if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < kPi)) {
    return "has a field of view that is not between 0 and pi";
  }
  return nullptr;
}

const char* flaw_of(const Environment& environment) {
  if (!non_negative(environment.radiance)) return "radiance is negative or not finite";
  if (!finite(environment.rotation)) return "rotation is not finite";
  const Image& map = environment.map;
  if (map.empty()) return nullptr;
  if (map.channels != 3) return "map has not 3 channels";
  if (map.width < 1 || map.height < 1 ||
      map.pixels.size() != static_cast<std::size_t>(map.width) * map.height * 3) {
    return "map's pixels do not fill its size";
  }
  return all_of(map.pixels, [](float v) { return finite(v) && v >= 0.0f; })
             ? nullptr
             : "map has a pixel that is negative or not finite";
}

namespace {

// The first flaw of an array's entries, with its place.
template <class T, class... Counts>
Expected<void> check_array(const Scene& scene, const char* name, const std::vector<T>& entries,
                           Counts... counts) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (const char* flaw = flaw_of(entries[i], counts...)) {
      return fail(scene.source.path, entry(name, i), flaw);
    }
  }
  return {};
}

}  // namespace

Expected<void> validate(const Scene& scene) {
  const std::size_t textures = scene.textures.size();
  const std::size_t materials = scene.materials.size();
  const std::size_t meshes = scene.meshes.size();
  Expected<void> result = check_array(scene, "textures", scene.textures);
  if (result) result = check_array(scene, "materials", scene.materials, textures);
  if (result) result = check_array(scene, "meshes", scene.meshes, materials);
  if (result) result = check_array(scene, "instances", scene.instances, meshes);
  if (result) result = check_array(scene, "lights", scene.lights);
  if (result) result = check_array(scene, "cameras", scene.cameras);
  if (!result) return result;
  if (const char* flaw = flaw_of(scene.environment)) {
    return fail(scene.source.path, "environment", flaw);
  }
  return validate_motion(scene);
}

}  // namespace lambent
