#include <gtest/gtest.h>

#include <cmath>

#include "fake_board.h"
#include "refusal.h"

namespace dmf::controller {
namespace {

/// A move, split, ... with steps that give up soon: the fake board's take 0.4 s.
Limits quick() { return {0.8, 2, 2, 0}; }

TEST(Move, TheDropletArrivesAndIsHeldThere) {
  Bench bench(grid_board(5, 1));
  bench.board.amount[0] = 1;
  bench.look();
  EXPECT_FALSE(bench.coordinator.on()) << "nobody has asked for anything yet";
  const auto key = bench.coordinator.start(Move{0, 4, {}, quick()});
  ASSERT_TRUE(bench.run(20));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_GT(bench.board.amount[4], 0.75);
  EXPECT_EQ(bench.board.on(), Channels{4});
  EXPECT_NEAR(bench.board.total(), 1, 1e-12);
}

TEST(Move, ProgressRisesAndTheTimeLeftFalls) {
  Bench bench(grid_board(7, 1));
  bench.board.amount[0] = 1;
  bench.look();
  const auto key = bench.coordinator.start(Move{0, 6, {}, quick()});
  std::vector<double> progress, left;
  bench.each_look = [&] {
    progress.push_back(bench.status(key).progress);
    left.push_back(bench.status(key).time_left);
  };
  ASSERT_TRUE(bench.run(20));
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_EQ(progress.back(), 1);
  EXPECT_LT(left[left.size() - 8], left[10]);
  EXPECT_EQ(left.back(), 0);
}

TEST(Move, AGivenPathIsTakenAsItIs) {
  Bench bench(grid_board(3, 2));
  bench.board.amount[0] = 1;
  bench.look();
  bench.coordinator.start(Move{0, 0, {3, 4, 5, 2, 1}, quick()});
  std::vector<Channel> seen;
  bench.each_look = [&] {
    for (const Channel on : bench.board.on())
      if (seen.empty() || seen.back() != on) seen.push_back(on);
  };
  ASSERT_TRUE(bench.run(20));
  EXPECT_EQ(seen, (std::vector<Channel>{0, 3, 4, 5, 2, 1}));
}

TEST(Move, AWeakElectrodeIsTriedAgainUntilItAnswers) {
  Bench bench(grid_board(4, 1));
  bench.board.amount[0] = 1;
  bench.board.slow[2] = 2;  // deaf to the first two times
  bench.look();
  const auto key = bench.coordinator.start(Move{0, 3, {}, quick()});
  ASSERT_TRUE(bench.run(40));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  bench.board.slow[1] = 4;
  Limits no_retry = quick();
  no_retry.retries = 0;
  const auto second = bench.coordinator.start(Move{3, 0, {}, no_retry});
  ASSERT_TRUE(bench.run(40));
  EXPECT_EQ(bench.status(second).state, State::failed);
  EXPECT_EQ(bench.board.on(), Channels{2}) << "it is held where it is";
}

TEST(Move, AnElectrodeThatDoesNotAnswerIsGoneRound) {
  Bench bench(grid_board(4, 2));
  bench.board.amount[0] = 1;
  bench.board.stuck_off = {2};
  bench.look();
  const auto key = bench.coordinator.start(Move{0, 3, {}, quick()});
  ASSERT_TRUE(bench.run(40));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(bench.coordinator.dead(), Channels{2});
}

TEST(Move, ADropletThatDriftsBackFromADeadElectrodeIsNotTakenForHeld) {
  Bench bench(grid_board(4, 2));
  bench.board.amount[0] = 1;
  bench.board.stuck_off = {2};
  bench.look();
  bench.each_look = [&] {  // nothing holds it while only the dead one is on
    if (bench.board.on() == Channels{2}) bench.board.amount = {{0, 0.6}, {1, 0.4}};
  };
  Limits no_retry = quick();
  no_retry.retries = 0;
  const auto key = bench.coordinator.start(Move{0, 3, {}, no_retry});
  ASSERT_TRUE(bench.run(40));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(bench.coordinator.dead(), Channels{2});
}

TEST(Move, WithoutAWayRoundItIsToldWhichElectrodeIsAtFault) {
  for (const bool given : {false, true}) {
    Bench bench(grid_board(4, 1));
    bench.board.amount[0] = 1;
    bench.board.stuck_off = {2};
    bench.look();
    const auto key = bench.coordinator.start(
        Move{0, 3, given ? std::vector<Channel>{1, 2, 3} : std::vector<Channel>{}, quick()});
    ASSERT_TRUE(bench.run(40));
    EXPECT_EQ(bench.status(key).state, State::failed);
    EXPECT_TRUE(holds(bench.status(key).text, "electrode 2 does not answer"));
    EXPECT_EQ(bench.board.on(), Channels{1});
  }
}

TEST(Move, ADisabledElectrodeIsNamedAtOnce) {
  Bench bench(grid_board(4, 1));
  bench.board.amount[0] = 1;
  bench.board.disabled = {2};
  bench.look();
  const auto key = bench.coordinator.start(Move{0, 3, {}, quick()});
  ASSERT_TRUE(bench.run(2.0));
  EXPECT_TRUE(holds(bench.status(key).text, "electrode 2 is disabled"));
}

TEST(Move, RailAndThresholdAreNamed) {
  BoardDescription description = grid_board(4, 1);
  description.threshold_voltage = 30;
  Bench bench(description);
  bench.board.amount[0] = 1;
  bench.board.stuck_off = {1};  // what a voltage below the threshold does
  bench.board.rail.voltage = 25;
  bench.look();
  auto key = bench.coordinator.start(Move{0, 3, {}, quick()});
  ASSERT_TRUE(bench.run(20));
  EXPECT_TRUE(
      holds(bench.status(key).text, "below threshold voltage: the rail has 25 V, nothing moves up to 30 V"));
  EXPECT_TRUE(bench.coordinator.dead().empty()) << "the electrode is not to blame";
  bench.board.rail.voltage = 63;
  key = bench.coordinator.start(Move{0, 3, {}, quick()});
  bench.board.rail.enabled = false;
  ASSERT_TRUE(bench.run(0.5));
  EXPECT_EQ(bench.status(key).text, "the high-voltage rail is off");
}

TEST(Move, ADropletThatDoesNotReachItsNeighbourIsToldSo) {
  Bench bench(grid_board(4, 1));
  bench.board.amount[0] = 0.5;
  bench.board.stuck_off = {1};
  bench.look();
  const auto key = bench.coordinator.start(Move{0, 3, {}, quick()});
  ASSERT_TRUE(bench.run(20));
  EXPECT_TRUE(holds(bench.status(key).text,
                    "no overlap with neighbour: 50 % of electrode 0 was wetted at most and nothing of 1"));
}

TEST(Move, TimeoutAndALostDropletEndIt) {
  Bench bench(grid_board(6, 1));
  bench.board.amount[0] = 1;
  bench.look();
  Limits short_time = quick();
  short_time.timeout = 1;
  auto key = bench.coordinator.start(Move{0, 5, {}, short_time});
  ASSERT_TRUE(bench.run(20));
  EXPECT_TRUE(holds(bench.status(key).text, "timeout: not done after 1 s"));
  EXPECT_EQ(bench.coordinator.droplets().size(), 1u);
  key = bench.coordinator.start(Move{bench.coordinator.droplets()[0].main, 5, {}, quick()});
  bench.board.amount.clear();
  ASSERT_TRUE(bench.run(20));
  EXPECT_TRUE(holds(bench.status(key).text, "the droplet is lost"));
}

TEST(Split, OneDropletBecomesTwoOfTheSameSize) {
  Bench bench(grid_board(5, 1));
  bench.board.amount[2] = 2;
  bench.look();
  const auto key = bench.coordinator.start(Split{2, {1, 3}, quick()});
  ASSERT_TRUE(bench.run(20));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(bench.board.on(), (Channels{1, 3}));
  EXPECT_NEAR(bench.board.amount[1], bench.board.amount[3], 1e-9);
  EXPECT_LT(bench.board.amount[2], 0.3);
  EXPECT_EQ(bench.coordinator.report(key).droplets.size(), 2u);
}

TEST(Split, ANeckThatRestsOnItsWayHasNotBroken) {
  // A quarter of the electrode is less than what counts as a droplet on it, and it stays so for long.
  for (const bool breaks : {true, false}) {
    Bench bench(grid_board(5, 1));
    bench.board.amount[2] = 2;
    bench.board.neck[2] = 0.25;
    bench.look();
    const auto key = bench.coordinator.start(Split{2, {1, 3}, quick()});
    int looks = 0;
    bench.each_look = [&] {
      if (++looks < 20) {
        EXPECT_TRUE(bench.coordinator.is_running(key));
      } else if (breaks) {
        bench.board.neck.clear();
      }
    };
    ASSERT_TRUE(bench.run(30));
    EXPECT_EQ(bench.status(key).state, breaks ? State::succeeded : State::failed) << bench.status(key).text;
    if (breaks) {
      EXPECT_LT(bench.board.amount[2], 0.01);
    } else {
      EXPECT_TRUE(
          holds(bench.status(key).text, "the neck over electrode 2 does not break: 25 % of it is wetted"));
      EXPECT_EQ(bench.board.on(), (Channels{1, 3})) << "two are sensed: both are held";
    }
  }
}

TEST(Split, TheDrierSideHelpsUntilTheDropletIsCentred) {
  Bench bench(grid_board(5, 1));
  bench.board.stuck_off = {1, 2, 3};  // the liquid lies where the test puts it
  bench.board.amount = {{1, 0.7}, {2, 1}, {3, 0.3}};
  bench.look();
  bench.coordinator.start(Split{2, {1, 3}, {0.8, 1.9, 2, 0}});
  const auto on_after = [&](double seconds) {
    for (int look = 0; look < std::lround(seconds / 0.1); ++look) {
      bench.board.time += 0.1;
      bench.look();
    }
    return bench.board.on();
  };
  EXPECT_EQ(on_after(0.1), (Channels{2, 3}));
  bench.board.amount = {{1, 0.4}, {2, 1}, {3, 0.6}};
  EXPECT_EQ(on_after(0.1), (Channels{1, 2}));
  bench.board.amount = {{1, 0.5}, {2, 1}, {3, 0.5}};
  EXPECT_EQ(on_after(0.1), Channels{2});
  EXPECT_EQ(on_after(0.1), (Channels{1, 2, 3})) << "a tenth of the step's time after it was off";
}

TEST(Split, PicksAFreeOppositePairByItself) {
  Bench bench(grid_board(5, 3));
  bench.board.amount[7] = 2;
  bench.board.amount[9] = 1;  // beside 8
  bench.look();
  const auto key = bench.coordinator.start(Split{7, {}, quick()});
  ASSERT_TRUE(bench.run(20));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(bench.board.on(), (Channels{2, 9, 12})) << "and the one that nobody moved is held";
}

TEST(Split, FailsOverAStuckElectrodeWithTheLiquidPulledBack) {
  Bench bench(grid_board(5, 1));
  bench.board.amount[2] = 2;
  bench.board.stuck_off = {3};
  bench.look();
  const auto key = bench.coordinator.start(Split{2, {1, 3}, quick()});
  ASSERT_TRUE(bench.run(30));
  EXPECT_EQ(bench.status(key).state, State::failed);
  EXPECT_TRUE(holds(bench.status(key).text, "did not reach electrode 3: electrode 3 does not answer"));
  EXPECT_EQ(bench.board.on().size(), 1u);
}

TEST(Merge, TheOneThatMovesMayGiveTheWholeItsId) {
  // The moving droplet is the larger one: from the first touch on its id is that of both.
  Bench bench(grid_board(6, 1));
  bench.board.amount = {{0, 1}, {5, 0.4}};
  bench.look();
  const auto key = bench.coordinator.start(Merge{0, 5, quick()});
  ASSERT_TRUE(bench.run(30));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  ASSERT_EQ(bench.coordinator.droplets().size(), 1u);
  EXPECT_EQ(bench.coordinator.droplets()[0].id, 1u);
}

TEST(Merge, ADropletThatWasOutOfSightForAMomentIsStillTheOther) {
  Bench bench(grid_board(7, 1));
  bench.board.amount = {{0, 1}, {6, 0.5}};
  bench.look();
  const auto key = bench.coordinator.start(Merge{0, 6, quick()});
  int looks = 0;
  bench.each_look = [&] {
    ++looks;
    if (looks == 5) bench.board.amount[6] = 0.1;  // shrunk below what counts as a droplet
    if (looks == 8) bench.board.amount[6] = 0.5;  // sensed again, under a new id
  };
  ASSERT_TRUE(bench.run(30));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
}

TEST(Merge, TwoDropletsBecomeOne) {
  Bench bench(grid_board(6, 1));
  bench.board.amount = {{0, 1}, {5, 1}};
  bench.look();
  const auto key = bench.coordinator.start(Merge{0, 5, quick()});
  ASSERT_TRUE(bench.run(30));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(bench.coordinator.droplets().size(), 1u);
  for (int k = 0; k < 10; ++k) {
    bench.board.step(0.1);
    bench.look();
  }
  EXPECT_NEAR(bench.board.amount[5], 2, 1e-3);
}

TEST(Dispense, DrawsADropletAndChecksItsVolume) {
  for (const double least : {0.0, 3.0}) {
    Bench bench(grid_board(5, 1));
    bench.board.amount[0] = 6;
    bench.look();
    const auto key = bench.coordinator.start(Dispense{0, {1, 2, 3}, least, 0, quick()});
    ASSERT_TRUE(bench.run(60));
    EXPECT_EQ(bench.status(key).state, least > 0 ? State::failed : State::succeeded)
        << bench.status(key).text;
    EXPECT_TRUE(holds(bench.status(key).text,
                      least > 0 ? "wanted: 3 to any" : "dispensed a droplet onto electrode 3"));
    EXPECT_EQ(bench.board.on(), (Channels{0, 3}));
    EXPECT_LT(bench.board.amount[2], 0.3);
  }
}

TEST(Dispense, WaitsUntilADropletThatWasJustMovedHasDrawnBack) {
  Bench bench(grid_board(6, 1));
  bench.board.amount = {{0, 6}, {3, 0.35}, {4, 1}};
  bench.look();
  const auto key = bench.coordinator.start(Dispense{0, {1, 2}, 0.5, 0, quick()});
  ASSERT_TRUE(bench.run(30));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_GT(bench.board.amount[2], 0.5);
  EXPECT_GT(bench.board.amount[4], 1.2);
}

TEST(Dispense, HoldsTheReservoirUntilItsLiquidHasGotHoldOfTheFirstElectrode) {
  Bench bench(grid_board(5, 1));
  bench.board.amount[0] = 6;
  bench.board.slow[1] = 1;  // deaf to the first time: out of reach of the liquid
  bench.look();
  bench.coordinator.start(Dispense{0, {1, 2}, 0, 0, quick()});
  bench.look();
  bench.look();
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(bench.board.on(), (Channels{0, 1}));
    bench.board.step(0.1);
    bench.look();
  }
  bench.board.slow.clear();
  bool let_go = false;
  bench.each_look = [&] {
    let_go = let_go || bench.board.on() == Channels{1} || bench.board.on() == Channels{1, 2};
  };
  ASSERT_TRUE(bench.run(30));
  EXPECT_TRUE(let_go);
}

TEST(Mix, GoesRoundTheShortestLoopAsOftenAsAsked) {
  Bench bench(grid_board(3, 2));
  bench.board.amount[0] = 1;
  bench.look();
  int arrivals = 0;
  Channel last = 0;
  bench.each_look = [&] {
    const Channel on = *bench.board.on().begin();
    arrivals += on == 0 && last != 0;
    last = on;
  };
  const auto key = bench.coordinator.start(Mix{0, {}, 3, quick()});
  ASSERT_TRUE(bench.run(60));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(arrivals, 3);
}

TEST(Mix, GoesToAndFroWhereThereIsNoLoop) {
  Bench bench(grid_board(3, 1));
  bench.board.amount[0] = 1;
  bench.look();
  const auto key = bench.coordinator.start(Mix{0, {}, 2, quick()});
  ASSERT_TRUE(bench.run(60));
  EXPECT_EQ(bench.status(key).state, State::succeeded) << bench.status(key).text;
  EXPECT_EQ(bench.board.on(), Channels{0});
}

TEST(Operation, CancelledAtAnyTimeItLeavesItsLiquidHeld) {
  const std::vector<Goal> goals{Move{2, 5, {}, quick()}, Mix{2, {}, 2, quick()}, Merge{2, 6, quick()},
                                Split{2, {1, 3}, quick()}, Dispense{2, {3, 4}, 0, 0, quick()}};
  for (const Goal& goal : goals) {
    for (int looks = 0; looks < 40; looks += 3) {
      Bench bench(grid_board(7, 1));
      bench.board.amount[2] = std::holds_alternative<Dispense>(goal) ? 4
                              : std::holds_alternative<Split>(goal)  ? 2
                                                                     : 1;
      if (std::holds_alternative<Merge>(goal)) bench.board.amount[6] = 1;
      bench.look();
      const auto key = bench.coordinator.start(goal);
      for (int look = 0; look < looks && bench.coordinator.is_running(key); ++look) {
        bench.board.step(0.1);
        bench.look();
      }
      bench.coordinator.cancel(key);
      EXPECT_FALSE(bench.coordinator.is_running(key));
      for (int look = 0; look < 30; ++look) {
        bench.board.step(0.1);
        bench.look();
      }
      // Every droplet that is left stands on an electrode that is on, and moves no more.
      for (const Droplet& droplet : bench.coordinator.droplets()) {
        EXPECT_TRUE(bench.board.on().count(droplet.main)) << name_of(goal) << " after " << looks << " looks";
      }
      EXPECT_EQ(bench.board.on().size(), bench.coordinator.droplets().size())
          << name_of(goal) << " after " << looks << " looks";
    }
  }
}

}  // namespace
}  // namespace dmf::controller
