// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "raytracing/vulkan/trace_arguments.h"

layout(location = 0) rayPayloadInEXT TransmittancePayload light;

void main() {
  light.stopped = 0u;
}
