// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/animation/pose.h"
#include "scene/limits.h"
#include "scene/texture.h"
#include "shared/constants.h"

namespace lambent {
namespace {

// Deviation from 1 up to which a stored direction counts as unit length: above the rounding of
// floats and of hand-written constants, and far below visible differences of shading.
constexpr float kUnitTolerance = 1e-3f;

bool finite(float v) {
  return std::isfinite(v);
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
bool within(const glm::vec3& v, float low, float high) {
  for (int k = 0; k < 3; ++k) {
    if (!(v[k] >= low && v[k] <= high)) return false;
  }
  return true;
}
bool within(const glm::vec2& v, float largest) {
  return std::abs(v.x) <= largest && std::abs(v.y) <= largest;
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
  if (!finite(view.uv_rotation)) return "rotates texture coordinates by no finite number";
  if (!within(view.uv_offset, kMaxTextureCoordinate) ||
      !within(view.uv_scale, kMaxTextureCoordinate)) {
    return "transforms texture coordinates by numbers that are not within -1e8 to 1e8";
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

const char* flaw_of_film(const Material& m) {
  if (!in_unit_range(m.iridescence)) return "iridescence is not within 0 to 1";
  if (!(m.iridescence_ior >= 1.0f && m.iridescence_ior <= kMaxFactor)) {
    return "iridescence_ior is not within 1 to 1e6";
  }
  for (const float thickness : {m.iridescence_thickness_min, m.iridescence_thickness_max}) {
    if (!(thickness >= 0.0f && thickness <= kMaxFactor)) {
      return "an iridescence_thickness is not within 0 to 1e6 nm";
    }
  }
  return nullptr;
}

const char* flaw_of_factors(const Material& m) {
  for (int k = 0; k < 4; ++k) {
    if (!in_unit_range(m.base_color[k])) return "base_color is not within 0 to 1";
  }
  if (!in_unit_range(m.metallic)) return "metallic is not within 0 to 1";
  if (!in_unit_range(m.roughness)) return "roughness is not within 0 to 1";
  if (!within(m.emission, 0.0f, kMaxRadiance)) {
    return "emission is not within 0 to 1e10 W/(m^2 sr)";
  }
  if (!(std::abs(m.normal_scale) <= kMaxFactor)) return "normal_scale is not within -1e6 to 1e6";
  if (!(m.ior >= 1.0f && m.ior <= kMaxFactor)) return "ior is not within 1 to 1e6";
  if (!in_unit_range(m.specular)) return "specular is not within 0 to 1";
  if (!within(m.specular_color, 0.0f, kMaxFactor)) {
    return "specular_color is not within 0 to 1e6";
  }
  if (!in_unit_range(m.transmission)) return "transmission is not within 0 to 1";
  if (!within(m.absorption, 0.0f, kMaxFactor)) return "absorption is not within 0 to 1e6 1/m";
  if (!finite(m.alpha_cutoff)) return "alpha_cutoff is not finite";
  if (!in_unit_range(m.clearcoat)) return "clearcoat is not within 0 to 1";
  if (!in_unit_range(m.clearcoat_roughness)) return "clearcoat_roughness is not within 0 to 1";
  if (!(std::abs(m.clearcoat_normal_scale) <= kMaxFactor)) {
    return "clearcoat_normal_scale is not within -1e6 to 1e6";
  }
  if (!within(m.sheen_color, 0.0f, 1.0f)) return "sheen_color is not within 0 to 1";
  if (!in_unit_range(m.sheen_roughness)) return "sheen_roughness is not within 0 to 1";
  return flaw_of_film(m);
}

const char* flaw_of(const Material& m, std::size_t textures) {
  if (const char* flaw = flaw_of_factors(m)) return flaw;
  for (const TextureView* view : texture_views(m)) {
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
  if (!all_of(mesh.positions, [](const glm::vec3& p) { return is_in_reach(p); })) {
    return "has a position that is not within 1e9 m of the origin";
  }
  if (!all_of(mesh.normals, unit)) return "has a normal that is not of unit length";
  if (!all_of(mesh.tangents, [](const glm::vec4& t) {
        return unit(glm::vec3(t)) && (t.w == 1.0f || t.w == -1.0f);
      })) {
    return "has a tangent that is not of unit length with w = +1 or -1";
  }
  for (const auto& uvs : mesh.uvs) {
    if (!all_of(uvs, [](const glm::vec2& uv) { return within(uv, kMaxTextureCoordinate); })) {
      return "has a texture coordinate that is not within -1e8 to 1e8";
    }
  }
  if (!all_of(mesh.colors, [](const glm::vec4& c) {
        return within(glm::vec3(c), 0.0f, kMaxFactor) && finite(c.w);
      })) {
    return "has a color that is not within 0 to 1e6";
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
  if (largest_scale(instance.world_from_object) > kMaxScale) {
    return "is scaled by more than 1e10";
  }
  if (!finite(glm::inverse(instance.world_from_object))) return "has a transform without inverse";
  return nullptr;
}

const char* flaw_of_reach(const Instance& instance, const Bounds& mesh) {
  return stays_in_reach(instance.world_from_object, mesh)
             ? nullptr
             : "puts its mesh where it is not within 1e9 m of the origin";
}

const char* flaw_of(const Light& light) {
  if (light.type > Light::Type::spot) return "is of an unknown type";
  const bool directional = light.type == Light::Type::directional;
  if (!within(light.intensity, 0.0f, directional ? kMaxIrradiance : kMaxIntensity)) {
    return directional ? "has an irradiance that is not within 0 to 1e10 W/m^2"
                       : "has an intensity that is not within 0 to 1e12 W/sr";
  }
  if (!is_in_reach(light.position_ws)) {
    return "has a position that is not within 1e9 m of the origin";
  }
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
  if (!is_in_reach(glm::vec3(m[3]), kMaxViewpoint)) {
    return "does not stand within 1e12 m of the origin";
  }
  const bool shaped = camera.aspect >= 1.0f / kMaxAspect && camera.aspect <= kMaxAspect;
  if (camera.aspect != 0.0f && !shaped) {
    return "has an aspect ratio that is neither 0 nor within 1:16384 to 16384:1";
  }
  if (camera.orthographic) {
    return camera.vertical_extent >= kMinViewExtent && camera.vertical_extent <= kMaxViewExtent
               ? nullptr
               : "has an extent that is not within 1e-6 to 2e9 m";
  }
  if (!(camera.vertical_fov >= kMinFov && camera.vertical_fov <= kMaxFov)) {
    return "has a field of view that is not within 0.001 to pi - 0.001";
  }
  return nullptr;
}

const char* flaw_of(const FogVolume& fog) {
  if (!is_in_reach(fog.centre)) return "has a centre that is not within 1e9 m of the origin";
  if (!within(fog.size, 0.0f, 2.0f * kMaxCoordinate)) return "has a size not within 0 to 2e9 m";
  for (int axis = 0; axis < 3; ++axis) {
    const float cosine = glm::dot(fog.axes[axis], fog.axes[(axis + 1) % 3]);
    // Written so that NaN fails
    if (!unit(fog.axes[axis]) || !(std::abs(cosine) <= kUnitTolerance)) {
      return "has axes that are not unit and orthogonal";
    }
  }
  if (!(fog.density >= 0.0f && fog.density <= kMaxFogDensity)) {
    return "has a density that is not within 0 to 1e6 1/m";
  }
  if (!within(fog.albedo, 0.0f, 1.0f)) return "has an albedo that is not within 0 to 1";
  if (!(std::abs(fog.anisotropy) <= kMaxFogAnisotropy)) {
    return "has an anisotropy that is not within -0.95 to 0.95";
  }
  const bool falls =
      fog.scale_height >= kMinFogScaleHeight && fog.scale_height <= kMaxFogScaleHeight;
  if (fog.scale_height != 0.0f && !falls) {
    return "has a scale height that is neither 0 nor within 1e-3 to 1e9 m";
  }
  return nullptr;
}

const char* flaw_of(const Environment& environment) {
  if (!within(environment.radiance, 0.0f, kMaxRadiance)) {
    return "radiance is not within 0 to 1e10 W/(m^2 sr)";
  }
  if (!finite(environment.rotation)) return "rotation is not finite";
  const Image& map = environment.map;
  if (map.empty()) return nullptr;
  if (map.channels != 3) return "map has not 3 channels";
  if (map.width < 1 || map.height < 1 ||
      map.pixels.size() != static_cast<std::size_t>(map.width) * map.height * 3) {
    return "map's pixels do not fill its size";
  }
  const float factor =
      std::max({1.0f, environment.radiance.r, environment.radiance.g, environment.radiance.b});
  return all_of(map.pixels, [factor](float v) { return v >= 0.0f && v * factor <= kMaxRadiance; })
             ? nullptr
             : "map has a pixel that is not within 0 to 1e10 W/(m^2 sr)";
}

const char* flaw_of(const ProbeVolume& volume) {
  if (!is_in_reach(volume.centre)) return "has a centre that is not within 1e9 m of the origin";
  if (!within(volume.size, 0.0f, kMaxCoordinate)) return "has a size that is not within 0 to 1e9 m";
  return nullptr;
}

namespace {

// Fails with the first flaw of an array's entries, and its place.
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

// Checks that all instances, otherwise valid, are within the range of coordinates.
Expected<void> check_reach(const Scene& scene) {
  std::vector<Bounds> bounds;
  bounds.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) bounds.push_back(mesh_bounds(mesh));
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (const char* flaw = flaw_of_reach(instance, bounds[instance.mesh])) {
      return fail(scene.source.path, entry("instances", i), flaw);
    }
  }
  return {};
}

}  // namespace

Expected<void> validate_fog(const Scene& scene) {
  if (scene.fog.size() > kMaxFogVolumes) {
    return fail(scene.source.path, "fog", "has more than 16 volumes");
  }
  return check_array(scene, "fog", scene.fog);
}

Expected<void> validate(const Scene& scene) {
  const std::size_t textures = scene.textures.size();
  const std::size_t materials = scene.materials.size();
  const std::size_t meshes = scene.meshes.size();
  Expected<void> result = check_array(scene, "textures", scene.textures);
  if (result) result = check_array(scene, "materials", scene.materials, textures);
  if (result) result = check_array(scene, "meshes", scene.meshes, materials);
  if (result) result = check_array(scene, "instances", scene.instances, meshes);
  if (result) result = check_reach(scene);
  if (result) result = check_array(scene, "lights", scene.lights);
  if (result) result = check_array(scene, "cameras", scene.cameras);
  if (result) result = validate_fog(scene);
  if (result) result = check_array(scene, "volumes", scene.volumes);
  if (!result) return result;
  if (const char* flaw = flaw_of(scene.environment)) {
    return fail(scene.source.path, "environment", flaw);
  }
  return validate_motion(scene);
}

}  // namespace lambent
