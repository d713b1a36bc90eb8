// SPDX-License-Identifier: Apache-2.0
// Bakes that go on from a checkpoint.
#include "bake/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "core/files/atomic_file.h"
#include "core/files/file_bytes.h"
#include "support/field_contents.h"
#include "support/field_scenes.h"
#include "support/temporary_directory.h"
#include "support/thread_ranks.h"

namespace lambent::checkpoint_test {
namespace {

using test::Contents;
using test::contents_of;
using test::make_field;
using test::run_as_ranks;
using test::Stage;
using ::testing::HasSubstr;

FieldSettings small_field() {
  FieldSettings settings;
  settings.probe_count = {5, 6, 7};
  settings.rays_per_probe = 64;
  return settings;
}

const UpdateRequest kRequest{.viewer_ws = glm::vec3(0.3f, 0.5f, 1.5f)};

class ACheckpoint : public ::testing::Test {
 protected:
  test::TemporaryDirectory folder;
  std::string path = folder.file("a.checkpoint");

  /// A field that has had some updates, of which a checkpoint is kept.
  void keep(const Stage& stage, const FieldSettings& settings, Ranks& ranks, int updates) const {
    IrradianceField field = make_field(stage, settings, 0);
    share_work(field, ranks);
    Contents ignored;
    test::update(field, stage, kRequest, updates, ignored);
    const auto saved = save_checkpoint(path, field, stage.world, kRequest.viewer_ws);
    if (!saved) throw std::runtime_error(saved.error().message());
  }
  /// What a field holds that goes on from the checkpoint.
  Contents gone_on(const Stage& stage, const FieldSettings& settings, Ranks& ranks,
                   int updates) const {
    IrradianceField field = make_field(stage, settings, 0);
    share_work(field, ranks);
    const auto read = read_checkpoint(path, stage.world, kRequest.viewer_ws, field);
    if (!read) throw std::runtime_error(read.error().message());
    resume_from(*read, stage.world, kRequest.viewer_ws, field);
    Contents ignored;
    test::update(field, stage, kRequest, updates, ignored);
    return contents_of(field, stage);
  }
  Contents uninterrupted(const Stage& stage, const FieldSettings& settings, int updates) const {
    IrradianceField field = make_field(stage, settings, 0);
    Contents ignored;
    test::update(field, stage, kRequest, updates, ignored);
    return contents_of(field, stage);
  }
  void expect_to_go_on(const Stage& stage, const FieldSettings& settings) const {
    keep(stage, settings, one_rank(), 2);
    EXPECT_TRUE(gone_on(stage, settings, one_rank(), 3) == uninterrupted(stage, settings, 5));
  }
  std::string refusal(const Stage& stage, const FieldSettings& settings,
                      const std::optional<glm::vec3>& viewer_ws) const {
    const IrradianceField field = make_field(stage, settings, 0);
    const auto read = read_checkpoint(path, stage.world, viewer_ws, field);
    return read ? "" : read.error().message();
  }
};

TEST_F(ACheckpoint, LeadsToTheSameBits) {
  expect_to_go_on(Stage("cornell"), small_field());
}

TEST_F(ACheckpoint, LeadsToTheSameBitsWhereVolumesFollowTheViewer) {
  FieldSettings settings = small_field();
  settings.probe_count = {8, 8, 8};
  settings.cascades = 2;
  expect_to_go_on(Stage("cornell"), settings);
}

TEST_F(ACheckpoint, LeadsToTheSameBitsWithHybridVisibility) {
  FieldSettings settings = small_field();
  settings.visibility = Visibility::hybrid;
  expect_to_go_on(Stage("two-rooms"), settings);
}

TEST_F(ACheckpoint, LeadsToTheSameBitsWithCountedBounces) {
  FieldSettings settings = small_field();
  settings.max_bounces = 2;
  expect_to_go_on(Stage("cornell"), settings);
}

TEST_F(ACheckpoint, LeadsToTheSameBitsOnAnotherNumberOfRanks) {
  const Stage stage("cornell");
  const Contents expected = uninterrupted(stage, small_field(), 5);
  struct Counts {
    int before, after;
  };
  for (const Counts counts : {Counts{1, 3}, Counts{3, 1}, Counts{4, 2}}) {
    run_as_ranks(counts.before, [&](Ranks& ranks) { keep(stage, small_field(), ranks, 2); });
    run_as_ranks(counts.after, [&](Ranks& ranks) {
      EXPECT_TRUE(gone_on(stage, small_field(), ranks, 3) == expected)
          << counts.before << " " << counts.after;
    });
  }
}

TEST_F(ACheckpoint, IsTheSameFileOnAnyNumberOfRanks) {
  const Stage stage("cornell");
  keep(stage, small_field(), one_rank(), 2);
  const std::vector<std::byte> expected = read_file(path).value();
  run_as_ranks(3, [&](Ranks& ranks) { keep(stage, small_field(), ranks, 2); });
  EXPECT_TRUE(read_file(path).value() == expected);
}

TEST_F(ACheckpoint, IsRefusedByAnotherBake) {
  const Stage stage("cornell");
  keep(stage, small_field(), one_rank(), 1);
  EXPECT_EQ(refusal(stage, small_field(), kRequest.viewer_ws), "");
  const std::string other = "is of another bake";
  EXPECT_THAT(refusal(Stage("two-rooms"), small_field(), kRequest.viewer_ws), HasSubstr(other));
  EXPECT_THAT(refusal(stage, small_field(), glm::vec3(0.0f)), HasSubstr(other));
  FieldSettings settings = small_field();
  settings.rays_per_probe = 65;
  EXPECT_THAT(refusal(stage, settings, kRequest.viewer_ws), HasSubstr(other));
  settings = small_field();
  settings.seed = 2;
  EXPECT_THAT(refusal(stage, settings, kRequest.viewer_ws), HasSubstr(other));
}

TEST_F(ACheckpoint, IsRefusedWhereItIsBroken) {
  const Stage stage("cornell");
  keep(stage, small_field(), one_rank(), 1);
  const std::vector<std::byte> whole = read_file(path).value();
  for (std::size_t size = 0; size < whole.size(); size += whole.size() / 40) {
    ASSERT_TRUE(write_file_atomically(path, std::span(whole).first(size)));
    EXPECT_NE(refusal(stage, small_field(), kRequest.viewer_ws), "") << size;
  }
  for (std::size_t place = 0; place < whole.size(); place += whole.size() / 97) {
    std::vector<std::byte> changed = whole;
    changed[place] ^= std::byte{16};
    ASSERT_TRUE(write_file_atomically(path, changed));
    EXPECT_NE(refusal(stage, small_field(), kRequest.viewer_ws), "") << place;
  }
}

}  // namespace
}  // namespace lambent::checkpoint_test
