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
  put(coats, row, kLobePosition, x, lobe.position_ws);
  put(coats, row, kLobeGeometricNormal, x, lobe.geometric_normal_ws);
  put(coats, row, kLobeNormal, x, lobe.normal_ws);
  put(coats, row, kLobeViewer, x, lobe.to_viewer_ws);
  put(coats, row, kLobeSquareAlpha, x, lobe.squared_alpha);
  put(coats, row, kLobePdfScale, x, lobe.pdf_scale);
  put(coats, row, kLobeLambda, x, lobe.lambda);
  put(coats, row, kRayDirection, x, ray.direction_ws);
  put(coats, row, kRayDistance, x, ray.distance);
  put(coats, row, kRayPdf, x, ray.pdf);
  put(coats, row, kRayRadiance, x, ray.radiance);
  put(coats, row, kRayEmission, x, ray.apart);
  put(coats, row, kRayEmissionLuminance, x, ray.apart_luminance);
}

void set_no_coat(RowPlanes& coats, int row, int x) {
  put(coats, row, kRayPdf, x, 0.0f);
}

void set_receiver(RowPlanes& receivers, int row, int x, const CoatReceiver& at) {
  put(receivers, row, kReceives, x, 1.0f);
  put(receivers, row, kOwnValue, x, at.at_own.value);
  put(receivers, row, kOwnLobePdf, x, at.at_own.pdf);
  put(receivers, row, kMirror, x, at.mirror_ws);
  put(receivers, row, kInverseMirrorPdf, x, at.inverse_mirror_pdf);
  put(receivers, row, kF0, x, at.reflectance.f0);
  put(receivers, row, kF90, x, at.reflectance.f90);
  put(receivers, row, kInverseTolerance, x, at.inverse_tolerance);
  put(receivers, row, kDensityScale, x, at.density_scale);
}

CoatSums sums_of(const RowPlanes& sums, int row, int x) {
  return {three_of(sums, row, kSumLight, x),    three_of(sums, row, kSumEmission, x),
          sums.at(row, kSumWeight)[x],          sums.at(row, kSumSchlick)[x],
          sums.at(row, kSumOwnWeight)[x],       sums.at(row, kSumPixels)[x],
          sums.at(row, kSumFitting)[x],         three_of(sums, row, kSumBrightest, x),
          sums.at(row, kSumBrightestWeight)[x], sums.at(row, kSumSquaredWeights)[x],
          sums.at(row, kSumSquares)[x]};
}

}  // namespace lambent
