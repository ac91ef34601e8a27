#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "frames.h"
#include "node/engine_thread.h"

namespace dmf::node {
namespace {

using namespace std::chrono_literals;

std::unique_ptr<chip::Experiment> tiny_experiment() {
  return std::make_unique<chip::Experiment>(testing::tiny_scene(), engine::Execution{1, "auto"});
}

std::unique_ptr<chip::Experiment> unstable_experiment() {
  return std::make_unique<chip::Experiment>(chip::load_scene(DMF_SOURCE_DIR "/test/scenes/unstable.yaml"),
                                            engine::Execution{1, "auto"});
}

EngineSettings paused() {
  EngineSettings settings;
  settings.paused = true;
  return settings;
}

/// Takes deliveries until `enough` of one is true; fails after ten seconds.
template <class Enough>
std::vector<Outbox::Delivery> collect(EngineThread& engine, const Enough& enough) {
  std::vector<Outbox::Delivery> all;
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (std::chrono::steady_clock::now() < deadline) {
    Outbox::Delivery delivery;
    if (!engine.outbox().take(delivery, 100ms)) continue;
    all.push_back(delivery);
    if (enough(delivery)) return all;
  }
  ADD_FAILURE() << "waited in vain";
  return all;
}

bool has_event(const Outbox::Delivery& delivery, const std::string& kind) {
  return std::any_of(delivery.events.begin(), delivery.events.end(),
                     [&](const EventNote& event) { return event.kind == kind; });
}

TEST(EngineThread, ComputesExactlyTheStepsThatItIsAskedFor) {
  EngineThread engine(tiny_experiment(), paused());
  const Outcome outcome = engine.advance(37);
  EXPECT_TRUE(outcome.success) << outcome.message;
  EXPECT_EQ(outcome.step, 37u);
  EXPECT_EQ(engine.inspect(false)->snapshot->step, 37u);
  EXPECT_TRUE(engine.inspect(false)->paused);
}

TEST(EngineThread, GivesTheSameStateAsSteppingByHand) {
  const auto by_hand = tiny_experiment();
  by_hand->apply(chip::SetHv{63, 1000, true});
  for (int i = 0; i < 20; ++i) by_hand->step();
  by_hand->apply(chip::SetElectrodes{{1}});
  for (int i = 0; i < 20; ++i) by_hand->step();
  engine::ObserveRequest hash;
  hash.hash = true;

  EngineThread engine(tiny_experiment(), paused());
  engine.apply(chip::SetHv{63, 1000, true});
  engine.advance(20);
  engine.apply(chip::SetElectrodes{{1}});
  engine.advance(20);
  EXPECT_EQ(engine.inspect(true)->snapshot->state_hash, by_hand->observe(hash)->state_hash);
}

TEST(EngineThread, RefusesToAdvanceWhenItRunsOrTheNumberIsOff) {
  EngineThread engine(tiny_experiment(), paused());
  for (const std::uint64_t steps : {std::uint64_t{0}, EngineThread::kMaxAdvance + 1}) {
    const Outcome outcome = engine.advance(steps);
    EXPECT_FALSE(outcome.success);
    EXPECT_NE(outcome.message.find(std::to_string(steps) + ", allowed: 1 to 1000000"), std::string::npos)
        << outcome.message;
  }
  EXPECT_EQ(engine.inspect(false)->snapshot->step, 0u);
  engine.resume();
  EXPECT_FALSE(engine.advance(5).success);
}

TEST(EngineThread, PauseEndsAnAdvanceAndSoDoesReset) {
  EngineThread engine(tiny_experiment(), paused());
  auto answer = std::async(std::launch::async, [&] { return engine.advance(1'000'000); });
  while (engine.inspect(false)->snapshot->step == 0) std::this_thread::sleep_for(1ms);
  EXPECT_FALSE(engine.advance(5).success) << "one at a time";
  engine.pause();
  EXPECT_FALSE(answer.get().success);

  answer = std::async(std::launch::async, [&] { return engine.advance(1'000'000); });
  while (engine.inspect(false)->limit == Limit::paused) std::this_thread::sleep_for(1ms);
  EXPECT_TRUE(engine.apply(chip::Reset{}).success);
  EXPECT_FALSE(answer.get().success);
  EXPECT_EQ(engine.inspect(false)->snapshot->step, 0u) << "paused as before the reset";
}

TEST(EngineThread, StopFreesWhoeverWaits) {
  EngineThread engine(tiny_experiment(), paused());
  auto answer = std::async(std::launch::async, [&] { return engine.advance(1'000'000); });
  while (engine.inspect(false)->snapshot->step == 0) std::this_thread::sleep_for(1ms);
  engine.stop();
  EXPECT_THROW(answer.get(), EngineStopped);
  EXPECT_THROW(engine.inspect(false), EngineStopped);
}

TEST(EngineThread, AnswersManyCallersAtOnceWhileItRuns) {
  EngineThread engine(tiny_experiment(), {});
  std::vector<std::future<int>> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.push_back(std::async(std::launch::async, [&engine, caller] {
      int accepted = 0;
      for (int i = 0; i < 25; ++i) {
        accepted += engine.apply(chip::SetElectrodes{{static_cast<std::uint32_t>(caller)}}).success;
      }
      return accepted;
    }));
  }
  for (auto& caller : callers) EXPECT_EQ(caller.get(), 25);
  // Not one of them is lost on the way out.
  std::uint32_t next = 0;
  collect(engine, [&](const Outbox::Delivery& delivery) {
    for (const CommandNote& command : delivery.commands) EXPECT_EQ(command.index, next++);
    return next == 100;
  });
}

TEST(EngineThread, ARefusedCommandLeavesNoTrace) {
  EngineThread engine(tiny_experiment(), paused());
  engine.advance(10);
  const auto before = engine.inspect(true)->snapshot->state_hash;
  EXPECT_FALSE(engine.apply(chip::SetElectrodes{{1, 99}}).success);
  EXPECT_EQ(engine.inspect(true)->snapshot->state_hash, before);
  Outbox::Delivery delivery;
  engine.outbox().take(delivery, 0ms);
  EXPECT_TRUE(delivery.commands.empty());
}

TEST(EngineThread, RosTimeNeverStepsBack) {
  EngineThread engine(tiny_experiment(), paused());
  std::uint64_t last = 0;
  const auto rises = [&](const Outbox::Delivery& delivery) {
    if (delivery.clock == 0) return;
    EXPECT_GE(delivery.clock, last);
    EXPECT_GE(delivery.clock, RunClock::kStart);
    last = delivery.clock;
  };
  engine.advance(50);
  const SavedRun saved = engine.save();
  engine.advance(50);
  collect(engine, [&](const auto& d) {
    rises(d);
    return d.frame && d.frame->snapshot->step == 100;
  });
  const std::uint64_t before_reset = last;
  engine.apply(chip::Reset{});
  collect(engine, [&](const auto& d) {
    rises(d);
    return d.frame && d.frame->run == 1;
  });
  EXPECT_GT(last, before_reset);
  engine.advance(10);
  EXPECT_TRUE(engine.load(saved.checkpoint.state, "saved").success);
  collect(engine, [&](const auto& d) {
    rises(d);
    return d.frame && d.frame->run == 2;
  });
  const std::uint64_t at_load = last;
  engine.advance(10);
  collect(engine, [&](const auto& d) {
    rises(d);
    return d.frame && d.frame->snapshot->step == 60;
  });
  // 10 steps of 0.01 tau at 0.02 s per tau.
  EXPECT_NEAR(static_cast<double>(last - at_load), 10 * 0.01 * 0.02 * 1e9, 2);
}

TEST(EngineThread, TheClockTicksInSmallStepsHoweverSeldomFramesAre) {
  EngineSettings settings = paused();
  settings.publish_rate = 0.1;
  settings.ros_seconds_per_time_unit = 1;  // a tick of 10 ms at each step
  EngineThread engine(tiny_experiment(), settings);
  Outbox::Delivery delivery;
  engine.outbox().take(delivery, 100ms);
  auto answer = std::async(std::launch::async, [&] { return engine.advance(200); });
  std::uint64_t last = 0;
  int ticks = 0;
  collect(engine, [&](const Outbox::Delivery& d) {
    if (d.clock > last && !d.frame) ++ticks;
    last = std::max(last, d.clock);
    return last >= RunClock::kStart + 2'000'000'000;
  });
  EXPECT_TRUE(answer.get().success);
  EXPECT_GT(ticks, 50);
}

TEST(EngineThread, ARestoredRunGoesOnWithTheSameBits) {
  EngineThread engine(tiny_experiment(), paused());
  engine.apply(chip::SetHv{63, 1000, true});
  engine.advance(30);
  const SavedRun saved = engine.save();
  ASSERT_TRUE(saved.outcome.success);
  EXPECT_EQ(saved.checkpoint.state_hash, engine.inspect(true)->snapshot->state_hash);
  engine.advance(30);
  const auto uninterrupted = engine.inspect(true)->snapshot->state_hash;

  EngineThread other(tiny_experiment(), paused());
  ASSERT_TRUE(other.load(saved.checkpoint.state, "saved").success);
  EXPECT_EQ(other.inspect(false)->rail.voltage, 63);
  other.advance(30);
  EXPECT_EQ(other.inspect(true)->snapshot->state_hash, uninterrupted);
  // Its history is told anew, under a new run number.
  const auto told =
      collect(other, [](const Outbox::Delivery& d) { return has_event(d, "checkpoint_loaded"); });
  ASSERT_EQ(told.back().commands.size(), 1u);
  EXPECT_EQ(told.back().commands[0].run, 1u);
}

std::uint64_t hash_of(const chip::Experiment& experiment) {
  engine::ObserveRequest request;
  request.hash = true;
  return experiment.observe(request)->state_hash.value();
}

/// All hashes up to the delivery in which `enough` is true.
template <class Enough>
std::vector<StateHashNote> collect_hashes(EngineThread& engine, const Enough& enough) {
  std::vector<StateHashNote> hashes;
  for (const Outbox::Delivery& delivery : collect(engine, enough)) {
    hashes.insert(hashes.end(), delivery.hashes.begin(), delivery.hashes.end());
  }
  return hashes;
}

TEST(EngineThread, HashesAreThoseOfSteppingByHandAtEveryMultipleOfTheInterval) {
  const auto by_hand = tiny_experiment();
  chip::HashChain chain(chip::fingerprint(by_hand->scene().files), 7, 20);
  std::vector<chip::StateRecord> expected{chain.add(0, hash_of(*by_hand), by_hand->history())};
  by_hand->apply(chip::SetHv{63, 1000, true});
  for (int step = 1; step <= 50; ++step) {
    by_hand->step();
    if (step % 20 == 0)
      expected.push_back(chain.add(by_hand->steps(), hash_of(*by_hand), by_hand->history()));
  }

  EngineSettings settings = paused();
  settings.hash_interval = 20;
  EngineThread engine(tiny_experiment(), settings);
  engine.apply(chip::SetHv{63, 1000, true});
  engine.advance(50);
  const auto hashes =
      collect_hashes(engine, [](const auto& d) { return d.frame && d.frame->snapshot->step == 50; });
  ASSERT_EQ(hashes.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(hashes[i].record.step, 20 * i);
    EXPECT_EQ(hashes[i].record.index, i);
    EXPECT_EQ(hashes[i].record.commands, expected[i].commands);
    EXPECT_EQ(hashes[i].record.hash, expected[i].hash);
    EXPECT_EQ(hashes[i].record.chain, expected[i].chain);
  }
}

TEST(EngineThread, ARunIsHashedWhenItBeginsAndWhenItIsPaused) {
  EngineSettings settings;
  settings.hash_interval = 1'000'000;
  EngineThread engine(tiny_experiment(), settings);
  while (engine.inspect(false)->snapshot->step < 10) std::this_thread::sleep_for(1ms);
  const std::uint64_t held = engine.pause().step;
  const auto hash = engine.inspect(true)->snapshot->state_hash;
  const SavedRun saved = engine.save();
  engine.apply(chip::Reset{});
  engine.load(saved.checkpoint.state, "saved");
  const auto hashes = collect_hashes(engine, [](const auto& d) { return has_event(d, "checkpoint_loaded"); });
  ASSERT_EQ(hashes.size(), 4u);
  EXPECT_EQ(hashes[0].record.step, 0u);
  EXPECT_EQ(hashes[1].record.step, held);
  EXPECT_EQ(hashes[1].record.hash, hash);
  EXPECT_EQ(hashes[2].run, 1u);
  EXPECT_EQ(hashes[2].record.hash, hashes[0].record.hash) << "the scene's start";
  EXPECT_EQ(hashes[2].record.commands, 1u) << "the reset";
  EXPECT_EQ(hashes[3].run, 2u);
  EXPECT_EQ(hashes[3].record.index, 0u);
  EXPECT_EQ(hashes[3].record.hash, hash);
}

TEST(EngineThread, WithoutAnIntervalThereAreNoHashes) {
  EngineSettings settings = paused();
  settings.hash_interval = 0;
  EngineThread engine(tiny_experiment(), settings);
  engine.advance(200);
  EXPECT_TRUE(collect_hashes(engine, [](const auto& d) {
                return d.frame && d.frame->snapshot->step == 200;
              }).empty());
}

TEST(EngineThread, RefusesBytesThatAreNoState) {
  EngineThread engine(tiny_experiment(), paused());
  engine.advance(10);
  const auto before = engine.inspect(true)->snapshot->state_hash;
  EXPECT_FALSE(engine.load("nonsense", "nonsense").success);
  EXPECT_EQ(engine.inspect(true)->snapshot->state_hash, before);
}

TEST(EngineThread, BeadsAreCopiedOnlyWhileSomebodyLooks) {
  EngineSettings settings;
  settings.display_rate = 1000;
  EngineThread engine(tiny_experiment(), settings);
  for (int i = 0; i < 5; ++i) {
    for (const auto& delivery : collect(engine, [](const auto& d) { return d.frame != nullptr; })) {
      if (delivery.frame) {
        EXPECT_TRUE(delivery.frame->snapshot->positions.empty());
      }
    }
  }
  engine.want_beads(true);
  const auto seen = collect(engine, [](const auto& d) { return d.frame && d.frame->has_beads; });
  EXPECT_EQ(seen.back().frame->snapshot->positions.size(), seen.back().frame->snapshot->moving_beads);
}

TEST(EngineThread, TheSpeedLimitIsKeptAndNamed) {
  EngineSettings settings;
  settings.max_steps_per_second = 200;
  EngineThread engine(tiny_experiment(), settings);
  const auto begin = engine.inspect(false)->snapshot->step;
  std::this_thread::sleep_for(1s);
  const auto steps = engine.inspect(false)->snapshot->step - begin;
  EXPECT_LE(steps, 210u);
  EXPECT_GT(steps, 20u);
  const auto seen =
      collect(engine, [](const auto& d) { return d.frame && d.frame->limit == Limit::max_steps_per_second; });
  EXPECT_LE(seen.back().frame->steps_per_second, 220);
}

TEST(EngineThread, AFaultHaltsTheRunUntilItIsReset) {
  EngineThread engine(unstable_experiment(), {});
  const auto seen = collect(engine, [](const auto& d) { return has_event(d, "fault"); });
  const auto frame = engine.inspect(true);
  EXPECT_NE(frame->fault, "");
  EXPECT_TRUE(frame->paused);
  EXPECT_EQ(frame->limit, Limit::fault);
  EXPECT_TRUE(std::isfinite(frame->snapshot->temperature)) << "never publishes garbage";

  const chip::Reply reply = engine.apply(chip::SetHv{10, 0, true});
  EXPECT_FALSE(reply.success);
  EXPECT_NE(reply.message.find(frame->fault), std::string::npos) << reply.message;
  EXPECT_NE(reply.message.find("reset"), std::string::npos) << reply.message;
  EXPECT_FALSE(engine.resume().success);
  EXPECT_FALSE(engine.advance(1).success);
  EXPECT_FALSE(engine.save().outcome.success);

  EXPECT_TRUE(engine.apply(chip::Reset{}).success);
  EXPECT_EQ(engine.inspect(false)->fault, "");
  EXPECT_TRUE(engine.inspect(false)->paused) << "it would only fail again";
  EXPECT_EQ(engine.inspect(false)->snapshot->step, 0u);
}

TEST(Outbox, KeepsABoundedNumberOfWhatNobodyTakes) {
  Outbox outbox;
  for (std::size_t k = 0; k < Outbox::kMostWaiting + 3; ++k) {
    EventNote event;
    event.step = k;
    outbox.put(std::move(event));
  }
  Outbox::Delivery delivery;
  ASSERT_TRUE(outbox.take(delivery, std::chrono::milliseconds(0)));
  ASSERT_EQ(delivery.events.size(), Outbox::kMostWaiting);
  EXPECT_EQ(delivery.events.back().step, Outbox::kMostWaiting - 1);
  EXPECT_EQ(delivery.lost, 3u);
  // And whoever takes finds room again.
  outbox.put(EventNote{});
  ASSERT_TRUE(outbox.take(delivery, std::chrono::milliseconds(0)));
  EXPECT_EQ(delivery.events.size(), 1u);
  EXPECT_EQ(delivery.lost, 0u);
}

}  // namespace
}  // namespace dmf::node
