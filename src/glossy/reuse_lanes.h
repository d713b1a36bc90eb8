// SPDX-License-Identifier: Apache-2.0
// The sums of reuse.inl.h on the processor, for neighbouring pixels of a row together, a lane each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "glossy/glossy_math.h"

namespace lambent {

/// What neighbours read of a pixel, a plane a number; vectors are three planes.
enum CoatPlane : int {
  kLobePosition = 0,
  kLobeGeometricNormal = 3,
  kLobeNormal = 6,
  kLobeViewer = 9,
  kLobeSquareAlpha = 12,
  kLobePdfScale = 13,  ///< What the half vector's density is multiplied by; 0: seen from below.
  kLobeLambda = 14,    ///< Of Smith, to the viewer.
  kRayDirection = 15,
  kRayDistance = 18,
  kRayPdf = 19,
  kRayRadiance = 20,
  kRayEmission = 23,
  kCoatPlanes = 26
};

/// What a pixel that receives needs besides.
enum ReceiverPlane : int {
  kReceives = 0,  ///< 1: it does, and its sums are asked for.
  kOwnValue = 1,  ///< CoatReceiver::at_own
  kOwnLobePdf = 2,
  kMirror = 3,
  kInverseMirrorPdf = 6,  ///< 0 where there is no lobe.
  kF0 = 7,                ///< fresnel() straight on,
  kF90 = 10,              ///< and at grazing incidence.
  kInverseTolerance = 13,
  kReceiverPlanes = 14
};

/// CoatSums of a pixel.
enum SumPlane : int {
  kSumLight = 0,
  kSumEmission = 3,
  kSumWeight = 6,
  kSumSchlick = 7,
  kSumOwnWeight = 8,
  kSumPixels = 9,
  kSumFitting = 10,
  kSumPlanes = 11
};

/// Rows of planes. There is room beside each row for what lanes and neighbours reach beyond it; it
/// is all 0, which is no ray.
class RowPlanes {
 public:
  /// Keeps what is there where the shape is the same.
  void resize(int planes, int width, int rows) {
    const auto pitch = static_cast<std::size_t>(kBeside + width + kBeside);
    const std::size_t size =
        pitch * static_cast<std::size_t>(planes) * static_cast<std::size_t>(rows);
    if (planes == planes_ && pitch == pitch_ && size == numbers_.size()) return;
    planes_ = planes;
    pitch_ = pitch;
    numbers_.assign(size, 0.0f);
  }
  /// Number of the row's first pixel; that of the next one follows.
  float* at(int row, int plane) { return numbers_.data() + place(row, plane); }
  const float* at(int row, int plane) const { return numbers_.data() + place(row, plane); }
  std::size_t pitch() const { return pitch_; }  ///< From plane to plane.

 private:
  static constexpr int kBeside = 16 + kReuse;  // lanes, and neighbours of the last one
  std::size_t place(int row, int plane) const {
    return (static_cast<std::size_t>(row) * static_cast<std::size_t>(planes_) +
            static_cast<std::size_t>(plane)) *
               pitch_ +
           kBeside;
  }

  int planes_ = 0;
  std::size_t pitch_ = 0;
  std::vector<float> numbers_;
};

/// Writes a pixel's lobe and its ray.
void set_coat(RowPlanes& coats, int row, int x, const CoatLobe& lobe, const CoatRay& ray);
/// Writes that a pixel has no ray and does not receive.
void set_no_coat(RowPlanes& coats, int row, int x);
/// Writes what else a receiver needs.
void set_receiver(RowPlanes& receivers, int row, int x, const CoatReceiver& at);

/// A row of rays around that of the receivers.
struct NeighbourRow {
  int row;       ///< Of the planes.
  float weight;  ///< Of its rays.
  bool own;      ///< It is the receivers' own row.
};

/// Pixels of one row that take the rays around them.
struct ReuseRow {
  const RowPlanes& coats;
  const RowPlanes& receivers;
  int row;           ///< Of the pixels, among the coats' rows.
  int receiver_row;  ///< Among the receivers' rows, and the sums'.
  int width;         ///< [pixels]
  uint emitter_samples;
  std::span<const NeighbourRow> around;
};

/// Sums up what pixels that receive make of the rays around them, as add_coat_ray().
void reuse_row(const ReuseRow& row, RowPlanes& sums);

/// The sums of a pixel.
CoatSums sums_of(const RowPlanes& sums, int row, int x);

}  // namespace lambent
