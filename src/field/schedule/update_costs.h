// SPDX-License-Identifier: Apache-2.0
// What updates take, as measured, to fit them into a time. Each cost has a part that grows with the
// work and one that does not, such as the solve for the light of all probes. Were both taken as
// one, an update with little work would make work look expensive, and the next one do even less.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lambent {

/// The moving average of a measured time [ms].
class MeasuredTime {
 public:
  void learn(double ms);
  /// 0 while it is not known.
  double ms() const { return ms_; }

 private:
  double ms_ = 0.0;
  bool known_ = false;
};

/// The cost of tracing new rays.
class RayCost {
 public:
  /// Learns from an update in which `rays` rays, with what is done for each of them, took `rays_ms`
  /// and all else `other_ms` [ms]. Where the time of rays was not measured, which some devices
  /// cannot, `rays_ms` is 0, and all of the time counts as theirs.
  void learn(std::uint64_t rays, double rays_ms, double other_ms);
  /// The number of rays to trace in an update that may take `ms` and has taken `spent_ms`: at least
  /// those of one probe.
  std::uint64_t rays_within(double ms, double spent_ms) const;

 private:
  MeasuredTime ray_;
  MeasuredTime other_;
};

/// The cost of bringing probes up to date with edits of the world.
class EditCost {
 public:
  /// Learns from probes that were brought up to date together.
  void learn_slice(std::size_t probes, double ms);
  /// Learns from what else applying edits took, such as solving for the light that results.
  void learn_other(double ms) { other_.learn(ms); }
  /// The time for such probes [ms], in an update that may take `ms` and has taken `spent_ms`.
  double time_left(double ms, double spent_ms) const;
  /// The number of probes that can be brought up to date in this time: at least a few.
  std::size_t probes_within(double ms) const;

 private:
  // Of the last slice alone: a probe takes several times as long where rays are traced again as
  // where just a light differs
  double ms_per_probe_ = 0.0;
  MeasuredTime other_;
};

}  // namespace lambent
