// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/lights_cameras.h"

#include <algorithm>
#include <cmath>

#include "scene/animation/pose.h"
#include "scene/limits.h"
#include "shared/constants.h"

namespace lambent::gltf {
Expected<Light> import_light(Document& document, int index, int node,
                             const glm::mat4& world_from_node) {
  const tinygltf::Light& source = document.model.lights[index];
  const std::string place = "extensions.KHR_lights_punctual." + entry("lights", index);
  Light light;
  light.name = source.name.empty() ? document.model.nodes[node].name : source.name;
  if (source.type == "directional") {
    light.type = Light::Type::directional;
  } else if (source.type == "point") {
    light.type = Light::Type::point;
  } else if (source.type == "spot") {
    light.type = Light::Type::spot;
  } else {
    return document.fail_at(place + ".type", "must be directional, point or spot");
  }
  glm::vec3 color(1.0f);
  if (source.color.size() == 3)
    color = glm::vec3(source.color[0], source.color[1], source.color[2]);
  if (glm::any(glm::lessThan(color, glm::vec3(0.0f)))) {
    document.repaired("negative light colors were set to 0", 1, place);
    color = glm::max(color, glm::vec3(0.0f));
  }
  const bool directional = light.type == Light::Type::directional;
  const float most = directional ? kMaxIrradiance : kMaxIntensity;
  const glm::dvec3 intensity = glm::dvec3(color) * source.intensity;
  const bool too_bright = glm::any(glm::greaterThan(intensity, glm::dvec3(most)));
  document.repaired(directional ? "directional lights were reduced to 1e10 W/m^2"
                                : "lights were reduced to 1e12 W/sr",
                    too_bright ? 1 : 0, place);
  light.intensity = limited(intensity, most);
  if (!is_in_reach(glm::vec3(world_from_node[3]))) {
    return document.fail_at(entry("nodes", node), "the light is beyond 1e9 m from the origin");
  }
  lambent::place(light, world_from_node);
  light.range = static_cast<float>(source.range);
  if (light.type == Light::Type::spot) {
    const auto outer = static_cast<float>(source.spot.outerConeAngle);
    const auto inner = static_cast<float>(source.spot.innerConeAngle);
    light.outer_cone_angle = std::min(outer, 0.5f * kPi);
    light.inner_cone_angle = std::min(inner, light.outer_cone_angle);
    document.repaired("spot lights' inner cones were cut to their outer ones", inner > outer,
                      place);
  }
  return light;
}

float vertical_fov_of(const tinygltf::Camera& camera) {
  const auto fov = static_cast<float>(camera.perspective.yfov);
  return fov > kMaxFov ? glm::radians(fov) : fov;
}

Expected<Camera> import_camera(Document& document, int node, const glm::mat4& world_from_node) {
  const int index = document.model.nodes[node].camera;
  const tinygltf::Camera& source = document.model.cameras[index];
  const std::string place = entry("cameras", index);
  Camera camera;
  camera.name = source.name.empty() ? document.model.nodes[node].name : source.name;
  if (source.type == "perspective" && source.perspective.yfov > 0.0) {
    camera.vertical_fov = vertical_fov_of(source);
    document.repaired("cameras' fields of view of more than pi were taken as degrees",
                      static_cast<float>(source.perspective.yfov) > kMaxFov, place);
    camera.aspect = static_cast<float>(source.perspective.aspectRatio);
  } else if (source.type == "orthographic" && source.orthographic.xmag != 0.0 &&
             source.orthographic.ymag != 0.0) {
    const double xmag = std::abs(source.orthographic.xmag);
    const double ymag = std::abs(source.orthographic.ymag);
    camera.orthographic = true;
    camera.vertical_extent = static_cast<float>(2.0 * ymag);
    camera.aspect = static_cast<float>(xmag / ymag);
  } else {
    return document.fail_at(place, "describes neither a perspective nor an orthographic camera");
  }
  const bool shaped = camera.aspect >= 1.0f / kMaxAspect && camera.aspect <= kMaxAspect;
  if (camera.aspect != 0.0f && !shaped) {
    document.repaired("cameras' aspect ratios beyond 16384 were ignored", 1, place);
    camera.aspect = 0.0f;
  }
  const float extent = camera.orthographic ? camera.vertical_extent : kMinViewExtent;
  if (!(extent >= kMinViewExtent && extent <= kMaxViewExtent)) {
    return document.fail_at(place + ".orthographic.ymag", "is not within 5e-7 to 1e9 m");
  }
  if (!is_in_reach(glm::vec3(world_from_node[3]))) {
    return document.fail_at(entry("nodes", node), "the camera is beyond 1e9 m from the origin");
  }
  lambent::place(camera, world_from_node);
  return camera;
}

}  // namespace lambent::gltf
