// SPDX-License-Identifier: Apache-2.0
// usage: ports_write_cases FILE rgb9e5|r11g11b10f
// Writes random light in volumes that overlap, turned and scrolled, and what the CPU's lookup
// answers.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "field/lookup_volumes.h"
#include "field/volumes.h"
#include "ports/cases.h"
#include "support/random_store.h"

namespace lambent::ports {
namespace {

constexpr int kQueries = 4000;
const Bounds kRoom{{-3.0f, 0.0f, -2.0f}, {3.0f, 3.0f, 2.0f}};

mat3 turned(float radians) {
  const float c = std::cos(radians), s = std::sin(radians);
  return mat3(vec3(c, 0.0f, -s), vec3(0.0f, 1.0f, 0.0f), vec3(s, 0.0f, c)) *
         mat3(vec3(c, s, 0.0f), vec3(-s, c, 0.0f), vec3(0.0f, 0.0f, 1.0f));
}

/// Two volumes turned any way within two cascades whose viewer has walked about.
FieldSettings settings_of(bool r11g11b10f) {
  FieldSettings settings;
  settings.cascades = 2;
  settings.probe_count = {6, 4, 5};
  settings.probe_spacing = 0.4f;
  for (const float side : {-1.0f, 1.0f}) {
    ProbeVolume volume;
    volume.centre = {0.7f * side, 1.1f, 0.3f};
    volume.size = {1.6f, 1.2f, 1.4f};
    volume.axes = turned(side * 0.4f);
    volume.probe_spacing = 0.35f;
    settings.volumes.push_back(volume);
  }
  if (r11g11b10f) {
    settings.irradiance_format = IrradianceFormat::r11g11b10f;
    settings.irradiance_texels = 6;
    settings.distance_texels = 8;
  }
  return settings;
}

std::vector<ProbeGrid> walked_grids(const FieldSettings& settings) {
  std::vector<ProbeGrid> grids;
  const std::vector<Volume> volumes = plan_volumes(settings, kRoom).value();
  for (const Volume& volume : volumes) {
    ProbeGrid grid = volume.grid;
    if (volume.role.follows_viewer) {
      grid = following(grid, vec3(1.0f, 1.0f, 1.0f));
      grid = following(grid, vec3(-0.7f, 1.9f, 0.8f));
    }
    grids.push_back(grid);
  }
  return grids;
}

/// Every third probe of the second volume, and all of the last's, stand in solid matter.
void bury_some(ProbeStore& store) {
  const std::vector<vec2> none(
      static_cast<std::size_t>(store.distance_texels()) * store.distance_texels(), vec2(0.0f));
  for (int probe = store.grid(1).first; probe < store.grid(2).first; probe += 3) {
    store.blend_moments(probe, none, 1.0f, 0u);
  }
  for (int probe = store.grid(store.volumes() - 1).first; probe < store.probes(); probe += 2) {
    store.blend_moments(probe, none, 1.0f, 0u);
  }
}

template <class T>
void put(std::ofstream& file, std::span<const T> values) {
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size_bytes()));
}

bool write(const std::string& path, bool r11g11b10f) {
  const FieldSettings settings = settings_of(r11g11b10f);
  ProbeStore store(walked_grids(settings), settings);
  test::fill_randomly(store);
  bury_some(store);

  RandomStream random = make_random_stream(7, 8, 9);
  std::vector<FieldQuery> queries(kQueries);
  for (FieldQuery& query : queries) {
    const vec3 u(next_uniform2(random), next_uniform(random));
    query = {mix(kRoom.min - 0.5f, kRoom.max + 0.5f, u), test::random_unit(random),
             test::random_unit(random)};
  }
  std::vector<vec3> answers(queries.size());
  lookup_irradiance(store, {}, queries, answers);

  const CaseCounts counts = {static_cast<std::uint32_t>(store.volumes()),
                             static_cast<std::uint32_t>(store.probes()),
                             static_cast<std::uint32_t>(store.irradiance_words().size()),
                             static_cast<std::uint32_t>(store.distance_words().size()), kQueries};
  std::ofstream file(path, std::ios::binary);
  put(file, std::span(&counts, 1));
  put(file, store.grids());
  put(file, store.offset_words());
  put(file, store.irradiance_words());
  put(file, store.distance_words());
  put(file, std::span<const FieldQuery>(queries));
  put(file, std::span<const vec3>(answers));
  file.close();
  return file.good();
}

}  // namespace
}  // namespace lambent::ports

int main(int argc, char** argv) {
  const std::string format = argc == 3 ? argv[2] : "";
  if (format != "rgb9e5" && format != "r11g11b10f") {
    std::fprintf(stderr, "usage: ports_write_cases FILE rgb9e5|r11g11b10f\n");
    return 2;
  }
  if (lambent::ports::write(argv[1], format == "r11g11b10f")) return 0;
  std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
  return 1;
}
