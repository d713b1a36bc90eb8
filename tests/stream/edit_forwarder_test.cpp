// SPDX-License-Identifier: Apache-2.0
// Edits on their way to the server that computes the light.
#include <gtest/gtest.h>

#include "stream/server/edit_forwarder.h"

namespace lambent::stream::edit_forwarder_test {
namespace {

class Forwarding : public ::testing::Test {
 protected:
  static std::shared_ptr<ClientLink> client(std::uint32_t wants = kWantsPicture) {
    Hello hello;
    hello.wants = wants;
    return std::make_shared<ClientLink>(
        hello, Role::change, [] {}, [] {});
  }
  static LightInput lamp(std::uint32_t input, std::uint32_t light, float intensity) {
    LightInput edit;
    edit.input = input;
    edit.light = light;
    edit.edits = kEditsIntensity;
    edit.intensity = glm::vec3(intensity);
    return edit;
  }
  /// What a client was told last of a kind, if anything.
  template <class T>
  static std::optional<T> told(ClientLink& link) {
    std::optional<T> last;
    while (const SharedBytes bytes = link.next(Clock::now())) {
      const auto message = parse_message(*bytes, Sender::server);
      if (message && std::holds_alternative<T>(*message)) last = std::get<T>(*message);
    }
    return last;
  }

  Clock::time_point now = Clock::now();
  EditForwarder edits{now};
  std::shared_ptr<ClientLink> one = client(), other = client(kWantsLight);
};

TEST_F(Forwarding, OneOfATargetIsUnderWayAndLaterOnesAreMerged) {
  edits.add(lamp(5, 0, 1.0f), one);
  const auto first = edits.due(now);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(std::get<LightInput>(first[0]).input, 1u) << "numbers are our own";
  edits.add(lamp(6, 0, 2.0f), one);
  edits.add(lamp(9, 0, 3.0f), other);
  EXPECT_TRUE(edits.due(now).empty());
  edits.applied({1, 30});
  const auto second = edits.due(now);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(std::get<LightInput>(second[0]).intensity.x, 3.0f);
  EXPECT_EQ(std::get<LightInput>(second[0]).input, 2u);
}

TEST_F(Forwarding, PicturesShowAnInputOnceItsLightIsThere) {
  edits.add(lamp(5, 0, 1.0f), one);
  EXPECT_EQ(edits.shown(*one, 7), 4u);
  EXPECT_EQ(edits.shown(*other, 7), 7u);
  edits.due(now);
  edits.applied({1, 30});
  edits.lit(29);
  EXPECT_EQ(edits.shown(*one, 7), 4u);
  edits.lit(30);
  EXPECT_EQ(edits.shown(*one, 7), 7u);
}

TEST_F(Forwarding, ClientsOfLightAreToldWhichOfTheirInputsWereApplied) {
  edits.add(lamp(5, 0, 1.0f), other);
  edits.add(lamp(6, 1, 1.0f), other);
  edits.due(now);
  edits.applied({1, 30});
  auto applied = told<InputsApplied>(*other);
  ASSERT_TRUE(applied);
  EXPECT_EQ(applied->input, 5u);
  EXPECT_EQ(applied->update, 30u);
  edits.applied({2, 31});
  applied = told<InputsApplied>(*other);
  ASSERT_TRUE(applied);
  EXPECT_EQ(applied->input, 6u);
  EXPECT_FALSE(told<InputsApplied>(*one));
}

TEST_F(Forwarding, ItStaysWithinWhatAServerTakesOfAClient) {
  for (std::uint32_t i = 0; i < 200; ++i) edits.add(lamp(i + 1, i, 1.0f), one);
  EXPECT_EQ(edits.due(now).size(), EditForwarder::kMaxUnderWay);
  edits.applied({static_cast<std::uint32_t>(EditForwarder::kMaxUnderWay), 1});
  EXPECT_EQ(edits.due(now).size(), EditForwarder::kMaxUnderWay);
  edits.applied({1000, 2});
  EXPECT_LT(edits.due(now).size(), 10u) << "too many a second";
  EXPECT_FALSE(edits.due(now + std::chrono::seconds(1)).empty());
}

TEST_F(Forwarding, WhoseEditIsRefusedOrLostIsTold) {
  edits.add(lamp(5, 0, 1.0f), one);
  edits.due(now);
  edits.refused("no such light");
  auto refusal = told<Refusal>(*one);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, Refusal::Code::refused_input);
  EXPECT_EQ(refusal->text, "no such light");
  edits.forget("gone");
  EXPECT_TRUE(told<Refusal>(*one));
  EXPECT_EQ(edits.shown(*one, 7), 7u);

  // One that nobody answers holds up no later one
  edits.add(lamp(8, 0, 1.0f), one);
  edits.due(now);
  edits.add(lamp(9, 0, 2.0f), one);
  EXPECT_EQ(edits.due(now + 2 * EditForwarder::kPatience).size(), 1u);
}

}  // namespace
}  // namespace lambent::stream::edit_forwarder_test
