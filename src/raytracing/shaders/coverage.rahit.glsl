// SPDX-License-Identifier: Apache-2.0
// Lets rays through what is see-through, as the host does. Opaque triangles never ask.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/trace_arguments.h"

layout(push_constant, scalar) uniform Push {
  TraceArguments args;
};
hitAttributeEXT vec2 barycentrics;

void main() {
  if (!stops_ray_at(args.scene, uint(gl_InstanceCustomIndexEXT), uint(gl_PrimitiveID), barycentrics,
                    gl_HitTEXT)) {
    ignoreIntersectionEXT;
  }
}
