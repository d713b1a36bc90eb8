// SPDX-License-Identifier: Apache-2.0
// All executors of the field's passes run them in one order, under the same names.
#include <algorithm>
#include <string>
#include <vector>

#include "twin/engine_structure.h"
#include "twin/recorded_field.h"

namespace lambent::pass_order_test {
namespace {

using test::cornell, test::recorded_settings;
using vulkan::RecordedField;

using Names = std::vector<std::string>;

Names names_of(const std::vector<PassTime>& passes) {
  Names names;
  for (const PassTime& pass : passes) names.push_back(pass.name);
  return names;
}

/// Passes of an update of a field that places its probes before it traces them, from `first` on: as
/// those of one that places them afterwards follow one another.
Names from(const std::string& first, Names names) {
  std::rotate(names.begin(), std::find(names.begin(), names.end(), first), names.end());
  return names;
}

/// Passes of the second update of a field in a world.
Names passes_in(const World& world, const FieldSettings& settings) {
  IrradianceField field = IrradianceField::make(settings, cornell().bounds()).value();
  field.update(world);
  return names_of(field.update(world).passes);
}

class PassOrder : public test::RecordedFieldTest {
 protected:
  static World on_device() { return World(cornell().scene, shared_device()); }
};

TEST_F(PassOrder, OfAnUpdateIsTheSameOnTheProcessorAndOnADevice) {
  const World there = on_device();
  FieldSettings settings = recorded_settings();
  settings.corrections = true;
  for (const Visibility visibility : {Visibility::moments, Visibility::hybrid}) {
    settings.visibility = visibility;
    const Names on_cpu = passes_in(cornell().world, settings);
    EXPECT_EQ(on_cpu.front(), "placement");
    EXPECT_EQ(on_cpu.back(), "store");
    EXPECT_EQ(std::count(on_cpu.begin(), on_cpu.end(), "corrections"), 1);
    EXPECT_EQ(passes_in(there, settings), on_cpu);
  }
}

class RecordedPassOrder : public PassOrder, public testing::WithParamInterface<Visibility> {};

TEST_P(RecordedPassOrder, IsThatOfTheProcessors) {
  FieldSettings settings = recorded_settings();
  settings.visibility = GetParam();
  const test::EngineStructure structure(device(), cornell().scene);
  const test::HostEngine engine = {.structure = structure.handle()};
  RecordedField field = make(settings, {.frames_in_flight = 1});
  update(field, {}, engine);
  field.plan();
  Names expected = from("schedule", passes_in(cornell().world, settings));
  // The host plays the engine here, and has its own way to find hits
  std::erase(expected, "trace");
  EXPECT_EQ(names_of(field.pass_times()), expected);

  // Rays that are traced again after edits go the same way; what they leave is compared, not
  // blended
  WorldChanges edits;
  edits.emission = true;
  update(field, {.changes = std::span(&edits, 1)}, engine);
  field.plan().value();
  expected.insert(expected.begin() + 1, "edits");
  EXPECT_EQ(names_of(field.pass_times()), expected);

  // Of parts that are not recorded nothing is told
  field.plan();
  EXPECT_TRUE(field.pass_times().empty());
}

INSTANTIATE_TEST_SUITE_P(Modes, RecordedPassOrder,
                         testing::Values(Visibility::moments, Visibility::hybrid));

}  // namespace
}  // namespace lambent::pass_order_test
