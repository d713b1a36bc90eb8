// SPDX-License-Identifier: Apache-2.0
// A shader of somebody else's that looks the field up.
#include "lookup.hlsl"

RWStructuredBuffer<float3> irradiance : register(u4);

[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {
  float3 up = float3(0.0, 1.0, 0.0);
  irradiance[id.x] = field_irradiance(float3(id), up, up);
}
