// SPDX-License-Identifier: Apache-2.0
// Nothing was hit: the record says so from the start.
#version 460
#extension GL_EXT_ray_tracing : require

void main() {}
