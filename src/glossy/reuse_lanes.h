// SPDX-License-Identifier: Apache-2.0
// The sums of reuse.inl.h on the processor, for neighbouring pixels of a row at once, one a lane.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "glossy/glossy_math.h"

namespace lambent {

/// CoatLobe and CoatRay of a pixel, which its neighbours read: a plane for each number, three for a
/// vector.
enum CoatPlane : int {
  kLobePosition = 0,
  kLobeGeometricNormal = 3,
  kLobeNormal = 6,
  kLobeViewer = 9,
  kLobeSquareAlpha = 12,
  kLobePdfScale = 13,
  kLobeLambda = 14,
  kRayDirection = 15,
  kRayDistance = 18,
  kRayPdf = 19,
  kRayRadiance = 20,
  kRayEmission = 23,
  kRayEmissionLuminance = 26,
  kCoatPlanes = 27
};

/// Further numbers of a CoatReceiver.
enum ReceiverPlane : int {
  kReceives = 0,  ///< 1: the pixel receives light, and its sums are computed.
  kOwnValue = 1,  ///< CoatReceiver::at_own
  kOwnLobePdf = 2,
  kMirror = 3,
  kInverseMirrorPdf = 6,
  kF0 = 7,
  kF90 = 10,
  kInverseTolerance = 11,
  kDensityScale = 12,
  kReceiverPlanes = 13
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
  kSumBrightest = 11,
  kSumBrightestWeight = 14,
  kSumSquaredWeights = 15,
  kSumSquares = 16,
  kSumPlanes = 17
};

/// Rows of planes. Each row is padded with zeros, which mean no ray, as lanes and neighbours reach
/// beyond its ends.
class RowPlanes {
 public:
  /// Leaves the contents as they are where the shape is the same.
  void resize(int planes, int width, int rows) {
    const auto pitch = static_cast<std::size_t>(kBeside + width + kBeside);
    const std::size_t size =
        pitch * static_cast<std::size_t>(planes) * static_cast<std::size_t>(rows);
    if (planes == planes_ && pitch == pitch_ && size == numbers_.size()) return;
    planes_ = planes;
    pitch_ = pitch;
    numbers_.assign(size, 0.0f);
  }
  /// Points to the number of the row's first pixel; those of the next pixels follow.
  float* at(int row, int plane) { return numbers_.data() + place(row, plane); }
  const float* at(int row, int plane) const { return numbers_.data() + place(row, plane); }
  std::size_t pitch() const { return pitch_; }  ///< Numbers from one plane to the next.

 private:
  static constexpr int kBeside = 16 + kReuse;  // the lanes, and the neighbours of the last one
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
/// Writes the further numbers of a receiver.
void set_receiver(RowPlanes& receivers, int row, int x, const CoatReceiver& at);

/// A row whose rays the receivers take.
struct NeighbourRow {
  int row;       ///< Index of the row in the planes.
  float weight;  ///< Weight of its rays.
  bool own;      ///< It is the receivers' own row.
};

/// Pixels of one row that receive the light of the rays around them.
struct ReuseRow {
  const RowPlanes& coats;
  const RowPlanes& receivers;
  int row;           ///< The pixels' row in `coats`.
  int receiver_row;  ///< Their row in `receivers` and in the sums.
  int width;         ///< [pixels]
  std::span<const NeighbourRow> around;
};

/// Computes the sums of the receiving pixels over the rays around them, see add_coat_ray().
void reuse_row(const ReuseRow& row, RowPlanes& sums);

/// The sums of a pixel.
CoatSums sums_of(const RowPlanes& sums, int row, int x);

}  // namespace lambent
