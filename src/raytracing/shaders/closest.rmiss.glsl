// SPDX-License-Identifier: Apache-2.0
// Does nothing: the record is initialised to a miss.
#version 460
#extension GL_EXT_ray_tracing : require

void main() {}
