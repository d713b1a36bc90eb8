// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/results.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "core/files/atomic_file.h"
#include "core/files/file_bytes.h"
#include "core/little_endian.h"
#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"

namespace lambent::bench {
namespace {

// Sizes with which a processor takes seconds.
constexpr int kWidth = 320, kHeight = 180;
constexpr int kMapResolution = 64;
constexpr int kProbes = 512, kResultRays = 64, kUpdates = 4;

constexpr std::uint32_t kMagic = 0x31524C42u;  // "BLR1"

std::vector<float> floats_of(std::span<const glm::vec3> values) {
  std::vector<float> floats;
  for (const glm::vec3& value : values) floats.insert(floats.end(), {value.x, value.y, value.z});
  return floats;
}

}  // namespace

std::vector<Result> find_results(const World& world) {
  const Camera& camera = world.scene().cameras.at(0);
  FieldSettings settings;
  settings.probe_budget = kProbes;
  settings.rays_per_probe = kResultRays;
  IrradianceField field = IrradianceField::make(settings, open_bounds(world)).value();
  for (int update = 0; update < kUpdates; ++update) field.update(world);

  std::vector<Result> results;
  FrameSettings frame;
  frame.width = kWidth;
  frame.height = kHeight;
  const LayeredImage by_field =
      Renderer(world, {.field = &field}).render(camera, frame).value().image;
  for (const char* layer : {"", "direct", "irradiance", "indirect"}) {
    results.push_back(
        {std::string("field ") + (*layer == 0 ? "picture" : layer), by_field.find(layer)->pixels});
  }
  std::vector<glm::vec3> light(field.probes());
  std::vector<FieldQuery> queries;
  for (const FieldGrid& grid : field.grids()) {
    for (int i = 0; i < grid.probes(); ++i) {
      const glm::ivec3 c(i % grid.count.x, i / grid.count.x % grid.count.y,
                         i / (grid.count.x * grid.count.y));
      queries.push_back({.position_ws = grid.origin + grid.axes * (glm::vec3(c) * grid.spacing)});
    }
  }
  field.irradiance(queries, light);
  results.push_back({"field at its probes", floats_of(light)});

  if (world.scene().lights.empty()) return results;
  // Gather every texel of small maps, since rounding may affect the choice of texels
  RsmSettings rsm;
  rsm.resolution = kMapResolution;
  rsm.texels = 0;
  const LayeredImage by_maps = Renderer(world, {.rsm = rsm}).render(camera, frame).value().image;
  results.push_back({"rsm irradiance", by_maps.find("irradiance")->pixels});
  return results;
}

Expected<void> save_results(const std::vector<Result>& results, const std::string& path) {
  ByteWriter bytes;
  bytes.u32(kMagic);
  bytes.u32(static_cast<std::uint32_t>(results.size()));
  for (const Result& result : results) {
    bytes.u32(static_cast<std::uint32_t>(result.name.size()));
    bytes.raw(std::as_bytes(std::span(result.name)));
    bytes.u32(static_cast<std::uint32_t>(result.values.size()));
    bytes.f32s(result.values);
  }
  return write_file_atomically(path, bytes.bytes());
}

Expected<std::vector<Result>> load_results(const std::string& path) {
  const Expected<std::vector<std::byte>> bytes = read_file(path);
  if (!bytes) return tl::unexpected(bytes.error());
  ByteReader reader(*bytes);
  // Number of the following objects of a size; larger than possible if the file is broken
  const auto count = [&](std::size_t size) -> std::size_t {
    const std::size_t words = reader.left() >= 4 ? reader.u32() : reader.left() + 1;
    return words * size <= reader.left() ? words : std::numeric_limits<std::size_t>::max();
  };
  const auto broken = [&] { return fail(path, "", "is not a file of results"); };
  if (reader.left() < 4 || reader.u32() != kMagic) return broken();
  const std::size_t entries = count(1);
  std::vector<Result> results;
  for (std::size_t i = 0; i < entries; ++i) {
    Result result;
    const std::size_t letters = count(1);
    if (letters > reader.left()) return broken();
    for (std::size_t k = 0; k < letters; ++k) {
      result.name.push_back(static_cast<char>(reader.u8()));
    }
    const std::size_t values = count(sizeof(float));
    if (values > reader.left()) return broken();
    for (std::size_t k = 0; k < values; ++k) result.values.push_back(reader.f32());
    results.push_back(std::move(result));
  }
  return results;
}

double relative_rmse(const std::vector<float>& found, const std::vector<float>& expected) {
  if (found.size() != expected.size()) return std::numeric_limits<double>::infinity();
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double e = expected[i], d = found[i] - e;
    off += d * d;
    all += e * e;
  }
  if (off == 0.0) return 0.0;
  const double ratio = std::sqrt(off / all);
  return std::isfinite(ratio) ? ratio : std::numeric_limits<double>::infinity();
}

}  // namespace lambent::bench
