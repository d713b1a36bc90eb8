// SPDX-License-Identifier: Apache-2.0
// usage: ports_write_cases FILE rgb9e5|r11g11b10f
// Writes random light in volumes that overlap, turned and scrolled, and what the CPU's lookup
// answers.
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "field/lookup/lookup_volumes.h"
#include "ports/cases.h"
#include "support/walked_volumes.h"

namespace lambent::ports {
namespace {

constexpr int kQueries = 4000;
FieldSettings settings_of(bool r11g11b10f) {
  FieldSettings settings = test::walked_settings();
  if (r11g11b10f) {
    settings.irradiance_format = IrradianceFormat::r11g11b10f;
    settings.irradiance_texels = 6;
    settings.distance_texels = 8;
  }
  return settings;
}

template <class T>
void put(std::ofstream& file, std::span<const T> values) {
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size_bytes()));
}

bool write(const std::string& path, bool r11g11b10f) {
  const ProbeStore store = test::walked_store(settings_of(r11g11b10f));
  const std::vector<FieldQuery> queries = test::walked_queries(kQueries);
  std::vector<vec3> answers(queries.size());
  lookup_irradiance(store, {}, queries, answers);
  std::vector<SeenPoint> points;
  points.reserve(queries.size());
  for (const FieldQuery& query : queries) {
    points.push_back({query.position_ws, query.normal_ws, query.to_viewer_ws});
  }

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
  put(file, std::span<const SeenPoint>(points));
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
