// SPDX-License-Identifier: Apache-2.0
// Indirect light from reflective shadow maps, for the pixels of a frame.
#pragma once

#include <span>
#include <vector>

#include "compose/frame_passes.h"
#include "compose/gbuffer.h"
#include "compose/rsm/direct_frame.h"
#include "lambent/rsm.h"

namespace lambent {

/// What the camera sees through the middle of each pixel, and one bounce of light there. Memory is
/// reused from frame to frame.
struct RsmFrame {
  int downscale = 1;
  float plane_tolerance = 0.0f;
  std::vector<glm::vec3> positions_ws, normals_ws;
  std::vector<float> depths;
  RsmIrradiance light;
  DirectView direct;          ///< Filled in where RsmSettings::direct is set.
  std::vector<Layer> layers;  ///< Of the frame's size, where requested; see docs/rsm.md.

  // Memory and cost of the passes
  std::uint64_t direct_rays = 0;
  double direct_ms = 0.0;
  GBuffer gbuffer;
  RsmGatherer gatherer;
};

/// Renders the maps and gathers their light at 1 / downscale of the frame's width and height,
/// rounded up.
void light_by_rsm(const FrameRequest& request, RsmFrame& frame);

/// The first map's flux, where there is a map, and the gather's stages as layers of a frame of that
/// size.
std::vector<Layer> rsm_stage_layers(const ReflectiveShadowMap* first_map,
                                    const RsmIrradiance& light, int width, int height);

/// Irradiance at the surfaces of a band, from the view's pixels around them that show the same
/// surface (cross-bilateral upsampling: Kopf et al., "Joint Bilateral Upsampling", SIGGRAPH 2007).
/// Where none does, from all 3 x 3 around.
void look_up_rsm(const RsmFrame& frame, const GBuffer& gbuffer, const Camera& camera, int width,
                 const Band& band, std::vector<glm::vec3>& irradiance);

/// Subtracts another method's share of light from the field's, and adds that method's own result.
void replace_light(const std::vector<glm::vec3>& subtracted_field,
                   const std::vector<glm::vec3>& added, std::vector<glm::vec3>& irradiance);

/// Adds the direct light of the view to that of a band's samples; see RsmSettings::direct.
void add_rsm_direct(const RsmFrame& frame, const GBuffer& gbuffer, const Camera& camera, int width,
                    const Band& band, ReflectedLight& light);

}  // namespace lambent
