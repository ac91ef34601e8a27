#include <gtest/gtest.h>

#include "refusal.h"
#include "three_pads.h"

// A chip's run: what happens when, and how it is played again, started over, saved and stopped.

namespace dmf::chip {
namespace {

using namespace testing;

TEST(Schedule, TakesEffectAtItsStepAfterSettling) {
  Experiment chip = start(
      "settle_time: 0.1\n"
      "schedule:\n"
      "  - {at: 0, set_hv: {voltage: 50}}\n"
      "  - {at: 0.05, set_electrodes: {channels: [2]}}\n");
  run(chip, 10);
  EXPECT_FALSE(chip.rail().enabled) << "due before the step that follows";
  run(chip, 1);
  EXPECT_EQ(chip.rail().voltage, 50);
  run(chip, 4);
  EXPECT_FALSE(chip.electrodes()[2].on);
  run(chip, 1);
  EXPECT_TRUE(chip.electrodes()[2].on);
  const auto replies = chip.take_scheduled_replies();
  ASSERT_EQ(replies.size(), 2u);
  EXPECT_EQ(replies[0].reply.step, 10u);
  EXPECT_EQ(replies[1].reply.step, 15u);
  EXPECT_TRUE(chip.history().empty()) << "it follows from the scene";
}

TEST(Pattern, IsTimedFromWhenItWasLoaded) {
  Experiment chip = start();
  run(chip, 7);
  ASSERT_TRUE(chip.apply(LoadPattern{"walk"}).success);
  EXPECT_TRUE(chip.electrodes()[1].on) << "its time 0 is now";
  run(chip, 5);
  EXPECT_FALSE(chip.electrodes()[2].on);
  run(chip, 1);
  EXPECT_TRUE(chip.electrodes()[2].on);
  ASSERT_EQ(chip.history().size(), 1u);
  EXPECT_EQ(chip.history()[0].step, 7u);
}

TEST(Pattern, AnotherOneTakesItsPlace) {
  Experiment chip = start();
  chip.apply(LoadPattern{"walk"});
  chip.apply(LoadPattern{"stop"});
  run(chip, 10);
  EXPECT_TRUE(chip.electrodes()[1].on);
  EXPECT_FALSE(chip.electrodes()[2].on);
}

TEST(Pattern, ACommandThatIsRefusedIsSkippedAndTold) {
  Experiment chip = start();
  const std::uint64_t before = hash(chip);
  ASSERT_TRUE(chip.apply(LoadPattern{"crowd"}).success);
  EXPECT_EQ(hash(chip), before);
  const auto replies = chip.take_scheduled_replies();
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_FALSE(replies[0].reply.success);
  EXPECT_TRUE(holds(replies[0].reply.message, "occupied"));
}

/// Some steps with commands between them.
void drive(Experiment& chip) {
  run(chip, 5);
  chip.apply(SetHv{63, 1000, true});
  chip.apply(SetElectrodes{{7}});  // refused
  chip.apply(LoadPattern{"walk"});
  run(chip, 9);
  chip.apply(DispenseDroplet{1e-4, 0, 3.4e-14});
  chip.apply(with(&AddMicroparticle::contact_angle_deg, 109.0));
  run(chip, 10);
  chip.apply(SetBodyForces{{0, 0, -1e3 / 3}, {}});
  run(chip, 20);
}

TEST(History, AndSceneGiveTheSameRunAgain) {
  const std::string schedule =
      "schedule: [{at: 0.2, set_electrode_voltages: {channels: [0], voltages: [30]}}]\n";
  Experiment first = start(schedule);
  drive(first);
  Experiment again = start(schedule);
  for (const auto& [step, command] : first.history()) {
    while (again.steps() < step) again.step();
    ASSERT_TRUE(again.apply(command_from_json(to_json(command))).success);
  }
  while (again.steps() < first.steps()) again.step();
  EXPECT_EQ(hash(again), hash(first));
  EXPECT_TRUE(state_of(again) == state_of(first));
}

TEST(Reset, StartsTheSceneOverAndForgetsTheCommands) {
  Experiment chip = start("schedule: [{at: 0.03, set_hv: {voltage: 20}}]\n");
  const std::uint64_t at_start = hash(chip);
  drive(chip);
  const std::uint64_t at_end = hash(chip);
  const Reply reply = chip.apply(Reset{});
  EXPECT_TRUE(reply.success);
  EXPECT_EQ(reply.step, 0u);
  EXPECT_EQ(chip.steps(), 0u);
  EXPECT_EQ(hash(chip), at_start);
  EXPECT_FALSE(chip.rail().enabled);
  ASSERT_EQ(chip.history().size(), 1u);
  EXPECT_EQ(name_of(chip.history()[0].command), "reset");
  drive(chip);
  EXPECT_EQ(hash(chip), at_end);
}

TEST(Seed, IsTheScenesUnlessAnotherIsGiven) {
  Experiment one(scene("seed: 5\n"), {1, "auto"});
  Experiment two(scene(), {1, "auto"}, 5);
  Experiment other(scene(), {1, "auto"}, 6);
  for (Experiment* chip : {&one, &two, &other}) run(*chip, 10);
  EXPECT_EQ(hash(one), hash(two));
  EXPECT_NE(hash(one), hash(other));
  other.apply(Reset{});
  EXPECT_EQ(other.simulation().parameters().seed, 6u);
}

TEST(SavedRun, GoesOnWithTheSameBits) {
  Experiment chip(scene(), {1, "auto"}, 9);
  run(chip, 5);
  chip.apply(SetElectrodeVoltages{{0}, {12.345}});
  chip.apply(LoadPattern{"walk"});
  run(chip, 3);
  chip.apply(SetWettability{{-1e-4 / 3, 1e-4 / 3}, {120, 100}});
  const std::string saved = chip.save();
  Experiment other = start();
  run(other, 2);
  other.load(saved);
  EXPECT_EQ(other.steps(), 8u);
  EXPECT_TRUE(state_of(other) == state_of(chip));
  for (Experiment* each : {&chip, &other}) drive(*each);
  EXPECT_TRUE(state_of(other) == state_of(chip));
  EXPECT_EQ(other.history().size(), chip.history().size());
}

TEST(SavedRun, OfAnotherSceneOrDamagedIsRefusedUnchanged) {
  Experiment chip = start();
  run(chip, 3);
  const std::string saved = chip.save();
  run(chip, 3);
  const std::string before = state_of(chip);
  for (const std::string& bytes : {std::string(), std::string("{}\n"), saved.substr(0, saved.size() / 2),
                                   saved + "x", "x" + saved, saved.substr(0, 40), std::string("[1]\n")}) {
    EXPECT_THROW(chip.load(bytes), engine::InvalidInput);
    EXPECT_TRUE(state_of(chip) == before);
  }
  Experiment other(parse_scene(kScene, "other.yaml"), {1, "auto"});
  EXPECT_EQ(refusal([&] { other.load(saved); }), "saved run: of scene scene, allowed: other");
}

TEST(Fault, StopsTheRunUntilReset) {
  // Repulsion far beyond what the time step can follow.
  Experiment chip = start("liquid: {repulsion: 500, random_amplitude: 50}\ntime_step: 0.1\n");
  EXPECT_THROW(run(chip, 5000), engine::Instability);
  ASSERT_FALSE(chip.fault().empty());
  const std::uint64_t steps = chip.steps();
  EXPECT_THROW(chip.step(), engine::Instability);
  const Reply refused = chip.apply(SetElectrodes{{1}});
  EXPECT_FALSE(refused.success);
  EXPECT_TRUE(holds(refused.message, chip.fault()));
  EXPECT_TRUE(holds(refused.message, "allowed: reset"));
  EXPECT_EQ(chip.steps(), steps);
  EXPECT_TRUE(chip.apply(Reset{}).success);
  EXPECT_TRUE(chip.fault().empty());
  EXPECT_EQ(chip.steps(), 0u);
  EXPECT_NO_THROW(chip.step());
}

}  // namespace
}  // namespace dmf::chip
