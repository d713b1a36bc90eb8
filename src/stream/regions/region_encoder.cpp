// SPDX-License-Identifier: Apache-2.0
#include "stream/regions/region_encoder.h"

#include <algorithm>

#include "stream/light/decoder_state.h"
#include "stream/light/light_coding.h"

namespace lambent::stream {
namespace {

// A near region remains near up to this multiple of the distance, so that a client at the border of
// two regions does not get keys repeatedly.
constexpr float kStaysNear = 1.25f;

/// A state with the coefficients of a region, and their unit, with initial models.
LightState part_of(const LightState& whole, const Region& region) {
  const std::size_t numbers = region.layout.numbers();
  LightState part;
  part.update = whole.update;
  part.unit = whole.unit;
  part.history.resize(region.probes.size());
  part.coefficients.reserve(region.probes.size() * numbers);
  for (const int probe : region.probes) {
    const auto first = whole.coefficients.begin() + static_cast<std::ptrdiff_t>(probe * numbers);
    part.coefficients.insert(part.coefficients.end(), first,
                             first + static_cast<std::ptrdiff_t>(numbers));
  }
  return part;
}

}  // namespace

bool RegionEncoder::follow(const LightDecoder& decoder) {
  const LightDecoder::State& whole = *decoder.state_;
  const bool new_geometry = geometry_ != whole.current->version;
  const bool anew = !cut_ || whole.light.update != update_ + 1 || whole.light.unit != unit_ ||
                    whole.geometries != geometries_;
  geometries_ = whole.geometries;
  update_ = whole.light.update;
  unit_ = whole.light.unit;
  geometry_ = whole.current->version;
  if (anew) {
    cut_.emplace(whole.current->geometry, whole.current->layout);
    streams_.assign(2 * cut_->size(), {});
    return true;
  }
  if (new_geometry) {
    cut_->follow(whole.current->layout);
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      LightState& light = streams_[i].light;
      if (light.update != 0) clear_unlit(cut_->regions()[i / 2].layout, light);
      streams_[i].key_update = 0;
    }
  }
  for (std::size_t r = 0; r < cut_->size(); ++r) {
    advance(r, stream(r, RegionRate::near), whole.light);
    if (has_its_turn(r, update_)) advance(r, stream(r, RegionRate::far), whole.light);
  }
  return false;
}

/// Codes the step of a stream to the current light, if anybody follows it.
void RegionEncoder::advance(std::size_t region, Stream& of, const LightState& whole) {
  if (of.light.update == 0) return;
  if (of.asked < of.light.update) {
    of = {};
    return;
  }
  LightState now = part_of(whole, cut_->regions()[region]);
  std::vector<std::int32_t>& levels = now.coefficients;
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] -= of.light.coefficients[i];
  of.from = of.light.update;
  of.delta = write_delta(cut_->regions()[region].layout, levels, of.light);
  of.light.update = whole.update;
}

RegionStep RegionEncoder::key_of(std::size_t region, RegionRate rate, const LightState& whole) {
  Stream& of = stream(region, rate);
  if (of.light.update == 0) of.light = part_of(whole, cut_->regions()[region]);
  if (of.key_update != of.light.update) {
    of.key = write_key(cut_->regions()[region].layout, of.light);
    of.key_update = of.light.update;
  }
  return {static_cast<std::uint32_t>(region), rate, true,
          static_cast<std::uint32_t>(update_ - of.light.update), of.key};
}

LightMessage RegionEncoder::update_for(const LightDecoder& decoder, const Surroundings& client,
                                       bool all, FollowedRegions& has) {
  const LightDecoder::State& whole = *decoder.state_;
  const bool whole_message = all || has.size() != cut_->size();
  if (whole_message) has.assign(cut_->size(), RegionRate::far);
  Surroundings stays = client;
  stays.radius *= kStaysNear;
  std::vector<RegionStep> steps;
  for (std::size_t r = 0; r < cut_->size(); ++r) {
    const RegionRate before = has[r];
    const bool near = is_near(before == RegionRate::near && !whole_message ? stays : client,
                              cut_->regions()[r], whole.current->geometry);
    RegionRate wanted = near ? RegionRate::near : RegionRate::far;
    const bool turn = has_its_turn(r, update_);
    // Switch to a stream of every eighth update only when it has a step; otherwise light would go
    // back in time
    if (!whole_message && wanted == RegionRate::far && !turn) wanted = before;
    has[r] = wanted;
    if (whole_message || wanted != before) {
      steps.push_back(key_of(r, wanted, whole.light));
    } else if (wanted == RegionRate::near || turn) {
      const Stream& of = stream(r, wanted);
      steps.push_back({static_cast<std::uint32_t>(r), wanted, false,
                       static_cast<std::uint32_t>(update_ - of.from), of.delta});
    }
    // Mark that its next step will be requested
    Stream& followed = stream(r, wanted);
    followed.asked = std::max(followed.asked, update_);
  }
  const MessageHeader header{LightMessageKind::regions, whole.current->stream, update_, geometry_};
  return make_message(header, write_regions(whole_message, steps));
}

}  // namespace lambent::stream
