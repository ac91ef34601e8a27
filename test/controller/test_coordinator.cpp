#include <gtest/gtest.h>

#include "fake_board.h"
#include "refusal.h"

namespace dmf::controller {
namespace {

Limits quick() { return {0.8, 2, 2, 0}; }

/// How much liquid stands on and around an electrode.
double around(Bench& bench, Channel channel) {
  double sum = 0;
  for (const Channel near : bench.coordinator.layout().near(channel)) sum += bench.board.amount[near];
  return sum;
}

TEST(Coordinator, DropletsThatCrossDoNotMerge) {
  Bench bench(grid_board(6, 4));
  bench.board.amount = {{6, 1}, {11, 1}};
  bench.look();
  const auto right = bench.coordinator.start(Move{6, 11, {}, quick()});
  const auto left = bench.coordinator.start(Move{11, 6, {}, quick()});
  ASSERT_TRUE(bench.run(60));
  EXPECT_EQ(bench.status(right).state, State::succeeded) << bench.status(right).text;
  EXPECT_EQ(bench.status(left).state, State::succeeded) << bench.status(left).text;
  EXPECT_NEAR(around(bench, 6), 1, 1e-6);
  EXPECT_NEAR(around(bench, 11), 1, 1e-6);
}

TEST(Coordinator, FourDropletsTakeEachOthersPlacesApart) {
  Bench bench(grid_board(7, 7));
  bench.board.amount = {{0, 1}, {6, 1}, {42, 1}, {48, 1}};
  bench.look();
  std::vector<Coordinator::Key> keys;
  for (const auto& [from, to] : std::vector<std::pair<Channel, Channel>>{{0, 48}, {48, 0}, {6, 42}, {42, 6}})
    keys.push_back(bench.coordinator.start(Move{from, to, {}, quick()}));
  std::size_t fewest = 4;
  bench.each_look = [&] { fewest = std::min(fewest, bench.coordinator.droplets().size()); };
  ASSERT_TRUE(bench.run(200));
  for (const auto key : keys) EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(fewest, 4u);
  for (const Channel corner : {0u, 6u, 42u, 48u}) EXPECT_NEAR(around(bench, corner), 1, 1e-6);
}

TEST(Coordinator, WhoStandsInAnothersWayStepsAside) {
  // A line with one bay: the one must be in it before the other passes.
  Channels holes;
  for (Channel channel = 9; channel < 27; ++channel)
    if (channel != 15 && channel != 24) holes.insert(channel);
  Bench bench(grid_board(9, 3, holes));
  bench.board.amount = {{0, 1}, {8, 1}};
  bench.look();
  const auto left = bench.coordinator.start(Move{8, 0, {}, quick()});
  const auto right = bench.coordinator.start(Move{0, 8, {}, quick()});
  ASSERT_TRUE(bench.run(100));
  EXPECT_EQ(bench.status(right).state, State::succeeded) << bench.status(right).text;
  EXPECT_EQ(bench.status(left).state, State::succeeded) << bench.status(left).text;
  EXPECT_EQ(bench.coordinator.droplets().size(), 2u);
}

TEST(Coordinator, ADropletThatNobodyMovesBlocksByName) {
  Bench bench(grid_board(7, 1));
  bench.board.amount = {{0, 1}, {3, 1}};
  bench.look();
  const auto key = bench.coordinator.start(Move{0, 6, {}, quick()});
  ASSERT_TRUE(bench.run(20));
  EXPECT_EQ(bench.status(key).text, "blocked by droplet 2");
  EXPECT_EQ(bench.board.on(), (Channels{0, 3}));
}

TEST(Coordinator, OppositeWaysInALineEndByName) {
  Bench bench(grid_board(7, 1));
  bench.board.amount = {{0, 1}, {6, 1}};
  bench.look();
  const auto right = bench.coordinator.start(Move{0, 6, {}, quick()});
  const auto left = bench.coordinator.start(Move{6, 0, {}, quick()});
  ASSERT_TRUE(bench.run(60));
  EXPECT_TRUE(holds(bench.status(right).text + bench.status(left).text, "blocked by droplet"));
  EXPECT_EQ(bench.coordinator.droplets().size(), 2u);
}

TEST(Coordinator, AWalkGoesRoundASplitThatIsUnderWay) {
  Bench bench(grid_board(5, 7));
  bench.board.amount = {{17, 2}, {0, 1}};
  bench.look();
  const auto split = bench.coordinator.start(Split{17, {16, 18}, quick()});
  const auto move = bench.coordinator.start(Move{0, 4, {}, quick()});
  ASSERT_TRUE(bench.run(60));
  EXPECT_EQ(bench.status(split).state, State::succeeded) << bench.status(split).text;
  EXPECT_EQ(bench.status(move).state, State::succeeded) << bench.status(move).text;
  EXPECT_EQ(bench.coordinator.droplets().size(), 3u);
}

TEST(Coordinator, WhatCannotBeginIsRefused) {
  Bench bench(grid_board(4, 2, {2}));
  const auto refused = [&](const Goal& goal) { return refusal([&] { bench.coordinator.start(goal); }); };
  bench.board.amount = {{0, 1}, {7, 1}};
  EXPECT_TRUE(holds(refused(Move{0, 3, {}, quick()}), "has not sensed anything"));
  bench.look();
  EXPECT_TRUE(holds(refused(Move{0, 9, {}, quick()}), "to: 9, allowed: a channel of 0-1, 3-7"));
  EXPECT_TRUE(holds(refused(Move{0, 2, {}, quick()}), "to: 2, allowed: a channel of 0-1, 3-7"));
  EXPECT_TRUE(holds(refused(Move{0, 0, {1, 3}, quick()}),
                    "path: from 1 to 3, allowed: a neighbour of 1, one of 0, 5"));
  EXPECT_TRUE(holds(refused(Move{5, 3, {}, quick()}), "no droplet on channel 5: 0 % of it is wetted"));
  EXPECT_TRUE(holds(refused(Move{0, 3, {}, {2, 0, 200, -1}}),
                    "success_threshold: 2, allowed: (0, 1]\nstep_timeout: 0, allowed: more than 0 s\n"
                    "timeout: -1, allowed: at least 0 s, 0 for none\nretries: 200, allowed: 0 to 100"));
  EXPECT_TRUE(
      holds(refused(Split{0, {1, 4}, quick()}), "onto: [1, 4], allowed: neighbours on opposite sides of 0"));
  EXPECT_TRUE(holds(refused(Split{0, {}, quick()}), "two neighbours on opposite sides"));
  EXPECT_TRUE(holds(refused(Merge{0, 5, quick()}), "no droplet on channel 5"));
  EXPECT_TRUE(holds(refused(Merge{0, 0, quick()}), "into: 0, allowed: another channel"));
  EXPECT_TRUE(holds(refused(Dispense{0, {1}, 0, 0, quick()}), "path: 1 channels, allowed: 2 or more"));
  EXPECT_TRUE(holds(refused(Mix{0, {1, 3}, 0, quick()}), "laps: 0, allowed: 1 to 1000"));
  EXPECT_FALSE(bench.coordinator.on()) << "nothing was begun";
}

TEST(Coordinator, TwoOperationsOnOneDropletAreRefused) {
  Bench bench(grid_board(7, 1));
  bench.board.amount = {{0, 1}, {6, 1}};
  bench.look();
  bench.coordinator.start(Merge{0, 6, quick()});
  EXPECT_TRUE(holds(refusal([&] {
                      bench.coordinator.start(Move{0, 3, {}, quick()});
                    }),
                    "droplet 1 on channel 0 is in the hands of another operation"));
  EXPECT_TRUE(holds(refusal([&] {
                      bench.coordinator.start(Move{6, 3, {}, quick()});
                    }),
                    "droplet 2 on channel 6"));
}

TEST(Coordinator, ManualChannelsAreTakenAsTheyAreAndNotBesideAnOperation) {
  Bench bench(grid_board(5, 1));
  bench.board.amount[0] = 1;
  bench.look();
  bench.coordinator.set_manual(Channels{1});
  for (int k = 0; k < 10; ++k) {
    bench.look();
    bench.board.step(0.1);
  }
  EXPECT_EQ(bench.board.on(), Channels{1});
  EXPECT_THROW(bench.coordinator.set_manual(Channels{9}), InvalidInput);
  bench.coordinator.set_manual({});
  bench.look();
  EXPECT_EQ(bench.board.on(), Channels{1}) << "the droplet is held where it is";
  bench.coordinator.start(Move{1, 4, {}, quick()});
  EXPECT_THROW(bench.coordinator.set_manual(Channels{1}), InvalidInput);
}

}  // namespace
}  // namespace dmf::controller
