// SPDX-License-Identifier: Apache-2.0
// What clients change in the shared scene, and what is kept for them in between.
#include "stream/edits/edits.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "scenes/builtin.h"
#include "stream/server/client_link.h"

namespace lambent::stream::edits_test {
namespace {

LightInput light_at(const glm::vec3& position, std::uint32_t light = 0) {
  LightInput edit;
  edit.light = light;
  edit.position_ws = position;
  return edit;
}

TEST(SceneEditor, AppliesEditsAndTheWorldFollows) {
  Scene scene = *scenes::make("cornell-spot");
  World world(scene);
  SceneEditor editor(scene, world);
  const Light before = scene.lights[0];
  const std::array<Edit, 1> edits = {light_at({1.0f, 2.0f, 3.0f})};
  const auto refused = editor.apply(edits);
  ASSERT_TRUE(refused);
  EXPECT_TRUE(refused->empty());
  EXPECT_EQ(scene.lights[0].position_ws, glm::vec3(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(scene.lights[0].intensity, before.intensity) << "was not to be edited";
  EXPECT_EQ(world.revision(), 1u);
}

TEST(SceneEditor, RefusesWhatIsNotThereOrCannotBeAndKeepsTheRest) {
  Scene scene = *scenes::make("cornell-spot");
  World world(scene);
  SceneEditor editor(scene, world);
  const glm::mat4 place = scene.instances[0].world_from_object;
  ObjectInput flat;  // has no inverse
  flat.world_from_object = glm::mat4x3(0.0f);
  ObjectInput missing;
  missing.instance = 1000;
  const std::array<Edit, 5> edits = {light_at({0.0f, 1.0f, 0.0f}, 7), flat,
                                     light_at({1.0f, 1.0f, 1.0f}), missing, TimeOfDay{}};
  const auto refused = editor.apply(edits);
  ASSERT_TRUE(refused);
  std::vector<std::size_t> which;
  for (const auto& one : *refused) which.push_back(one.edit);
  std::sort(which.begin(), which.end());
  EXPECT_EQ(which, (std::vector<std::size_t>{0, 1, 3, 4})) << "the scene has no sun, either";
  EXPECT_EQ(scene.lights[0].position_ws, glm::vec3(1.0f));
  EXPECT_EQ(scene.instances[0].world_from_object, place);
  // The world can go on
  const std::array<Edit, 1> more = {light_at({2.0f, 1.0f, 1.0f})};
  EXPECT_TRUE(editor.apply(more)->empty());
}

TEST(SceneEditor, TheSunRisesInTheEastAndSetsInTheWest) {
  EXPECT_NEAR(sun_direction(6.0f).x, -1.0f, 1e-5f);
  EXPECT_NEAR(sun_direction(18.0f).x, 1.0f, 1e-5f);
  EXPECT_LT(sun_direction(12.0f).y, -0.7f);
  EXPECT_LT(sun_direction(12.0f).z, -0.7f) << "light of the south travels north";
  EXPECT_EQ(sun_share(12.0f), 1.0f);
  EXPECT_EQ(sun_share(0.0f), 0.0f);

  Scene scene = *scenes::make("cornell-spot");
  Light sun;
  sun.type = Light::Type::directional;
  sun.intensity = glm::vec3(20.0f);
  scene.lights.push_back(sun);
  World world(scene);
  SceneEditor editor(scene, world);
  const auto set = [&](float hours) {
    const std::array<Edit, 1> edits = {TimeOfDay{1, hours}};
    EXPECT_TRUE(editor.apply(edits)->empty());
    return scene.lights.back().intensity.x;
  };
  EXPECT_EQ(set(0.0f), 0.0f);
  EXPECT_EQ(set(12.0f), 20.0f) << "what it had before the night";
}

class Link : public ::testing::Test {
 protected:
  std::optional<Refusal> receive(const Message& message) { return link.receive(message, now); }

  Clock::time_point now;
  int woken = 0;
  ClientLink link{Hello{}, Role::change, [] {}, [this] { ++woken; }};
};

TEST_F(Link, KeepsTheLatestOfEachTargetAlone) {
  for (std::uint32_t i = 1; i <= 100; ++i) {
    LightInput edit = light_at({static_cast<float>(i), 0.0f, 0.0f}, i % 2);
    edit.input = i;
    EXPECT_FALSE(receive(edit));
    CameraInput camera;
    camera.input = i;
    EXPECT_FALSE(receive(camera));
  }
  const ClientInputs inputs = link.take_inputs(true);
  EXPECT_EQ(inputs.edits.size(), 2u);
  EXPECT_EQ(std::get<LightInput>(inputs.edits[1]).position_ws.x, 100.0f);
  EXPECT_EQ(inputs.camera->input, 100u);
  EXPECT_FALSE(link.take_inputs(true).any());
  EXPECT_GT(woken, 0);
}

TEST_F(Link, AnEditKeepsWhatALaterOneOfTheSameLightLeavesAlone) {
  receive(light_at({1.0f, 2.0f, 3.0f}));
  LightInput brighter;
  brighter.edits = kEditsIntensity;
  brighter.intensity = glm::vec3(5.0f);
  receive(brighter);
  const ClientInputs inputs = link.take_inputs(true);
  ASSERT_EQ(inputs.edits.size(), 1u);
  const auto& both = std::get<LightInput>(inputs.edits[0]);
  EXPECT_EQ(both.edits, kEditsPosition | kEditsIntensity);
  EXPECT_EQ(both.position_ws, glm::vec3(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(both.intensity, glm::vec3(5.0f));
}

TEST_F(Link, DoesNotSayThatAPictureShowsEditsThatWait) {
  LightInput edit = light_at(glm::vec3(0.0f));
  edit.input = 5;
  CameraInput camera;
  camera.input = 6;
  receive(edit);
  receive(camera);
  EXPECT_EQ(link.take_inputs(false).last_input, 4u);
  EXPECT_EQ(link.take_inputs(true).last_input, 6u);
  EXPECT_EQ(link.take_inputs(false).last_input, 6u);
}

TEST_F(Link, RefusesMoreThanItKeeps) {
  std::optional<Refusal> refusal;
  for (std::uint32_t i = 0; i <= ClientLink::kMaxEdits && !refusal; ++i) {
    refusal = receive(light_at(glm::vec3(0.0f), i));
  }
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::too_many);
  EXPECT_LE(link.take_inputs(true).edits.size(), ClientLink::kMaxEdits);
}

TEST_F(Link, NoMoreThanTwoPicturesAreUnderWay) {
  Picture picture;
  picture.size = {64, 64};
  picture.bytes.resize(1000);
  for (picture.number = 1; picture.number <= 2; ++picture.number) {
    ASSERT_TRUE(link.ready_for_picture());
    link.put_picture(picture);
    EXPECT_FALSE(link.ready_for_picture()) << "one waits";
    EXPECT_GT(link.waiting_bytes(), 1000u);
    ASSERT_TRUE(link.next(now));
    EXPECT_EQ(link.waiting_bytes(), 0u);
  }
  EXPECT_FALSE(link.ready_for_picture()) << "nothing was heard of them";
  now += std::chrono::milliseconds(30);
  receive(Received{1, 1.0f});
  EXPECT_TRUE(link.ready_for_picture());
  ASSERT_EQ(link.take_inputs(true).arrivals.size(), 1u);
  // What was never sent does not count
  receive(Received{1000, 1.0f});
  link.put_picture(picture);
  receive(Received{1000, 1.0f});
  EXPECT_FALSE(link.ready_for_picture());
}

TEST_F(Link, TellsTheTimeOnThePathFromThatOfProgramsThatAreLate) {
  Picture picture;
  picture.size = {64, 64};
  picture.number = 1;
  link.put_picture(picture);
  ASSERT_TRUE(link.next(now, PathTime(5'000)));
  now += std::chrono::milliseconds(300);
  EXPECT_FALSE(link.receive(Received{1, 1.0f}, now, PathTime(12'000)));
  ++picture.number;
  link.put_picture(picture);
  ASSERT_TRUE(link.next(now, PathTime(12'000)));
  now += std::chrono::milliseconds(300);
  EXPECT_FALSE(link.receive(Received{2, 1.0f}, now)) << "the system does not tell";
  const std::vector<Arrival> arrivals = link.take_inputs(true).arrivals;
  ASSERT_EQ(arrivals.size(), 2u);
  EXPECT_EQ(arrivals[0].round_trip_ms, 300.0);
  EXPECT_EQ(arrivals[0].path_ms, 7.0);
  EXPECT_EQ(arrivals[1].path_ms, 300.0);
}

TEST_F(Link, NoticesOfAConnectionThatIsStuckAreBounded) {
  for (int i = 0; i < 1000; ++i) link.put_notice(ServerStats{});
  std::size_t count = 0;
  while (link.next(now)) ++count;
  EXPECT_EQ(count, ClientLink::kMaxNotices);
}

TEST(ClientLinkRoles, WhoMayLookMayNotChange) {
  ClientLink link(
      Hello{}, Role::view, [] {}, [] {});
  EXPECT_FALSE(link.receive(CameraInput{}, {}));
  for (const Message& edit :
       {Message(LightInput{}), Message(ObjectInput{}), Message(SunInput{}), Message(TimeOfDay{})}) {
    const auto refusal = link.receive(edit, {});
    ASSERT_TRUE(refusal) << edit.index();
    EXPECT_EQ(refusal->code, Refusal::Code::not_allowed);
  }
  EXPECT_FALSE(link.take_inputs(true).edits.size());
}

}  // namespace
}  // namespace lambent::stream::edits_test
