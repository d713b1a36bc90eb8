// SPDX-License-Identifier: Apache-2.0
// Answers a query an invocation by the HLSL port of the lookup.
#include "lookup.hlsl"

struct Query {
  float position_ws[3], normal_ws[3], to_viewer_ws[3];
};
StructuredBuffer<Query> queries : register(t4);
RWStructuredBuffer<float> answers : register(u5);

[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {
  uint count, stride;
  queries.GetDimensions(count, stride);
  if (id.x >= count) return;
  Query query = queries[id.x];
  float3 irradiance = field_irradiance(vec3_of(query.position_ws), vec3_of(query.normal_ws),
                                       vec3_of(query.to_viewer_ws));
  for (uint c = 0; c < 3; ++c) answers[3 * id.x + c] = irradiance[c];
}
