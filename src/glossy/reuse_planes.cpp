// SPDX-License-Identifier: Apache-2.0
#include "glossy/reuse_lanes.h"

namespace lambent {
namespace {

void put(RowPlanes& planes, int row, int plane, int x, float value) {
  planes.at(row, plane)[x] = value;
}
void put(RowPlanes& planes, int row, int plane, int x, const vec3& value) {
  for (int c = 0; c < 3; ++c) planes.at(row, plane + c)[x] = value[c];
}
vec3 three_of(const RowPlanes& planes, int row, int plane, int x) {
  return {planes.at(row, plane)[x], planes.at(row, plane + 1)[x], planes.at(row, plane + 2)[x]};
}

}  // namespace

void set_coat(RowPlanes& coats, int row, int x, const CoatLobe& lobe, const CoatRay& ray) {
  const float n_dot_v = dot(lobe.normal_ws, lobe.to_viewer_ws);
  const float lambda = ggx_lambda(n_dot_v, lobe.alpha);
  put(coats, row, kLobePosition, x, lobe.position_ws);
  put(coats, row, kLobeGeometricNormal, x, lobe.geometric_normal_ws);
  put(coats, row, kLobeNormal, x, lobe.normal_ws);
  put(coats, row, kLobeViewer, x, lobe.to_viewer_ws);
  put(coats, row, kLobeSquareAlpha, x, lobe.alpha * lobe.alpha);
  put(coats, row, kLobePdfScale, x,
      n_dot_v > 0.0f ? 1.0f / (4.0f * n_dot_v * (1.0f + lambda)) : 0.0f);
  put(coats, row, kLobeLambda, x, lambda);
  put(coats, row, kRayDirection, x, ray.direction_ws);
  put(coats, row, kRayDistance, x, ray.distance);
  put(coats, row, kRayPdf, x, ray.pdf);
  put(coats, row, kRayRadiance, x, ray.radiance);
  put(coats, row, kRayEmission, x, ray.apart);
  put(coats, row, kRayEmissionDensity, x, ray.apart_density);
}

void set_no_coat(RowPlanes& coats, int row, int x) {
  put(coats, row, kRayPdf, x, 0.0f);
}

void set_receiver(RowPlanes& receivers, int row, int x, const CoatReceiver& at) {
  put(receivers, row, kReceives, x, 1.0f);
  put(receivers, row, kOwnValue, x, at.at_own.value);
  put(receivers, row, kOwnLobePdf, x, at.at_own.pdf);
  put(receivers, row, kMirror, x, at.mirror_ws);
  put(receivers, row, kInverseMirrorPdf, x, at.mirror_pdf > 0.0f ? 1.0f / at.mirror_pdf : 0.0f);
  put(receivers, row, kF0, x, fresnel(at.reflectance, 1.0f));
  put(receivers, row, kF90, x, fresnel(at.reflectance, 0.0f));
  put(receivers, row, kInverseTolerance, x, at.inverse_tolerance);
}

CoatSums sums_of(const RowPlanes& sums, int row, int x) {
  return {three_of(sums, row, kSumLight, x), three_of(sums, row, kSumEmission, x),
          sums.at(row, kSumWeight)[x],       sums.at(row, kSumSchlick)[x],
          sums.at(row, kSumOwnWeight)[x],    sums.at(row, kSumPixels)[x],
          sums.at(row, kSumFitting)[x]};
}

}  // namespace lambent
