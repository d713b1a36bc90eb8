// SPDX-License-Identifier: Apache-2.0
#include "stream/light/light_coding.h"

#include <array>
#include <cassert>

#include "core/little_endian.h"
#include "stream/light/level_coding.h"
#include "stream/light/message.h"

namespace lambent::stream {
namespace {

constexpr std::size_t kKeyHeaderBytes = 4;

/// A key's prediction of a coefficient: the mean of those of the probe's lit preceding neighbours.
std::int32_t expected_coefficient(const LightLayout& layout,
                                  std::span<const std::int32_t> coefficients, int probe,
                                  std::size_t number) {
  std::int64_t sum = 0, count = 0;
  for (const std::int32_t other : layout.before[probe]) {
    if (other < 0 || layout.lit[other] == 0) continue;
    sum += coefficients[other * layout.numbers() + number];
    ++count;
  }
  return count == 0 ? 0 : static_cast<std::int32_t>(sum / count);
}

template <class Coder>
void code_models(Coder& coder, LevelModels& models) {
  BitModel is_used;
  LevelModels::for_each(models, [&](BitModel& model) {
    if (!code_bit(coder, is_used, model.count > 0)) return;
    model.fast = static_cast<std::uint16_t>(coder.bits(16, model.fast));
    model.slow = static_cast<std::uint16_t>(coder.bits(16, model.slow));
    model.count = static_cast<std::uint8_t>(coder.bits(8, model.count));
  });
  LevelModels::for_each_weight(models, [&](std::int32_t& weight) {
    weight = static_cast<std::int32_t>(coder.bits(32, static_cast<std::uint32_t>(weight)));
  });
}

template <class Coder>
void code_history(Coder& coder, const LightLayout& layout, std::span<ProbeHistory> history) {
  // Two bits per counter, with the previous counter as context
  std::array<std::array<BitModel, 3>, std::size_t{4} * ProbeHistory::kNumbers> models;
  for (int probe = 0; probe < layout.probes(); ++probe) {
    if (layout.lit[probe] == 0) continue;
    std::uint32_t word = 0;
    int last = 0;
    for (int i = ProbeHistory::kNumbers - 1; i >= 0; --i) {
      auto& [high, low_of_low, low_of_high] = models[i * 4 + last];
      const int value = history[probe].at(i);
      const bool upper = code_bit(coder, high, value >= 2);
      const bool odd = code_bit(coder, upper ? low_of_high : low_of_low, (value & 1) != 0);
      last = (upper ? 2 : 0) + (odd ? 1 : 0);
      word |= static_cast<std::uint32_t>(last) << (2 * i);
    }
    history[probe] = ProbeHistory(word);
  }
}

/// Whether counts and weights are in their valid ranges.
bool are_sound(const LevelModels& models) {
  bool sound = true;
  LevelModels::for_each(
      models, [&](const BitModel& model) { sound = sound && model.count <= BitModel::kSlowCount; });
  LevelModels::for_each_weight(models, [&](std::int32_t weight) {
    sound = sound && weight >= -kMaxMixWeight && weight <= kMaxMixWeight;
  });
  return sound;
}

bool is_coefficient(std::int64_t value) {
  return value >= -kMaxCoefficient && value <= kMaxCoefficient;
}

/// Adds a delta to the coefficients, and updates the histories.
template <class Coder>
void apply(const LightLayout& layout, std::span<const std::int32_t> levels,
           const LevelCoder<Coder>& coded, LightState& state) {
  for (int probe = 0; probe < layout.probes(); ++probe) {
    if (layout.lit[probe] == 0) continue;
    const std::uint32_t something = coded.something(probe);
    state.history[probe].update(something);
    if (something == 0) continue;
    const std::size_t first = probe * layout.numbers();
    for (std::size_t i = first; i < first + layout.numbers(); ++i) {
      state.coefficients[i] += levels[i];
    }
  }
  ++state.update;
}

}  // namespace

std::vector<std::byte> write_delta(const LightLayout& layout, std::span<const std::int32_t> levels,
                                   LightState& state) {
  assert(levels.size() == state.coefficients.size());
  RangeEncoder coder;
  std::vector<std::int32_t> written(levels.begin(), levels.end());
  LevelCoder coded(coder, state.models, layout, state.history, written);
  for (int probe = 0; probe < layout.probes(); ++probe) coded.probe(probe);
  apply(layout, written, coded, state);
  return coder.finish();
}

Expected<void> read_delta(const LightLayout& layout, std::span<const std::byte> body,
                          LightState& state, std::vector<std::int32_t>& levels) {
  levels.assign(state.coefficients.size(), 0);
  RangeDecoder coder(body);
  LevelModels models = state.models;
  LevelCoder coded(coder, models, layout, state.history, levels);
  for (int probe = 0; probe < layout.probes(); ++probe) {
    coded.probe(probe);
    if (coder.overrun()) return bad_stream("delta", "ends before its last probe");
    if (coded.something(probe) == 0) continue;
    const std::size_t first = probe * layout.numbers();
    for (std::size_t i = first; i < first + layout.numbers(); ++i) {
      if (!is_coefficient(state.coefficients[i] + std::int64_t{levels[i]})) {
        return bad_stream("delta", "leads to light out of range");
      }
    }
  }
  if (coder.left() > 0) return bad_stream("delta", "goes on after its last probe");
  apply(layout, levels, coded, state);
  state.models = models;
  return {};
}

std::vector<std::byte> write_key(const LightLayout& layout, const LightState& state) {
  ByteWriter out;
  out.f32(state.unit);
  RangeEncoder coder;
  LightState copy = state;
  code_models(coder, copy.models);
  code_history(coder, layout, copy.history);
  // Levels are the differences of coefficients from their predictions
  for (int probe = layout.probes() - 1; probe >= 0; --probe) {
    if (layout.lit[probe] == 0) continue;
    for (std::size_t i = 0; i < layout.numbers(); ++i) {
      copy.coefficients[probe * layout.numbers() + i] -=
          expected_coefficient(layout, state.coefficients, probe, i);
    }
  }
  LevelModels models;
  const std::vector<ProbeHistory> none(state.history.size());
  LevelCoder coded(coder, models, layout, none, copy.coefficients);
  for (int probe = 0; probe < layout.probes(); ++probe) coded.probe(probe);
  out.raw(coder.finish());
  return out.take();
}

Expected<LightState> read_key(const LightLayout& layout, std::span<const std::byte> body) {
  if (body.size() < kKeyHeaderBytes) return bad_stream("key", "is cut short");
  LightState state;
  ByteReader in(body);
  state.unit = in.f32();
  if (!(state.unit >= kLeastUnit && state.unit <= kMaxUnit)) {
    return bad_stream("key", "has a unit that no light has");
  }
  state.history.resize(layout.probes());
  state.coefficients.resize(layout.probes() * layout.numbers());
  RangeDecoder coder(body.subspan(kKeyHeaderBytes));
  code_models(coder, state.models);
  if (!are_sound(state.models)) return bad_stream("key", "has expectations of no stream");
  code_history(coder, layout, state.history);
  LevelModels models;
  const std::vector<ProbeHistory> none(state.history.size());
  LevelCoder coded(coder, models, layout, none, state.coefficients);
  for (int probe = 0; probe < layout.probes(); ++probe) {
    coded.probe(probe);
    if (coder.overrun()) return bad_stream("key", "ends before its last probe");
  }
  if (coder.left() > 0) return bad_stream("key", "goes on after its last probe");
  for (int probe = 0; probe < layout.probes(); ++probe) {
    if (layout.lit[probe] == 0) continue;
    for (std::size_t i = 0; i < layout.numbers(); ++i) {
      std::int32_t& number = state.coefficients[probe * layout.numbers() + i];
      const std::int64_t value =
          number + std::int64_t{expected_coefficient(layout, state.coefficients, probe, i)};
      if (!is_coefficient(value)) return bad_stream("key", "holds light out of range");
      number = static_cast<std::int32_t>(value);
    }
  }
  return state;
}

}  // namespace lambent::stream
