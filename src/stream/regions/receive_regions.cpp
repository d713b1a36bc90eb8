// SPDX-License-Identifier: Apache-2.0
// The client's decoding of region messages.
#include <utility>

#include "stream/light/decoder_state.h"

namespace lambent::stream {

/// Receives keys of all regions, which need no earlier light.
Expected<void> LightDecoder::State::receive_whole_regions(const MessageHeader& header,
                                                          const RegionBody& body) {
  const ReceivedGeometry& of = is_of_next(header) ? *next : *current;
  RegionStates states(of.geometry, of.layout);
  LightState key;
  key.coefficients.resize(of.layout.probes() * of.layout.numbers());
  key.history.resize(of.layout.probes());
  std::vector<int> ignored;
  const auto taken = states.take(body, header.update, key.coefficients, ignored);
  if (!taken) return taken;
  key.unit = states.unit();
  take_key(header, std::move(key));
  regions.emplace(std::move(states));
  way = Way::regions;
  return {};
}

Expected<void> LightDecoder::State::receive_regions(const OpenedMessage& message) {
  const MessageHeader& header = message.header;
  const bool is_of_new = is_of_next(header);
  if (!current && !is_of_new) {
    lost = true;
    return bad_stream("regions", "are of geometry that is not here");
  }
  const ReceivedGeometry& of = is_of_new ? *next : *current;
  const std::size_t count = RegionCut(of.geometry, of.layout).size();
  const auto body = read_regions(message.body, count);
  if (!body) {
    lost = lost || !is_of_new;
    return tl::unexpected(body.error());
  }
  if (body->whole) {
    if (const auto fine = check_key(header); !fine) return fine;
    return receive_whole_regions(header, *body);
  }
  if (const auto fine = check_follows(header, header.geometry); !fine) return fine;
  if (const auto same = check_way(header, Way::regions); !same) return same;
  const auto taken = regions->take(*body, header.update, light.coefficients, changed);
  if (!taken) {
    lost = true;
    return taken;
  }
  light.update = header.update;
  corrected = false;
  return {};
}

}  // namespace lambent::stream
