// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf_lights_cameras.h"

#include <algorithm>
#include <cmath>

#include "shared/constants.h"

namespace lambent::gltf {
namespace {

// Scaled to unit length in double, where no finite float vector over- or underflows.
glm::vec3 unit_or(const glm::dvec3& v, const glm::vec3& fallback) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

}  // namespace

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
  light.intensity = color * static_cast<float>(source.intensity);
  light.position_ws = glm::vec3(world_from_node[3]);
  light.direction_ws = unit_or(-glm::dvec3(world_from_node[2]), light.direction_ws);
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

Expected<Camera> import_camera(const Document& document, int node,
                               const glm::mat4& world_from_node) {
  const int index = document.model.nodes[node].camera;
  const tinygltf::Camera& source = document.model.cameras[index];
  const std::string place = entry("cameras", index);
  Camera camera;
  camera.name = source.name.empty() ? document.model.nodes[node].name : source.name;
  if (source.type == "perspective" && source.perspective.yfov > 0.0) {
    camera.vertical_fov = static_cast<float>(source.perspective.yfov);
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

  // Keep where the node looks and what is up there; scale, shear and mirroring do not bend a camera
  const glm::vec3 back = unit_or(glm::dvec3(world_from_node[2]), glm::vec3(0.0f, 0.0f, 1.0f));
  const glm::dvec3 up(world_from_node[1]);
  const glm::vec3 any_right =
      std::abs(back.x) < 0.5f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, -1.0f);
  const glm::vec3 fallback = glm::normalize(any_right - back * glm::dot(back, any_right));
  const glm::vec3 right = unit_or(glm::cross(up, glm::dvec3(back)), fallback);
  camera.world_from_view =
      glm::mat4(glm::vec4(right, 0.0f), glm::vec4(glm::normalize(glm::cross(back, right)), 0.0f),
                glm::vec4(back, 0.0f), glm::vec4(glm::vec3(world_from_node[3]), 1.0f));
  return camera;
}

}  // namespace lambent::gltf
