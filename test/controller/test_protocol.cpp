#include <gtest/gtest.h>

#include "controller/protocol_run.h"
#include "fake_board.h"
#include "refusal.h"

namespace dmf::controller {
namespace {

Protocol read(const std::string& text, const BoardDescription& board) {
  return parse_protocol(text, "p.yaml", Layout(board), 80);
}

/// A bench that a protocol is run on.
struct ProtocolBench : Bench {
  ProtocolBench(const BoardDescription& description, const std::string& text)
      : Bench(description), run(read(text, description), coordinator) {
    board.rail = {};
  }
  bool finish(double seconds) {
    while (run.is_running()) {
      if (board.time > seconds) return false;
      look();
      run.update();
      if (const auto& rail = run.wanted_rail(); rail && rail_works) board.rail = *rail;
      if (const auto on = coordinator.on(); on && *on != board.on()) {
        board.set_electrodes(*on);
        coordinator.note_disabled(board.disabled);
      }
      board.step(0.1);
    }
    return true;
  }

  ProtocolRun run;
  bool rail_works = true;
};

const char* const kDilution = R"(
name: dilution
voltage: 63 V
frequency: 1 kHz
limits: {step_timeout: 2 s}
steps:
  - {name: settle, wait: 1 s}
  - merge: {channel: 0, into: 5}
  - split: {channel: 5, onto: [4, 6]}
  - parallel:
      - move: {channel: 4, to: 1}
      - move: {channel: 6, path: [7, 8]}
  - {name: press, channels: [8], duration: 3 s, volume_threshold: 0.9}
)";

TEST(Protocol, RunsItsStepsInTheirOrder) {
  ProtocolBench bench(grid_board(9, 1), kDilution);
  bench.board.amount = {{0, 1}, {5, 1}};
  ASSERT_TRUE(bench.finish(60));
  EXPECT_EQ(bench.run.status().state, State::succeeded) << bench.run.status().text;
  EXPECT_EQ(bench.run.step(), 5u);
  EXPECT_EQ(bench.run.status().progress, 1);
  EXPECT_EQ(bench.board.rail.voltage, 63);
  EXPECT_EQ(bench.board.rail.frequency, 1000);
  EXPECT_NEAR(bench.board.amount[1], 1, 0.05);
  EXPECT_NEAR(bench.board.amount[8], 1, 0.05);
}

TEST(Protocol, AStepWithAThresholdIsDoneEarlyOrFails) {
  const std::string early = "steps:\n  - {channels: [1], duration: 50 s, volume_threshold: 0.9}\n";
  ProtocolBench bench(grid_board(3, 1), early);
  bench.board.rail.enabled = true;
  bench.board.rail.voltage = 63;
  bench.board.amount[0] = 1;
  ASSERT_TRUE(bench.finish(5));
  EXPECT_EQ(bench.run.status().state, State::succeeded);
  ProtocolBench late(grid_board(3, 1),
                     "steps:\n  - {name: fill, channels: [2], duration: 2 s, volume_threshold: 0.9}\n");
  late.board.rail = {63, 0, true};
  late.board.amount[0] = 1;
  ASSERT_TRUE(late.finish(5));
  EXPECT_EQ(late.run.status().text,
            "step 1 (fill): below threshold: 0 % of electrode 2 is wetted after 2 s, wanted: 90 %");
}

TEST(Protocol, AFailureNamesItsStepAndLeavesTheLiquidHeld) {
  ProtocolBench bench(grid_board(9, 1), kDilution);
  bench.board.amount = {{0, 1}, {5, 1}};
  bench.board.stuck_off = {2};
  ASSERT_TRUE(bench.finish(60));
  EXPECT_EQ(bench.run.status().state, State::failed);
  EXPECT_TRUE(
      holds(bench.run.status().text, "step 2 (merge): merge from channel 0: electrode 2 does not answer"));
  EXPECT_EQ(bench.board.on(), (Channels{1, 5}));
}

TEST(Protocol, ARailThatDoesNotComeOnIsNamed) {
  ProtocolBench bench(grid_board(9, 1), kDilution);
  bench.board.amount = {{0, 1}, {5, 1}};
  bench.rail_works = false;
  ASSERT_TRUE(bench.finish(10));
  EXPECT_EQ(bench.run.status().text, "step 1 (settle): the rail does not take 63 V, 1000 Hz");
}

TEST(Protocol, CancelledInEveryStepItHoldsItsLiquid) {
  for (double until = 0; until < 12; until += 0.7) {
    ProtocolBench bench(grid_board(9, 1), kDilution);
    bench.board.amount = {{0, 1}, {5, 1}};
    bench.finish(until);
    bench.run.cancel();
    EXPECT_FALSE(bench.run.is_running());
    EXPECT_TRUE(bench.coordinator.is_idle());
    for (int k = 0; k < 20; ++k) {
      bench.look();
      bench.board.step(0.1);
    }
    if (!bench.coordinator.on()) continue;  // nothing had been moved yet
    for (const Droplet& droplet : bench.coordinator.droplets())
      EXPECT_TRUE(bench.board.on().count(droplet.main));
  }
}

TEST(Protocol, EverythingWrongIsToldAtOnceByLine) {
  const char* const text = R"(
voltge: 63 V
limits: {retries: -1}
steps:
  - {channels: [1, 9], duration: 0 s}
  - {wait: -2 s}
  - {wait: 3}
  - moves: {channel: 0, to: 1}
  - move: {channel: 0, to: 2}
  - move: {channel: 0, path: [3, 5]}
  - {wait: 1 s, split: {channel: 0}}
  - parallel: []
  - parallel: [{wait: 1 s}]
  - {voltage: 90 V, mix: {channel: 0, laps: 0}}
  - {channels: [], duration: 1 s, volume_threshold: 0.5}
)";
  const std::string refused = refusal([&] { read(text, grid_board(3, 2, {2})); });
  for (const char* line : {
           "p.yaml:2: voltge: unknown key, did you mean `voltage`?",
           "p.yaml:3: limits.retries: -1, allowed: a whole number from 0 to 100",
           "p.yaml:5: steps[0].channels: channel 9 does not exist, allowed: 0-1, 3-5",
           "p.yaml:5: steps[0].duration: 0 s, allowed: more than 0 s, with a unit (s, ms, us, ns)",
           "p.yaml:6: steps[1].wait: -2 s, allowed: more than 0",
           "p.yaml:7: steps[2].wait: 3, allowed: more than 0 s, with a unit",
           "p.yaml:8: steps[3].moves: unknown key, did you mean `move`?",
           "p.yaml:8: steps[3]: nothing to do, allowed: one of channels, wait, parallel, move",
           "p.yaml:9: steps[4].move.to: 2, allowed: a channel of 0-1, 3-5",
           "p.yaml:10: steps[5].move.path: from 3 to 5, allowed: a neighbour of 3, one of 0, 4",
           "p.yaml:11: steps[6]: wait, split at once, allowed: one of",
           "p.yaml:12: steps[7].parallel: no operation, allowed: one or more",
           "p.yaml:13: steps[8].parallel[0]: nothing to do, allowed: one of move, split",
           "p.yaml:14: steps[9].voltage: 90 V, allowed: (0, 80] V",
           "p.yaml:14: steps[9].mix.laps: 0, allowed: a whole number from 1",
           "p.yaml:15: steps[10].volume_threshold: allowed: beside channels that are on",
       }) {
    EXPECT_TRUE(holds(refused, line));
  }
  EXPECT_TRUE(holds(refusal([&] { read("name: empty\n", grid_board(2, 1)); }), "p.yaml:1: steps: no steps"));
}

}  // namespace
}  // namespace dmf::controller
